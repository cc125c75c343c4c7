// Exact contact by impulses: how a strand responds to forces on its points (assembly),
// the contacts of one strand with a plane, and a sweep over the contacts of a head of
// hair; requirements as multiples of the reference kernel in the same process.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "experiments/benchmarks/fixture.h"
#include "experiments/benchmarks/reference_strands.h"
#include "integrators/control/impulse_response.h"
#include "models/contact/contact_problem.h"
#include "simulation/run/timing.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::benchmarks {
namespace {

constexpr std::array<std::string_view, 3> models = {"super_helix", "der", "mass_spring"};
constexpr int elements = 10;
constexpr double h = 3e-3;  // s

/// A hair of 10 elements some steps into its fall, with the matrix of its last step.
struct Falling {
  explicit Falling(std::string_view model) {
    const simulation::Scene scene = simulation::parse_scene(
        fmt::format("title = \"falling\"\nduration_s = 1\n[model]\nid = \"{}\"\n"
                    "[integrator]\nid = \"linearly_implicit_euler\"\ndt_s = {}\n"
                    "[strand]\nlength_m = 0.2\nelements = {}\n[effects.gravity]\n",
                    model, h, elements),
        "falling.toml");
    system = scene.model->on_strand(scene.strands.front(), scene.model_options,
                                    make_effects(scene));
    method = integrators::find_integrator(scene.integrator).make(*system, scene.options);
    response =
        std::make_unique<integrators::ImpulseResponse>(*system, *method, scene.options);
    const State start = initial_state(*system);
    v_before.assign(start.v.begin(), start.v.end());
    (void)method->start(0, start.q, start.v);
    (void)method->advance(10 * h, [&](double, In, In v) {
      v_before.assign(v.begin(), v.end());
      return true;
    });
    for (int i = 1; i <= elements; ++i) points.push_back(i);
  }
  Status assemble() {
    const Status s = response->prepare(h, v_before);
    return s == Status::ok ? response->compliance(points, blocks) : s;
  }
  std::unique_ptr<System> system;
  std::unique_ptr<Integrator> method;
  std::unique_ptr<integrators::ImpulseResponse> response;
  std::vector<double> v_before, blocks;
  std::vector<int> points;
};

ContactProblem::Compliance compliance_of(std::string_view model) {
  Falling strand(model);
  if (strand.assemble() != Status::ok) return {};
  return ContactProblem::Compliance(strand.blocks);
}

void assembly(benchmark::State& state, std::string_view model) {
  Falling strand(model);
  measure(state, [&] { return strand.assemble(); });
}

/// A place along a strand, as the two points about it.
void put(ContactProblem::Contact& contact, std::size_t end, int body, double along,
         double sign) {
  const int from = std::min(static_cast<int>(along), elements - 2);
  const double part = along - from;
  contact.ends[end] = {body, from, sign * (1 - part)};
  contact.ends[end + 1] = {body, from + 1, sign * part};
}

ContactProblem::Contact thrown(std::mt19937& random) {
  std::normal_distribution<double> normal;
  ContactProblem::Contact contact{};
  contact.friction = 0.3;
  contact.axes = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  contact.free = {-0.03 * (1 + 0.2 * normal(random)), 0.02 * normal(random), 0.01};
  return contact;
}

/// Contacts of one strand with a plane, to the default tolerance. The start is zero, or
/// the forces of a step before, since when velocities have changed by 1 %.
class OnPlane {
 public:
  OnPlane(std::string_view model, int contacts, bool warm)
      : compliance_(compliance_of(model)) {
    std::mt19937 random(1);
    for (int i = 0; i < contacts; ++i) {
      ContactProblem::Contact contact = thrown(random);
      put(contact, 0, 0, (elements - 1) * (i + 0.5) / contacts, 1);
      put(contact, 2, 0, 0, 0);
      all_.push_back(contact);
    }
    if (!warm) return;
    solve();
    all_.assign(problem_.contacts().begin(), problem_.contacts().end());
    for (auto& contact : all_) contact.free = 1.01 * contact.free;
  }
  void solve() {
    problem_.clear();
    problem_.add_body(compliance_);
    for (const auto& contact : all_) problem_.add(contact);
    outcome = problem_.solve(proximal, tolerance, most_sweeps);
  }
  bool solved() const { return outcome.violation <= tolerance; }
  ContactProblem::Outcome outcome;

 private:
  static constexpr double proximal = 1e-2, tolerance = 1e-6;  // 1, m/s
  static constexpr int most_sweeps = 10'000;
  ContactProblem::Compliance compliance_;
  std::vector<ContactProblem::Contact> all_;
  ContactProblem problem_;
};

void on_plane(benchmark::State& state, std::string_view model, bool warm) {
  OnPlane plane(model, static_cast<int>(state.range(0)), warm);
  for ([[maybe_unused]] auto _ : state) {
    plane.solve();
    benchmark::ClobberMemory();
  }
  if (!plane.solved()) state.SkipWithError("not solved");
  state.counters["sweeps"] = plane.outcome.sweeps;
}

/// Contacts between neighbours of a thousand strands.
class BetweenStrands {
 public:
  static constexpr int strands = 1000, contacts = 5000, sweeps = 10;

  explicit BetweenStrands(std::string_view model) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> part(0, elements - 1);
    std::uniform_int_distribution<int> any(0, strands - 1), apart(1, 8);
    // Each strand has its own, as on a head.
    compliance_.assign(strands, compliance_of(model));
    for (const auto& compliance : compliance_) problem_.add_body(compliance);
    for (int i = 0; i < contacts; ++i) {
      ContactProblem::Contact contact = thrown(random);
      const int first = any(random);
      put(contact, 0, first, part(random), 1);
      put(contact, 2, (first + apart(random)) % strands, part(random), -1);
      problem_.add(contact);
    }
  }
  void sweep() { benchmark::DoNotOptimize(problem_.solve(1e-2, 0, sweeps).violation); }

 private:
  std::vector<ContactProblem::Compliance> compliance_;
  ContactProblem problem_;
};

/// Time per contact and sweep.
void between_strands(benchmark::State& state, std::string_view model) {
  BetweenStrands between(model);
  for ([[maybe_unused]] auto _ : state) between.sweep();
  state.counters["per_contact_sweep_s"] = benchmark::Counter(
      static_cast<double>(BetweenStrands::contacts) * BetweenStrands::sweeps,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// A thousand guides of 10 elements on a head that shakes, as in
/// scenes/shaken_guides.toml, which rub on each other and on the head or do not.
std::string shaken_guides(bool rub) {
  constexpr std::string_view friction = R"(
[effects.strand_friction]
friction = 0.3
thickness_m = 5e-4
tolerance_m_s = 1e-3
)";
  return fmt::format(R"(title = "shaken guides"
duration_s = 1
[model]
id = "super_helix"
modes = "bend_twist"
jacobian = "elastic"
[integrator]
id = "linearly_implicit_euler"
dt_s = {}
[material]
name = "hair.asian"
youngs_modulus_pa = 1e6
[groom]
count = 1000
elements = {}
length_m = 0.2
[root]
motion = "head"
axis = [0, 0, 1]
centre_m = [-0.02, 0, -0.1]
torque_n_m = 0.6
frequency_hz = 1.5
periods = 3
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 1e-4
[effects.body]
shape = "ellipsoid"
half_axes_m = [0.098, 0.078, 0.118]
moves = "head"
{})",
                     h, elements, rub ? friction : "");
}

/// Time of a step on two threads (s), mean over the first 0.9 s, in which about 4000
/// contacts form. NaN: a strand was lost, or the law did not hold within its tolerance
/// at the end of every step.
double time_of_step(bool rub) {
  constexpr int steps = 300, threads = 2;
  simulation::World world(
      simulation::parse_scene(shaken_guides(rub), "shaken_guides.toml"), threads);
  bool good = true;
  const double all =
      simulation::seconds_of([&] { good = world.advance(steps * h) == Status::ok; });
  return good && world.stats().contact_unfinished == 0 ? all / steps : std::nan("");
}

void register_all() {
  for (const std::string_view model : models) {
    const auto add = [model](std::string_view name, auto call) {
      return benchmark::RegisterBenchmark(
          fmt::format("{}/{}", name, model).c_str(),
          [=](benchmark::State& state) { call(state, model); });
    };
    add("assembly", assembly);
    for (const bool warm : {false, true}) {
      const auto call = [warm](benchmark::State& state, std::string_view name) {
        on_plane(state, name, warm);
      };
      add(warm ? "on_plane_warm" : "on_plane", call)->Arg(11)->Arg(40);
    }
    add("between_strands", between_strands);
  }
}

// Requirements are times (s) on a machine that takes this for one element and step of the
// reference kernel.
constexpr double unit = 82e-9;  // s

/// Time of one of the `calls` calls of `of`, over an element and step of the reference.
double over_reference(const std::function<void()>& of, double calls) {
  constexpr std::size_t strands = 64;
  constexpr int steps = 40;
  ReferenceStrands kernel(strands);
  const double ratio = time_ratio(of, [&] {
    for (int i = 0; i < steps; ++i) kernel.step();
  });
  return ratio * steps * strands * reference_elements / calls;
}

std::function<void()> repeated(int times, const std::function<void()>& call) {
  return [=] {
    for (int i = 0; i < times; ++i) call();
  };
}

bool requirements_met(std::string_view model) {
  bool met = true;
  const auto require = [&](std::string_view what, double value, double most_s) {
    met = kept("contact", fmt::format("{}, {}, over the reference", model, what), value,
               most_s / unit) &&
          met;
  };
  Falling strand(model);
  require("response of 10 points",
          over_reference(repeated(40, [&] { (void)strand.assemble(); }), 40), 60e-6);
  BetweenStrands between(model);
  require("a contact and sweep of a head",
          over_reference([&] { between.sweep(); },
                         double{BetweenStrands::contacts} * BetweenStrands::sweeps),
          0.5e-6);
  for (const bool warm : {true, false}) {
    for (const auto& [contacts, most] : {std::pair(11, 10e-6), std::pair(40, 65e-6)}) {
      OnPlane plane(model, contacts, warm);
      require(fmt::format("{} contacts {}", contacts, warm ? "again" : "from nothing"),
              over_reference(repeated(40, [&] { plane.solve(); }), 40), most);
    }
  }
  return met;
}

/// What contact adds to a step of a head.
bool head_requirement_met() {
  const double unit_s = reference_time();
  const double contact = time_of_step(true) - time_of_step(false);
  return kept("contact",
              fmt::format("a step of 1000 guides on two threads, {:.1f} ms, over the "
                          "reference",
                          contact * 1e3),
              contact / unit_s, 25e-3 / unit);
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  using namespace tress::experiments::benchmarks;
  register_all();
  return run_and_judge(argc, argv, [](const Measured&) {
    bool met = true;
    for (const std::string_view model : models) met = requirements_met(model) && met;
    return head_requirement_met() && met;
  });
}
