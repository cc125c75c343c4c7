#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/run/simulation.h"

/// Shared code of the benchmark programs: systems in motion, and one way to run and
/// report.
namespace tress::experiments::benchmarks {

/// A system some steps into its own motion, so that velocities, accelerations and
/// multipliers are those of a real step. `status` is not ok when it did not get there.
struct Moving {
  std::unique_ptr<System> system;
  Status status = Status::ok;
  double t = 0;  // s
  State state;
  std::vector<double> a, lambda;  // (n), (m): of the equations at this state
  std::vector<double> out;        // scratch, as long as the longest result of any call

  Out first(std::size_t count) { return Out(out).first(count); }
};

/// 10 steps of 1 ms from the initial state with backward Euler (index 3).
Moving set_in_motion(std::string_view model, const ModelSettings& settings);

/// An inextensible chain released horizontally while it spins about the vertical.
ModelSettings spinning_chain(int links);
inline constexpr std::array chain_links = {10, 100, 1000, 10'000};

/// Systems in motion by size, each made when first asked for and kept for all benchmarks.
class MovingFamily {
 public:
  using Settings = std::function<ModelSettings(int size)>;
  MovingFamily(std::string_view model, Settings settings)
      : model_(model), settings_(std::move(settings)) {}

  Moving& at(int size);

 private:
  std::string model_;
  Settings settings_;
  std::map<int, Moving> made_;
};

/// Runs `call` (returns Status) until the time is known; a call that fails voids it.
template <typename Call>
void measure(benchmark::State& state, Call&& call) {
  for ([[maybe_unused]] auto _ : state) {
    if (call() != Status::ok) {
      state.SkipWithError("the call did not return Status::ok");
      break;
    }
    benchmark::ClobberMemory();
  }
}

/// Time (s) of one call over the number of links, segments and the like.
void count_per_element(benchmark::State& state, int elements);

/// Registers the sizes of a family and the fit of time against size.
void with_sizes(benchmark::internal::Benchmark* registered, std::span<const int> sizes);

/// Median of the ratios of the times of neighbouring runs, taken in turn: what else the
/// machine does falls on both.
double time_ratio(const std::function<void()>& of, const std::function<void()>& to);

/// Prints a requirement with what was measured; false when it is not met.
bool kept(std::string_view subject, std::string_view what, double value, double most);

/// Results of a program, by "name/size": CPU time of one call in s, the median when
/// there were repetitions.
struct Measured {
  int exit_code = 0;  // 2: bad flags; 3: a benchmark failed
  std::map<std::string, double> seconds;
};

/// Google Benchmark's main(), with the state of source, build and libraries put into the
/// JSON context and only medians, spreads and fits on the console when repeating.
Measured run_benchmarks(int argc, char** argv);

/// Runs the benchmarks, then `met`: whether the requirements of the program are met.
/// Returns the exit code, 3 where they are not.
int run_and_judge(int argc, char** argv, const std::function<bool(const Measured&)>& met);

}  // namespace tress::experiments::benchmarks
