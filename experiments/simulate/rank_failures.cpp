#include "experiments/simulate/rank_failures.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "experiments/run/exit_code.h"

namespace tress::experiments::scene_runs {
namespace {

/// Standard error of this process, which can be shut and opened again.
class Voice {
 public:
  Voice() : standard_(::dup(STDERR_FILENO)) {}
  ~Voice() { ::close(standard_); }
  Voice(const Voice&) = delete;
  Voice& operator=(const Voice&) = delete;

  void open() const { is(standard_); }
  void shut() const {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    is(nowhere);
    ::close(nowhere);
  }

 private:
  static void is(int file) {
    if (file < 0 || ::dup2(file, STDERR_FILENO) < 0) {
      throw std::system_error(errno, std::generic_category(), "standard error");
    }
  }

  int standard_;
};

std::string name_of(const Ranks& ranks) {
  if (ranks.first()) return "simulate";
  char machine[256] = {};
  ::gethostname(machine, sizeof machine - 1);
  return fmt::format("simulate: rank {} of {}, on {}", ranks.rank(), ranks.size(),
                     machine);
}

}  // namespace

int exit_code_of_ranks(Ranks& ranks, Interruption& interruption,
                       const std::function<int()>& run) {
  if (ranks.size() == 1) return run();
  const Interruption::Silence silence(interruption,
                                      [&] { return ranks.one_has_failed(); });
  const Voice voice;
  if (!ranks.first()) voice.shut();
  bool fails = false;
  const int code = exit_code(name_of(ranks), [&] {
    try {
      return run();
    } catch (...) {
      fails = true;
      if (ranks.speaks()) {
        voice.open();
      } else {
        voice.shut();
      }
      throw;
    }
  });
  if (fails) ranks.end_all(code);
  return code;
}

}  // namespace tress::experiments::scene_runs
