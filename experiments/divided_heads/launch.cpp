#include "experiments/divided_heads/launch.h"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace tress::experiments::divided_heads {
namespace {

[[noreturn]] void failed(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

}  // namespace

PrivateFolder::PrivateFolder() {
  std::string name =
      (std::filesystem::temp_directory_path() / "tress_divided_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) failed(errno, name);
  path_ = name;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Launched::Launched(const std::vector<std::string>& words, const std::string& log) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) {
    arguments.push_back(const_cast<char*>(word.c_str()));
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW, 0600);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  const int error = ::posix_spawnp(&process_, arguments.front(), &files, nullptr,
                                   arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) {
    process_ = -1;
    failed(error, words.front());
  }
}

Launched::Launched(Launched&& other) noexcept
    : process_(std::exchange(other.process_, -1)) {}

Launched::~Launched() { succeeds(); }

bool Launched::succeeds() {
  if (process_ < 0) return false;
  const pid_t process = std::exchange(process_, -1);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace tress::experiments::divided_heads
