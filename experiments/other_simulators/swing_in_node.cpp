#include "experiments/other_simulators/swing_in_node.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

namespace tress::experiments::other_simulators {
namespace {

struct Close {
  void operator()(std::FILE* stream) const { std::fclose(stream); }
};
using Stream = std::unique_ptr<std::FILE, Close>;

/// A process of node with its standard input and output.
class Node {
 public:
  explicit Node(std::string_view script) {
    std::array<int, 2> to{}, from{};
    if (::pipe(to.data()) != 0 || ::pipe(from.data()) != 0) fail("no pipes");
    const std::string path(script);
    id_ = ::fork();
    if (id_ < 0) fail("no process");
    if (id_ == 0) {
      ::dup2(to[0], STDIN_FILENO);
      ::dup2(from[1], STDOUT_FILENO);
      for (const int end : {to[0], to[1], from[0], from[1]}) ::close(end);
      ::execlp("node", "node", path.c_str(), nullptr);
      ::_exit(127);
    }
    ::close(to[0]);
    ::close(from[1]);
    input_.reset(::fdopen(to[1], "w"));
    output_.reset(::fdopen(from[0], "r"));
  }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  ~Node() {
    input_.reset();  // which ends it
    output_.reset();
    ::waitpid(id_, nullptr, 0);
  }

  std::string answer(std::string_view line) {
    if (std::fwrite(line.data(), 1, line.size(), input_.get()) != line.size() ||
        std::fputc('\n', input_.get()) == EOF || std::fflush(input_.get()) != 0) {
      fail("it takes no more input");
    }
    std::string all;
    for (int c = 0; (c = std::fgetc(output_.get())) != '\n';) {
      if (c == EOF) fail("it ended without an answer");
      all += static_cast<char>(c);
    }
    return all;
  }

 private:
  [[noreturn]] static void fail(std::string_view why) {
    throw std::runtime_error(fmt::format("node: {}", why));
  }

  pid_t id_ = -1;
  Stream input_, output_;
};

class SwingInNode : public Simulator {
 public:
  SwingInNode(std::string_view script, std::string_view first_line, double dt,
              double phase)
      : node_(script), dt_(dt), phase_(phase) {
    look(node_.answer(first_line));
  }

  void step(double t) override { (void)advance(t, dt_, 1); }

  double advance(double t, double dt, int steps) override {
    std::string line;
    for (int i = 0; i < steps; ++i) {
      const Vec g = Swing::gravity(t + (i + phase_) * dt);
      line += fmt::format("{} {} {} ", g.x, g.y, g.z);
    }
    return look(node_.answer(line));
  }

  Motion motion() override { return motion_; }

 private:
  double look(const std::string& answer) {
    std::array<double, 5> numbers{};
    const char* at = answer.c_str();
    for (double& number : numbers) {
      char* end = nullptr;
      number = std::strtod(at, &end);
      if (end == at) throw std::runtime_error("node: not an answer: " + answer);
      at = end;
    }
    motion_ = {load3(&numbers[1]), numbers[4]};
    return numbers[0];
  }

  Node node_;
  double dt_, phase_;
  Motion motion_;
};

}  // namespace

std::unique_ptr<Simulator> swing_in_node(std::string_view script,
                                         std::string_view first_line, double dt,
                                         double phase) {
  return std::make_unique<SwingInNode>(script, first_line, dt, phase);
}

}  // namespace tress::experiments::other_simulators
