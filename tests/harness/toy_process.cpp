#include "tests/harness/toy_process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace tress {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

Toy::Toy() {
  std::string name = (fs::temp_directory_path() / "tress_toy_XXXXXX").string();
  directory_ = mkdtemp(name.data());
  fs::create_directory(directory_ / "work");
}

Toy::~Toy() { fs::remove_all(directory_); }

int Toy::Result::error_lines() const {
  return static_cast<int>(std::count(err.begin(), err.end(), '\n'));
}

std::string Toy::command(const std::string& arguments, const std::string& output) const {
  return "cd '" + path("work") + "' && export TOY_LOG='" + path("log") + "' && exec '" +
         TOY_EXPERIMENT + "' " + arguments + " >'" +
         (output.empty() ? path("out") : output) + "' 2>'" + path("err") + "'";
}

Toy::Result Toy::run(const std::string& arguments, const std::string& prefix,
                     const std::string& output) {
  const std::string shell = prefix + command(arguments, output);
  const int status = std::system(shell.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, contents(path("out")), contents(path("err"))};
}

pid_t Toy::start(const std::string& arguments) {
  const std::string shell = command(arguments, "");
  const pid_t process = fork();
  if (process == 0) {
    execl("/bin/sh", "sh", "-c", shell.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  return process;
}

Toy::Result Toy::wait(pid_t process) {
  int status = 0;
  waitpid(process, &status, 0);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, contents(path("out")), contents(path("err"))};
}

bool Toy::exists(const std::string& name) const {
  return fs::exists(directory_ / "work" / name);
}

std::string Toy::read(const std::string& name) const {
  return contents(directory_ / "work" / name);
}

void Toy::write(const std::string& name, const std::string& text) const {
  std::ofstream(directory_ / "work" / name, std::ios::binary) << text;
}

std::vector<std::string> Toy::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(directory_ / "work")) {
    names.push_back(fs::relative(entry.path(), directory_ / "work").string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<int> Toy::executed() const {
  std::ifstream stream(path("log"));
  std::vector<int> rows;
  for (int row = 0; stream >> row;) rows.push_back(row);
  return rows;
}

void Toy::await_executions(std::size_t n) const {
  using namespace std::chrono_literals;
  const auto give_up = std::chrono::steady_clock::now() + 30s;
  while (executed().size() < n && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(5ms);
  }
}

}  // namespace tress
