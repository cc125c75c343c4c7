// A step of one strand of a scene, a curl that swings with its root in air: its System
// with an integrator, and a batch of one strand in one SIMD lane, as multiples of the
// reference kernel. Neither may be slower than the other by much. Where they have code of
// their own, the ratio depends on the number of elements and on drag, so strands have
// some and few.
#include <fmt/format.h>

#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>

#include "experiments/benchmarks/fixture.h"
#include "experiments/benchmarks/reference_strands.h"
#include "integrators/catalogue.h"
#include "models/reduced/reduced_strand.h"
#include "simulation/head/make_head.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::benchmarks {
namespace {

using models::Head;
using simulation::HeadMethod;
using simulation::Scene;

constexpr int steps = 1000, rounds = 8;
constexpr int element_counts[] = {3, 10, 20};

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

/// The curl winds by 4.4 rad, so that three elements can have it.
Scene curl_scene(const Model& model, const Method& method, int elements) {
  return simulation::parse_scene(
      fmt::format(R"(title = "curl that swings with its root"
duration_s = 1
[model]
id = "{}"
jacobian = "{}"
[integrator]
id = "{}"
dt_s = 5e-4
[material]
internal_friction_kg_m3_s = 1e-10
[strand]
length_m = 0.1
elements = {}
shape = "helix"
curl_radius_m = 0.02
curl_pitch_m = 0.03
[root]
motion = "swing"
amplitude_m = 0.005
frequency_hz = 3
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 5e-5
)",
                  model.id, method.exact ? "exact" : model.approximate, method.id,
                  elements),
      "curl.toml");
}

/// Steps of one kind, and the least processor time of one (s).
struct Timed {
  std::string name;
  int elements;
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

std::function<void()> batch_steps(const Scene& scene, const Model& model,
                                  const Method& method) {
  const models::Strand& strand = scene.strands.front();
  const models::Segment& first = strand.segments.front();
  simulation::HeadOptions options;
  options.method = method.of_batch;
  options.elements = static_cast<int>(strand.segments.size());
  options.longest = strand.length();
  options.gravity = {};
  options.motion = scene.head;
  options.effects = simulation::make_effects(scene);
  options.points = models::quadrature_points(first.length * norm(first.natural));
  const std::shared_ptr<Head> batch =
      model.batch(options, {models::HeadNumber::float64, 1});
  batch->add(strand);
  return [batch, scratch = std::shared_ptr<Head::Scratch>(batch->scratch()),
          h = scene.options.step, taken = 0]() mutable {
    for (int s = 0; s < steps; ++s) batch->step(0, taken++ * h, h, *scratch);
    if (batch->lost(0)) throw std::runtime_error("a strand of a batch is lost");
  };
}

std::function<void()> system_steps(const Scene& scene) {
  const std::shared_ptr<System> system = scene.model->on_strand(
      scene.strands.front(), scene.model_options, simulation::make_effects(scene));
  const std::shared_ptr<Integrator> integrator =
      integrators::make_integrator(scene.integrator, *system, scene.options);
  const State start = initial_state(*system);
  const auto expect_ok = [](Status s) {
    if (s != Status::ok) throw std::runtime_error("a strand has no next step");
  };
  expect_ok(integrator->start(0, start.q, start.v));
  return [system, integrator, expect_ok, h = scene.options.step, taken = 0]() mutable {
    taken += steps;
    expect_ok(integrator->advance(taken * h));
  };
}

std::vector<Timed> all_steps() {
  std::vector<Timed> all{{"reference", reference_elements, reference_steps()}};
  for (const Model& model : strand_models) {
    for (const Method& method : methods) {
      for (const int elements : element_counts) {
        const std::string name =
            fmt::format("{}, {}, {} elements", model.id, method.id, elements);
        const Scene scene = curl_scene(model, method, elements);
        all.push_back({name + ", batch", elements, batch_steps(scene, model, method)});
        all.push_back({name + ", System", elements, system_steps(scene), model.most});
      }
    }
  }
  return all;
}

void register_all() {
  for (const Timed& one : all_steps()) {
    benchmark::RegisterBenchmark(one.name.c_str(), [one](benchmark::State& state) {
      for ([[maybe_unused]] auto _ : state) one.go();
      count_per_element(state, steps * one.elements);
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
  const auto of_element = [](const Timed& one) {
    return one.least / (steps * one.elements);
  };
  for (const Timed& one : all) {
    fmt::print("{}: {:.0f} ns per element, {:.2f} times the reference\n", one.name,
               1e9 * of_element(one), of_element(one) / of_element(all[0]));
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
