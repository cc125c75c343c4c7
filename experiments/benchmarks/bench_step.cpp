// One step of every fixed-step integrator of the catalogue on the inextensible chain, in
// the first of these formulations that it can drive: index 3, projection, RATTLE, g'' =
// 0.
#include <algorithm>
#include <memory>

#include "experiments/benchmarks/fixture.h"

namespace tress::experiments::benchmarks {
namespace {

constexpr Formulation preferred[] = {Formulation::index3, Formulation::projection,
                                     Formulation::rattle, Formulation::acceleration};

/// Every batch repeats the same steps: one to fill a multistep method's history and the
/// caches, then those that are measured.
constexpr int steps_per_batch = 4;

/// The chain's fastest transverse wave has about 2 n sqrt(g / L) = 6 n rad/s, so this is
/// stable for every method. Newton still needs more iterations on longer chains with some
/// methods: the counters tell that from the cost of an iteration.
double step_size(int links) { return 0.01 / links; }  // s

void run(benchmark::State& state, const IntegratorEntry& entry, Formulation formulation,
         Moving& from) {
  if (from.status != Status::ok) {
    state.SkipWithError("no state to start from");
    return;
  }
  const auto links = static_cast<int>(state.range(0));
  const double h = step_size(links);
  Options options;
  options.formulation = formulation;
  options.step = h;
  const auto integrator = entry.make(*from.system, options);
  Stats before, after;
  while (state.KeepRunningBatch(steps_per_batch)) {
    state.PauseTiming();
    Status status = integrator->start(from.t, from.state.q, from.state.v);
    if (status == Status::ok) status = integrator->advance(from.t + h);
    before = integrator->stats();
    state.ResumeTiming();
    if (status == Status::ok) {
      status = integrator->advance(from.t + (1 + steps_per_batch) * h);
    }
    if (status != Status::ok) {
      state.SkipWithError(integrator->failure().c_str());
      return;
    }
  }
  after = integrator->stats();
  const auto per_step = [](long begin, long end) {
    return static_cast<double>(end - begin) / steps_per_batch;
  };
  state.counters["linearizations"] =
      per_step(before.linearizations, after.linearizations);
  state.counters["solves"] = per_step(before.solves, after.solves);
  state.SetComplexityN(links);
  count_per_element(state, links);
}

void register_all() {
  const auto chains =
      std::make_shared<MovingFamily>("inextensible_chain", spinning_chain);
  const auto chain = make_model("inextensible_chain");
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.adaptive) continue;
    const auto drivable = std::ranges::find_if(preferred, [&](Formulation formulation) {
      return refusal(entry, *chain, formulation).empty();
    });
    if (drivable == std::end(preferred)) continue;
    const Formulation formulation = *drivable;
    const std::string title =
        std::string(entry.id) + '/' + std::string(name(formulation));
    auto* registered =
        benchmark::RegisterBenchmark(title.c_str(), [=](benchmark::State& state) {
          run(state, entry, formulation, chains->at(static_cast<int>(state.range(0))));
        });
    with_sizes(registered, chain_links);
  }
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  tress::experiments::benchmarks::register_all();
  return tress::experiments::benchmarks::run_benchmarks(argc, argv).exit_code;
}
