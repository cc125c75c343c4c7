#include "experiments/problems/strand_scenes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "integrators/formulation/projection.h"
#include "math/vec3.h"
#include "models/strand/strand_parameters.h"

namespace tress::experiments {
namespace {

// Even 0.1 s, the longest step tried, gives three steps per period of the shaken clamps.
constexpr double any_step = StabilityBounds::none;

std::vector<StrandScene> make_scenes() {
  std::vector<StrandScene> all;
  all.push_back({"release",
                 "horizontal clamp, released straight under gravity",
                 {{"motion", "fixed"}, {"root_tangent", "x"}, {"initial", "natural"}},
                 1,
                 any_step,
                 false});
  // Greenhill: upright strands longer than (7.837 EI/(rho A g))^(1/3) = 9.0 cm buckle.
  // 0.5/m is a tip 3.6 mm off the vertical.
  all.push_back({"compress",
                 "upright, a third longer than Greenhill's length: buckles",
                 {{"motion", "fixed"},
                  {"root_tangent", "up"},
                  {"length_m", "0.12"},
                  {"initial", "bent"},
                  {"initial_curvature_per_m", "0.5"}},
                 2,
                 any_step,
                 false});
  all.push_back({"shake",
                 "release with the root shaken by 5 cm at 3 Hz",
                 {{"motion", "shake"},
                  {"root_tangent", "x"},
                  {"initial", "natural"},
                  {"amplitude_m", "0.05"},
                  {"frequency_hz", "3"}},
                 1,
                 any_step,
                 true});
  all.push_back({"shake_rotate",
                 "shake on a head that turns by 0.5 rad",
                 {{"motion", "shake_rotate"},
                  {"root_tangent", "x"},
                  {"initial", "natural"},
                  {"amplitude_m", "0.05"},
                  {"frequency_hz", "3"},
                  {"angle_rad", "0.5"},
                  {"head_radius_m", "0.1"}},
                 1,
                 any_step,
                 true});
  // A helix of 0.9 cm radius and 1.7 cm pitch. The clamp accelerates and brakes within
  // each 0.1 s: a third of that resolves both.
  all.push_back({"curl_drop",
                 "curly strand, dropped by 5 cm and pulled up again",
                 {{"motion", "drop_pull"},
                  {"root_tangent", "x"},
                  {"initial", "natural"},
                  {"amplitude_m", "0.05"},
                  {"frequency_hz", "5"},
                  {"natural_curvature_per_m", "100"},
                  {"natural_twist_per_m", "30"}},
                 1,
                 0.1 / 3,
                 true});
  // Kinetic energy enough to bend the strand to a half circle; 5 m/s would coil it up
  // several times. A step of half the stop ends where the clamp brakes most.
  all.push_back({"whip",
                 "hanging, the root stops from 2 m/s within 10 ms",
                 {{"motion", "stop"},
                  {"root_tangent", "down"},
                  {"initial", "natural"},
                  {"speed_m_s", "2"},
                  {"time_s", "0.01"}},
                 0.5,
                 0.005,
                 true});
  all.push_back({"swing",
                 "the strand on which other simulators were measured",
                 {{"motion", "swing"},
                  {"root_tangent", "x"},
                  {"initial", "natural"},
                  {"length_m", "0.2"},
                  {"radius_m", "40e-6"},
                  {"youngs_modulus_pa", "2e9"},
                  {"poisson_ratio", "0.48"},
                  {"density_kg_m3", "1300"},
                  {"gravity_m_s2", "9.81"},
                  {"amplitude_m", "0.05"},
                  {"frequency_hz", "1"},
                  {"mass_damping_per_s", "2"}},
                 2,
                 any_step,
                 true});
  return all;
}

constexpr double energy_tolerance = 0.01;
constexpr double reach_tolerance = 1e-3;
constexpr double perturbation = 1e-3;

}  // namespace

std::span<const StrandScene> strand_scenes() {
  static const std::vector<StrandScene> all = make_scenes();
  return all;
}

const StrandScene& find_strand_scene(std::string_view name) {
  std::vector<std::string_view> names;
  for (const StrandScene& scene : strand_scenes()) {
    if (scene.name == name) return scene;
    names.push_back(scene.name);
  }
  throw InputError("unknown scene '" + std::string(name) + "'", "strand scenes",
                   suggestion(name, names, "--list shows the scenes"));
}

State perturbed_start(System& system) {
  State start = initial_state(system);
  std::vector<double> q_typ(start.q.size()), v_typ(start.v.size());
  system.scale(q_typ, v_typ);
  constexpr double golden = 0.6180339887498949;  // its multiples are evenly spread
  for (std::size_t i = 0; i < v_typ.size(); ++i) {
    const double x = golden * static_cast<double>(i + 1);
    start.v[i] += perturbation * (2 * (x - std::floor(x)) - 1) * v_typ[i];
  }
  const Layout layout = system.layout();
  if (layout.constraints == 0) return start;
  Options options;
  options.formulation = Formulation::projection;
  Dynamics dynamics(system, options);
  const std::vector<double> zero_n(start.q.size());
  const std::vector<double> zero_m(static_cast<std::size_t>(layout.constraints));
  Status s = dynamics.linearize(0, start.q, start.v, zero_n, zero_m, {1, 0, 0});
  if (s == Status::ok) s = Projection(dynamics).velocities(0, start.q, start.v);
  if (s != Status::ok) throw std::runtime_error("no velocities along the constraints");
  return start;
}

double strand_speed_bound(const Parameters& parameters, double t_end) {
  const Strand made = strand(parameters);
  const double length = made.length();
  const Vec gravity{0, 0, -parameters.number("gravity_m_s2")};
  const auto size = [](const Vec& x) { return norm(x); };
  constexpr int samples = 20'000;  // of a smooth motion, midpoint rule
  const double dt = t_end / samples;
  double pushed = 0, turned = 0, omega_max = 0;
  for (int i = 0; i < samples; ++i) {
    const RootPose root = made.root.at((i + 0.5) * dt);
    const double omega = size(root.omega);
    pushed += dt * (size(root.a) + (size(root.alpha) + omega * omega) * length);
    turned += dt * size(cross(root.omega, gravity)) * length;
    omega_max = std::max(omega_max, omega);
  }
  const double u = std::sqrt(2 * (size(gravity) * length + turned)) + pushed;
  return std::sqrt(30.0) * u + omega_max * length;
}

StabilityBounds stability_bounds(const StrandScene& scene, const Parameters& parameters,
                                 System& system) {
  const Strand made = strand(parameters);
  if (scene.driven) {
    return {.reach = (1 + reach_tolerance) * made.length(),
            .speed = strand_speed_bound(parameters, scene.t_end)};
  }
  Energetics* energetics = system.energetics();
  if (energetics == nullptr) {
    throw InputError("a passive scene is judged by the model's energy",
                     "scene " + std::string(scene.name), "choose a model that has it");
  }
  const State start = initial_state(system);
  const double hanging =
      -made.mass() * parameters.number("gravity_m_s2") * made.length() / 2;
  return {.energy = energy_tolerance *
                    (energetics->energy(0, start.q, start.v).total() - hanging)};
}

StabilityBounds release_bounds(System& system, const State& start, double t_end) {
  Energetics& energetics = *system.energetics();
  Options options;
  options.step = 1e-3;
  const double at_start = energetics.energy(0, start.q, start.v).total();
  double kinetic = 0, gain = 0;
  const Simulation run = simulate("linearly_implicit_euler", system, options, start,
                                  t_end, [&](double t, In q, In v) {
                                    const Energy energy = energetics.energy(t, q, v);
                                    kinetic = std::max(kinetic, energy.kinetic);
                                    gain = std::max(gain, energy.total() - at_start);
                                    return true;
                                  });
  if (run.status != Status::ok || !(gain <= energy_tolerance * kinetic)) {
    throw InputError("released it gains energy at steps of 1 ms", "stability bounds",
                     "choose a scene that these steps resolve");
  }
  return {.energy = energy_tolerance * kinetic};
}

}  // namespace tress::experiments
