#include "experiments/benchmarks/fixture.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "experiments/run/machine.h"
#include "experiments/run/sundials_speed.h"
#include "integrators/formulation/dynamics.h"
#include "simulation/files/build_facts.h"
#include "simulation/run/timing.h"

namespace tress::experiments::benchmarks {
namespace {

constexpr double warming_step = 1e-3;  // s
constexpr int warming_steps = 10;

std::size_t longest_result(System& system) {
  const Layout layout = system.layout();
  int longest = std::max(layout.coordinates, layout.constraints);
  if (SparseForm* sparse = system.sparse_form()) {
    longest = std::max(longest, sparse->pattern().nonzeros());
  }
  if (ConstraintForm* constraints = system.constraint_form()) {
    longest = std::max(longest, constraints->pattern().nonzeros());
  }
  return static_cast<std::size_t>(longest);
}

/// Keeps the times and prints less: of repeated runs the median, the spread and the fit.
class Collector : public benchmark::ConsoleReporter {
 public:
  Collector() : ConsoleReporter(isatty(STDOUT_FILENO) ? OO_Color : OO_None) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    std::vector<Run> shown;
    for (const Run& run : runs) {
      const bool fit = run.report_big_o || run.report_rms;
      const bool raw = run.run_type == Run::RT_Iteration;
      if (run.error_occurred) {
        measured.exit_code = 3;
      } else if (!fit && (raw || run.aggregate_name == "median")) {
        measured.seconds[run.run_name.function_name + '/' + run.run_name.args] =
            run.GetAdjustedCPUTime() / benchmark::GetTimeUnitMultiplier(run.time_unit);
      }
      if (run.error_occurred || fit || (raw && run.repetitions <= 1) ||
          run.aggregate_name == "median" || run.aggregate_name == "cv") {
        shown.push_back(run);
      }
    }
    if (!shown.empty()) ConsoleReporter::ReportRuns(shown);
  }

  Measured measured;
};

void add_context() {
  benchmark::AddCustomContext("git_commit", std::string(build_facts().commit));
  benchmark::AddCustomContext("git_dirty", build_facts().dirty() ? "yes" : "no");
  benchmark::AddCustomContext("compiler", std::string(build_facts().compiler));
  benchmark::AddCustomContext("flags", std::string(build_facts().flags));
  benchmark::AddCustomContext("sundials_speed_ratio",
                              fmt::format("{:.2f}", sundials_speed_ratio()));
  benchmark::AddCustomContext("cpu", machine().cpu);
  benchmark::AddCustomContext("simd", machine().simd);
  benchmark::AddCustomContext("kernels", machine().kernels);
  for (const auto& [library, version] : library_versions()) {
    benchmark::AddCustomContext(library, version);
  }
}

}  // namespace

Moving set_in_motion(std::string_view model, const ModelSettings& settings) {
  Moving moving;
  moving.system = make_model(model, settings);
  System& system = *moving.system;
  const Layout layout = system.layout();
  moving.a.resize(static_cast<std::size_t>(layout.coordinates));
  moving.lambda.resize(static_cast<std::size_t>(layout.constraints));
  moving.out.resize(longest_result(system));

  Options options;
  options.step = warming_step;
  const bool constrained = layout.constraints > 0;
  if (constrained) options.formulation = Formulation::index3;
  Simulation run = simulate("backward_euler", system, options, initial_state(system),
                            warming_steps * warming_step);
  moving.status = run.status;
  moving.t = run.t;
  moving.state = std::move(run.state);
  if (moving.status != Status::ok) return moving;

  options.formulation = constrained ? Formulation::acceleration : Formulation::parametric;
  moving.status =
      Dynamics(system, options)
          .accelerate(moving.t, moving.state.q, moving.state.v, moving.a, moving.lambda);
  return moving;
}

ModelSettings spinning_chain(int links) {
  return {{"links", std::to_string(links)}, {"spin_rad_s", "1"}};
}

Moving& MovingFamily::at(int size) {
  const auto found = made_.find(size);
  if (found != made_.end()) return found->second;
  return made_.emplace(size, set_in_motion(model_, settings_(size))).first->second;
}

double time_ratio(const std::function<void()>& of, const std::function<void()>& to) {
  constexpr int runs = 31;
  std::vector<double> ratios;
  for (int i = 0; i < runs; ++i) {
    const double first = seconds_of(i % 2 == 0 ? of : to),
                 second = seconds_of(i % 2 == 0 ? to : of);
    ratios.push_back(i % 2 == 0 ? first / second : second / first);
  }
  return median(ratios);
}

bool kept(std::string_view subject, std::string_view what, double value, double most) {
  const bool good = value <= most;
  fmt::print("requirement on {}: {}: {} takes {:.3g} (at most {:.3g})\n", subject,
             good ? "met" : "NOT met", what, value, most);
  return good;
}

void count_per_element(benchmark::State& state, int elements) {
  using benchmark::Counter;
  state.counters["s_per_element"] =
      Counter(elements, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void with_sizes(benchmark::internal::Benchmark* registered, std::span<const int> sizes) {
  for (const int size : sizes) registered->Arg(size);
  registered->Complexity();
}

Measured run_benchmarks(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return {2, {}};
  add_context();
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  benchmark::Shutdown();
  return std::move(collector.measured);
}

int run_and_judge(int argc, char** argv,
                  const std::function<bool(const Measured&)>& met) {
  const Measured measured = run_benchmarks(argc, argv);
  if (measured.exit_code != 0) return measured.exit_code;
  return met(measured) ? 0 : 3;
}

}  // namespace tress::experiments::benchmarks
