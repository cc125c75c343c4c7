#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tress {

/// The toy experiment run as a process in a directory of its own, removed afterwards.
class Toy {
 public:
  Toy();
  ~Toy();
  Toy(const Toy&) = delete;
  Toy& operator=(const Toy&) = delete;

  struct Result {
    int code = -1;
    std::string out, err;
    int error_lines() const;
  };
  /// `prefix` goes before the command in a shell, e.g. "ulimit -f 0;"; standard output
  /// goes to `output`, by default a file that ends up in Result::out.
  Result run(const std::string& arguments, const std::string& prefix = "",
             const std::string& output = "");

  /// Starts it and returns; finish with `wait`.
  pid_t start(const std::string& arguments);
  Result wait(pid_t process);

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  bool exists(const std::string& name) const;
  std::string read(const std::string& name) const;
  void write(const std::string& name, const std::string& text) const;
  std::vector<std::string> files() const;      // what it left behind, sorted
  std::vector<int> executed() const;           // row numbers, in order of execution
  void await_executions(std::size_t n) const;  // gives up after 30 s

 private:
  std::string command(const std::string& arguments, const std::string& output) const;
  std::filesystem::path directory_;
};

}  // namespace tress
