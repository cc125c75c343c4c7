// Strands of reduced coordinates: helix functions, geometry and matrices of elements, the
// sweeps of each linear solver, and what System and a step make of them, over sizes.
#include <fmt/format.h>

#include <memory>
#include <utility>

#include "experiments/benchmarks/fixture.h"
#include "experiments/problems/strand_scenes.h"
#include "models/catalogue.h"
#include "models/reduced/arc.h"
#include "models/reduced/four_strands.h"
#include "models/reduced/helix.h"
#include "models/reduced/kinematics.h"
#include "models/reduced/mass_tangent.h"
#include "models/reduced/super_helix.h"
#include "models/strand/strand_parameters.h"

namespace tress::experiments::benchmarks {
namespace {

constexpr double h = 1e-3;  // s
constexpr Weights backward_euler{1, h, h* h};

constexpr std::array linear_sizes = {5, 20, 80, 320};
constexpr std::array dense_sizes = {5, 20, 80};
constexpr std::string_view solvers[] = {"recursive", "composite", "sparse"};
constexpr std::string_view jacobians[] = {"elastic", "exact"};
constexpr std::string_view all_modes[] = {"bend_twist", "bend", "bend_planar"};

std::span<const int> sizes_of(std::string_view solver) {
  if (solver == "composite") return dense_sizes;
  return linear_sizes;
}

struct Choice {
  std::string_view solver, jacobian, modes;
};

/// A hair released horizontally.
ModelSettings released(const Choice& choice, int elements) {
  ModelSettings settings = find_strand_scene("release").settings;
  settings.emplace_back("elements", std::to_string(elements));
  settings.emplace_back("solver", choice.solver);
  settings.emplace_back("jacobian", choice.jacobian);
  settings.emplace_back("modes", choice.modes);
  return settings;
}

std::shared_ptr<MovingFamily> family_of(const Choice& choice) {
  return std::make_shared<MovingFamily>(
      "super_helix", [choice](int elements) { return released(choice, elements); });
}

/// Registers `run(state, elements)` over the sizes of a solver.
template <typename Run>
void register_sizes(const std::string& name, std::string_view solver, Run run) {
  auto* registered =
      benchmark::RegisterBenchmark(name.c_str(), [run](benchmark::State& state) {
        const auto elements = static_cast<int>(state.range(0));
        run(state, elements);
        state.SetComplexityN(elements);
        count_per_element(state, elements);
      });
  with_sizes(registered, sizes_of(solver));
}

// ---- functions of one arc length, and of four ---------------------------------------

template <class T>
void helix_benchmark(benchmark::State& state, double winding) {
  const double length = 0.01, curvature = winding / length;
  T s = length;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(s);
    HelixFunctions<T> f = helix_functions(s, curvature * curvature, length);
    benchmark::DoNotOptimize(f);
  }
}

void register_functions() {
  // One in each range: series of three lengths, closed forms.
  for (const double winding : {0.1, 1.0, 3.0, 20.0}) {
    benchmark::RegisterBenchmark(
        fmt::format("helix_functions/one/{}", winding).c_str(),
        [=](benchmark::State& state) { helix_benchmark<double>(state, winding); });
    benchmark::RegisterBenchmark(
        fmt::format("helix_functions/four/{}", winding).c_str(),
        [=](benchmark::State& state) { helix_benchmark<Pack>(state, winding); });
  }
}

// ---- elements and sweeps ------------------------------------------------------------

Parameters parameters_of(const Choice& choice, int elements) {
  Parameters p(setup_parameters(find_model("super_helix")), "benchmark");
  for (const auto& [key, value] : released(choice, elements)) p.set(key, value);
  return p;
}

ReducedStrand reduced(const Choice& choice, int elements) {
  const Parameters p = parameters_of(choice, elements);
  return reduced_strand(strand(p), Unknown::curvature, reduced_options(p), {});
}

/// A strand taken apart, at the state of one in motion.
template <class Kernel, int dofs>
class Parts {
 public:
  Parts(Moving& moving, ReducedStrand strand)
      : x_(moving),
        nearby_(moving.state.q),
        kinematics_(std::move(strand.segments), std::move(strand.blocks),
                    {std::move(strand.root)}, std::nullopt, 0) {
    for (double& entry : nearby_) entry += 1e-9;
    for (const auto& segment : kinematics_.segments()) {
      tangent_.parent.push_back(segment.parent);
    }
    tangent_.segments.resize(tangent_.parent.size());
    linear_ = make_tree_solver<MassShape<dofs>>(strand.method, tangent_);
  }

  /// Everything once, so that each can be called by itself.
  Status prepare() {
    for (const auto call : {&Parts::geometry, &Parts::motion, &Parts::matrices,
                            &Parts::up_sweep, &Parts::down_sweep}) {
      if (const Status s = (this->*call)(); s != Status::ok) return s;
    }
    return x_.status;
  }

  /// At another place each time: at the same one it would be kept.
  Status geometry() {
    kinematics_.shape(x_.state.q);
    std::swap(x_.state.q, nearby_);
    return Status::ok;
  }
  Status motion() {
    kinematics_.move(x_.t, x_.state.q, x_.state.v, x_.a);
    return Status::ok;
  }
  Status matrices() {
    for (std::size_t i = 0; i < tangent_.segments.size(); ++i) {
      mass_tangent(kinematics_, i, backward_euler, tangent_.segments[i]);
    }
    return Status::ok;
  }
  Status up_sweep() { return linear_->factor(tangent_); }
  Status down_sweep() { return linear_->solve(x_.a, x_.first(x_.a.size())); }

 private:
  Moving& x_;
  std::vector<double> nearby_;
  Kinematics<Kernel, dofs> kinematics_;
  TreeTangent<MassShape<dofs>> tangent_;
  std::unique_ptr<TreeSolver<MassShape<dofs>>> linear_;
};

template <class Kernel, int dofs>
void register_parts(std::string_view modes) {
  using P = Parts<Kernel, dofs>;
  const auto add = [modes](const std::string& name, std::string_view solver,
                           Status (P::*call)()) {
    const Choice choice{solver, "elastic", modes};
    register_sizes(name, solver,
                   [choice, call, family = family_of(choice)](benchmark::State& state,
                                                              int elements) {
                     P parts(family->at(elements), reduced(choice, elements));
                     if (parts.prepare() != Status::ok) {
                       state.SkipWithError("nothing to measure at");
                       return;
                     }
                     measure(state, [&] { return (parts.*call)(); });
                   });
  };
  add(fmt::format("geometry/{}", modes), "recursive", &P::geometry);
  add(fmt::format("motion/{}", modes), "recursive", &P::motion);
  add(fmt::format("matrices/{}", modes), "recursive", &P::matrices);
  // Of the dense and the sparse solver: factorisation and solve.
  for (const std::string_view solver : solvers) {
    add(fmt::format("up_sweep/{}/{}", solver, modes), solver, &P::up_sweep);
    add(fmt::format("down_sweep/{}/{}", solver, modes), solver, &P::down_sweep);
  }
}

// ---- System and whole steps ---------------------------------------------------------

Status residual(Moving& x) {
  return x.system->residual(x.t, x.state.q, x.state.v, x.a, x.first(x.a.size()));
}
Status linearize(Moving& x) {
  return x.system->linearize(x.t, x.state.q, x.state.v, x.a, backward_euler);
}
Status solve(Moving& x) { return x.system->solve(x.a, x.first(x.a.size())); }

void system_benchmark(benchmark::State& state, Moving& x, Status (*call)(Moving&)) {
  if (x.status != Status::ok || linearize(x) != Status::ok) {
    state.SkipWithError("nothing to measure at");
    return;
  }
  std::vector<double> nearby = x.state.q;
  for (double& entry : nearby) entry += 1e-9;
  const bool moves = call != solve;
  measure(state, [&] {
    if (moves) std::swap(x.state.q, nearby);  // what depends on q alone would be kept
    return call(x);
  });
}

void step_benchmark(benchmark::State& state, const Moving& from,
                    std::string_view integrator) {
  constexpr int batch = 20;
  Options options;
  options.step = h;
  const auto method = make_integrator(integrator, *from.system, options);
  while (state.KeepRunningBatch(batch)) {
    Status s = from.status;
    if (s == Status::ok) s = method->start(from.t, from.state.q, from.state.v);
    if (s == Status::ok) s = method->advance(from.t + batch * h);
    if (s != Status::ok) {
      state.SkipWithError(method->failure().c_str());
      return;
    }
  }
}

void register_systems() {
  const auto add = [](std::string_view name, const Choice& choice,
                      Status (*call)(Moving&)) {
    register_sizes(
        fmt::format("{}/{}/{}/{}", name, choice.solver, choice.jacobian, choice.modes),
        choice.solver,
        [call, family = family_of(choice)](benchmark::State& state, int elements) {
          system_benchmark(state, family->at(elements), call);
        });
  };
  for (const std::string_view modes : all_modes) {
    add("residual", {"recursive", "exact", modes}, residual);
  }
  for (const std::string_view solver : solvers) {
    for (const std::string_view jacobian : jacobians) {
      add("linearize", {solver, jacobian, "bend_twist"}, linearize);
      add("solve", {solver, jacobian, "bend_twist"}, solve);
    }
  }
}

void register_steps() {
  const auto add = [](std::string_view integrator, const Choice& choice) {
    register_sizes(
        fmt::format("step/{}/{}/{}/{}", integrator, choice.solver, choice.jacobian,
                    choice.modes),
        choice.solver,
        [integrator, family = family_of(choice)](benchmark::State& state, int elements) {
          step_benchmark(state, family->at(elements), integrator);
        });
  };
  for (const std::string_view solver : solvers) {
    for (const std::string_view jacobian : jacobians) {
      for (const std::string_view modes : all_modes) {
        add("linearly_implicit_euler", {solver, jacobian, modes});
      }
    }
    add("backward_euler", {solver, "exact", "bend_twist"});
  }
}

// ---- strands by four ----------------------------------------------------------------

/// Four strands at rest.
Moving batch_of(models::Unknown unknown, int elements) {
  const Parameters p = parameters_of({"recursive", "elastic", "bend_twist"}, elements);
  const std::vector<Strand> strands(4, strand(p));
  Moving batch;
  batch.system = four_strands(strands, unknown, reduced_options(p),
                              std::vector<Effects>(strands.size(), strand_effects(p)));
  batch.state = initial_state(*batch.system);
  return batch;
}

void register_batches() {
  constexpr std::array sizes = {5, 10, 20};
  const auto add = [&](const std::string& name, models::Unknown unknown) {
    auto* registered = benchmark::RegisterBenchmark(
        ("step/linearly_implicit_euler/four/" + name).c_str(),
        [unknown](benchmark::State& state) {
          const auto elements = static_cast<int>(state.range(0));
          step_benchmark(state, batch_of(unknown, elements), "linearly_implicit_euler");
          state.SetComplexityN(elements);
          count_per_element(state, 4 * elements);
        });
    with_sizes(registered, sizes);
  };
  add("super_helix", models::Unknown::curvature);
  add("articulated_chain", models::Unknown::joint_angle);
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  tress::experiments::benchmarks::register_functions();
  tress::experiments::benchmarks::register_parts<tress::models::Helix, 3>("bend_twist");
  tress::experiments::benchmarks::register_parts<tress::models::Arc, 1>("bend_planar");
  tress::experiments::benchmarks::register_systems();
  tress::experiments::benchmarks::register_steps();
  tress::experiments::benchmarks::register_batches();
  return tress::experiments::benchmarks::run_benchmarks(argc, argv).exit_code;
}
