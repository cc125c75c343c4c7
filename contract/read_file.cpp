#include "contract/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "contract/input_error.h"
#include "contract/shipped_file.h"

namespace tress {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& problem) {
  throw InputError("cannot read: " + problem, file.empty() ? "a file without name" : file,
                   "give an existing, readable file");
}

class Descriptor {
 public:
  /// Does not wait for a writer if the file is a pipe.
  explicit Descriptor(const std::string& file)
      : number_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
    if (number_ < 0) refuse(file, std::strerror(errno));
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

void refuse_special(int descriptor, const std::string& file) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) refuse(file, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) refuse(file, "is a directory");
  if (!S_ISREG(status.st_mode)) refuse(file, "is not a regular file");
}

}  // namespace

std::string read_file(const std::string& file, std::size_t most_bytes) {
  const Descriptor input(shipped_file(file));
  refuse_special(input.number(), file);
  std::string text;
  char buffer[65536];
  for (;;) {
    // One byte beyond the limit shows that a file is larger.
    const std::size_t left = most_bytes - text.size();
    const std::size_t wanted = left < sizeof buffer ? left + 1 : sizeof buffer;
    const ssize_t got = ::read(input.number(), buffer, wanted);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(file, std::strerror(errno));
    if (got == 0) return text;
    if (static_cast<std::size_t>(got) > left) {
      throw InputError("a file of more than " + std::to_string(most_bytes) + " bytes",
                       file, "give a smaller one");
    }
    text.append(buffer, static_cast<std::size_t>(got));
  }
}

}  // namespace tress
