// One strand of 10 elements, one step: its System with an integrator, and a batch of one
// strand in one SIMD lane, as multiples of the reference kernel. Both call the same
// kernel, so neither may be slower than the other by much. Exact Jacobians of reduced
// models are the exception: a System computes them by code of its own.
#include <fmt/format.h>

#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>

#include "contract/constants.h"
#include "experiments/benchmarks/fixture.h"
#include "experiments/benchmarks/reference_strands.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/effects/gravity.h"
#include "models/reduced/reduced_strand.h"
#include "simulation/head/make_head.h"

namespace tress::experiments::benchmarks {
namespace {

using models::Head;
using simulation::HeadMethod;

constexpr int steps = 4000, rounds = 8;

struct Model {
  std::string_view id;
  std::unique_ptr<Head> (*batch)(const simulation::HeadOptions&, const models::HeadPack&);
  std::string_view approximate;  // Jacobian of the batch with linearly_implicit_euler
  double most = 1.1;             // System over batch
};
struct Method {
  std::string_view id;
  HeadMethod of_batch;
  bool exact;
};

/// A System has sweeps of its own for matrix, residual and solution, where a batch has
/// one for all three. In chains, whose elements are closed sums, that is a third of the
/// time.
constexpr double articulated_most = 1.4;

constexpr Model strand_models[] = {
    {"mass_spring", simulation::spring_head, "filtered"},
    {"der", simulation::der_head, "elastic"},
    {"super_helix", simulation::helix_head, "elastic"},
    {"articulated_chain", simulation::chain_head, "elastic", articulated_most}};
constexpr Method methods[] = {
    {"linearly_implicit_euler", HeadMethod::linearly_implicit_euler, false},
    {"linearly_implicit_midpoint", HeadMethod::linearly_implicit_midpoint, true}};

const Vec gravity{0, 0, -earth_gravity};

/// Steps of one kind, and the least processor time of one (s).
struct Timed {
  std::string name;
  std::function<void()> go;  // `steps` steps
  double most = 0;           // over the one before; 0: is not compared
  double least = std::numeric_limits<double>::infinity();
};

double processor_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::function<void()> reference_steps() {
  return [kernel = std::make_shared<ReferenceStrands>(reference::lanes)] {
    for (int s = 0; s < steps / reference::lanes; ++s) kernel->step();
  };
}

std::function<void()> batch_steps(const Model& model, const Method& method) {
  simulation::HeadOptions options;
  options.method = method.of_batch;
  options.elements = reference_elements;
  options.longest = reference_length;
  options.gravity = gravity;
  options.points =
      models::quadrature_points(curl(0) * reference_length / reference_elements);
  const std::shared_ptr<Head> batch =
      model.batch(options, {models::HeadNumber::float64, 1});
  batch->add(reference_hair(0));
  return [batch, scratch = std::shared_ptr<Head::Scratch>(batch->scratch()),
          t = 0.0]() mutable {
    for (int s = 0; s < steps; ++s, t += reference_step) {
      batch->step(0, t, reference_step, *scratch);
    }
  };
}

std::function<void()> system_steps(const Model& model, const Method& method) {
  const models::ModelEntry& entry = models::find_model(model.id);
  Parameters parameters(entry.parameters, "benchmark");
  if (!method.exact) parameters.set("jacobian", model.approximate);
  const std::shared_ptr<System> system = entry.on_strand(
      reference_hair(0), parameters, {std::make_shared<models::Gravity>(gravity)});
  Options options;
  options.step = reference_step;
  const std::shared_ptr<Integrator> integrator =
      integrators::make_integrator(method.id, *system, options);
  const State start = initial_state(*system);
  const auto expect_ok = [](Status s) {
    if (s != Status::ok) throw std::runtime_error("a strand has no next step");
  };
  expect_ok(integrator->start(0, start.q, start.v));
  return [system, integrator, expect_ok, t = 0.0]() mutable {
    t += steps * reference_step;
    expect_ok(integrator->advance(t));
  };
}

std::vector<Timed> all_steps() {
  std::vector<Timed> all{{"reference", reference_steps()}};
  for (const Model& model : strand_models) {
    for (const Method& method : methods) {
      const std::string name = fmt::format("{}, {}", model.id, method.id);
      all.push_back({name + ", batch", batch_steps(model, method)});
      all.push_back({name + ", System", system_steps(model, method), model.most});
    }
  }
  return all;
}

void register_all() {
  for (const Timed& one : all_steps()) {
    benchmark::RegisterBenchmark(one.name.c_str(), [one](benchmark::State& state) {
      for ([[maybe_unused]] auto _ : state) one.go();
      count_per_element(state, steps * reference_elements);
    });
  }
}

bool costs_met() {
  std::vector<Timed> all = all_steps();
  for (int round = 0; round < rounds; ++round) {
    for (Timed& one : all) {
      const double start = processor_s();
      one.go();
      one.least = std::min(one.least, processor_s() - start);
    }
  }
  for (const Timed& one : all) {
    fmt::print("{}: {:.0f} ns per element, {:.2f} times the reference\n", one.name,
               1e9 * one.least / (steps * reference_elements), one.least / all[0].least);
  }
  bool met = true;
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (all[k].most == 0) continue;
    met = kept("one strand", all[k].name + " over batch,",
               all[k].least / all[k - 1].least, all[k].most) &&
          met;
  }
  return met;
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  using namespace tress::experiments::benchmarks;
  register_all();
  return run_and_judge(argc, argv, [](const Measured&) { return costs_met(); });
}
