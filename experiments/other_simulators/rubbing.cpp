// What sticks in other simulators? Debian's Simbody, Bullet, MuJoCo and ODE on a tilted
// plane and on the capstan with a chain, beside exact contact of ours.
#include "experiments/other_simulators/rubbing.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/other_simulators/simulator.h"
#include "experiments/run/experiment.h"
#include "experiments/run/message.h"
#include "simulation/run/world.h"

namespace tress::experiments::other_simulators {
namespace {

constexpr double friction = 0.3;
constexpr int links = 16;

constexpr Column columns[] = {
    {"simulator", "library; tress: ours"},
    {"version", "version of the linked library"},
    {"method", "contact and integrator"},
    {"scene", "slope: a block on a plane, mu = 0.3; capstan: 16 links over a cylinder"},
    {"dt_s", "fixed step"},
    {"creep_um",
     "displacement in half a second at 90 % of the exact least load "
     "that slides"},
    {"slides_at",
     "least load that slides. Slope: tangent of the angle, for a slide "
     "of 1 mm in half a second. Capstan: ratio of pulls, for a slide of "
     "0.3 mm in two seconds"},
    {"exact", "slides_at by Coulomb's law"},
    {"error_rel", "slides_at over exact, less 1"},
};

/// `way` (mm) grows with the load.
template <class Way>
void measure(Row& row, double exact, double far, const Way& way) {
  row.set("exact", exact);
  const double creep = way(0.9 * exact);
  if (!std::isfinite(creep)) {
    row.failed("unstable", "not finite");
    return;
  }
  row.set("creep_um", 1e3 * std::abs(creep));
  double low = 0.5 * exact, high = 3 * exact;
  if (std::abs(way(high)) < far) {
    row.failed("failed", "it holds against three times the load");
    return;
  }
  if (std::abs(way(low)) > far) {
    row.failed("failed", "it slides at half of the load");
    return;
  }
  while (high - low > 1e-3 * exact) {
    const double middle = 0.5 * (low + high);
    (std::abs(way(middle)) > far ? high : low) = middle;
  }
  row.set("slides_at", 0.5 * (low + high));
  row.set("error_rel", 0.5 * (low + high) / exact - 1);
}

void add_cases(std::string_view simulator, std::string_view version,
               std::span<const RubbingMethod> methods, std::vector<Case>& all) {
  for (const RubbingMethod& method : methods) {
    for (const double dt : {1.0 / 30, 1.0 / 300, 1.0 / 3000}) {
      const auto identity = [&](std::string_view scene) {
        Row row;
        row.set("simulator", simulator)
            .set("version", version)
            .set("method", method.name);
        return row.set("scene", scene).set("dt_s", dt);
      };
      all.push_back({identity("slope"), [&method, dt](Row& row, const Deadline&) {
                       measure(row, friction, 1, [&](double tangent) {
                         return method.slope({tangent, friction}, dt);
                       });
                     }});
      if (method.capstan == nullptr) continue;
      all.push_back({identity("capstan"), [&method, dt](Row& row, const Deadline&) {
                       const double exact = Capstan{links, 1, friction}.slides_at();
                       measure(row, exact, 0.3, [&](double ratio) {
                         return method.capstan({links, ratio, friction}, dt);
                       });
                     }});
    }
  }
}

/// A hair of the block's size by one linear solve a step, and exact contact.
double our_slope(const Slope& slope, double dt) {
  const Vec g = 1e-3 * slope.gravity();  // m/s^2
  simulation::World world(simulation::parse_scene(
      fmt::format(
          "title = \"slope\"\nduration_s = 1\n[model]\nid = \"der\"\n"
          "[integrator]\nid = \"linearly_implicit_euler\"\ndt_s = {}\n[material]\n"
          "name = \"hair.asian\"\nellipticity = 1\nradius_m = 1e-3\n[strand]\n"
          "length_m = 0.01\nelements = 4\nposition_m = [0, 0, 1e-3]\n[root]\n"
          "motion = \"free\"\n[effects.gravity]\ngravity_m_s2 = [{}, 0, {}]\n"
          "[effects.body]\nfriction_law = \"exact\"\nnormal = \"rigid\"\n"
          "strand_radius_m = 1e-3\nfriction = {}\n[effects.strand_friction]\n"
          "tolerance_m_s = 1e-10\n",
          dt, g.x, g.z, slope.friction),
      "slope.toml"));
  if (world.advance(Slope::settling) != Status::ok) return std::nan("");
  const double start = world.positions()[0];
  if (world.advance(Slope::settling + Slope::watched) != Status::ok) return std::nan("");
  return 1e3 * (world.positions()[0] - start);
}

/// A strand with the joints of the links as its nodes, so soft that its bending is 2 % of
/// the pull, and naturally bent as it lies.
double our_capstan(const Capstan& capstan, double dt) {
  std::string points;
  for (int i = 0; i <= capstan.links; ++i) {
    const Vec at = 1e-3 * capstan.joint(i);
    points += fmt::format("{}[{}, {}, {}]", i == 0 ? "" : ", ", at.x, at.y, at.z);
  }
  const double pull = 1e-9 * Capstan::pull;  // N
  const auto tether = [&](double end, double force) {
    return fmt::format(
        "[[effects.tether]]\nat = {}\npull_n = {}\nramp_s = 0.01\n"
        "target_m = [{}, 0, -1e3]\n",
        end, force, end == 0 ? -0.01 : 0.01);
  };
  // The nodes touch where the middles of links do.
  const double touching = 1e-3 * (norm(capstan.joint(0)) - Capstan::radius);
  simulation::World world(simulation::parse_scene(
      fmt::format(
          "title = \"capstan\"\nduration_s = 1\n[model]\nid = \"der\"\n"
          "[integrator]\nid = \"linearly_implicit_euler\"\ndt_s = {}\n[material]\n"
          "name = \"hair.asian\"\nellipticity = 1\nradius_m = 5e-5\n"
          "youngs_modulus_pa = 1e6\n[strand]\nelements = {}\nnormal = [0, 1, 0]\n"
          "points = [{}]\n[root]\nmotion = \"free\"\n{}{}[effects.body]\n"
          "shape = \"capsule\"\nradius_m = {}\nlength_m = 0.05\n"
          "rotation_rad = [{}, 0, 0]\nfriction_law = \"exact\"\n"
          "normal = \"rigid\"\nstrand_radius_m = {}\nfriction = {}\n"
          "[effects.strand_friction]\ntolerance_m_s = 1e-9\nsweeps = 5000\n",
          dt, capstan.links, points, tether(0, pull), tether(1, capstan.ratio * pull),
          1e-3 * Capstan::radius, std::numbers::pi / 2, touching, capstan.friction),
      "capstan.toml"));
  const std::size_t middle = 3 * static_cast<std::size_t>(capstan.links / 2);
  const Vec start = load3(&world.positions()[middle]);
  if (world.advance(Capstan::watched) != Status::ok) return std::nan("");
  return 1e3 * norm(load3(&world.positions()[middle]) - start);
}

constexpr RubbingMethod ours[] = {
    {"exact contact, one linear solve a step (der)", our_slope, our_capstan}};

std::vector<Case> cases(const CommandLine&) {
  for (const std::string_view package : missing()) {
    tell("rubbing: not in this build: {} was not found\n", package);
  }
  std::vector<Case> all;
  add_cases("tress", "", ours, all);
  for (const Engine& engine : engines()) {
    add_cases(engine.id, engine.version, engine.rubbing, all);
  }
  return all;
}

void check_other_simulators(const std::vector<Row>& rows, Verdicts& verdicts) {
  double creep = 0, error = 0;
  int judged = 0;
  for (const Row& row : rows) {
    if (row.text("simulator") != "tress" || row.text("scene") != "slope" || !row.ok())
      continue;
    ++judged;
    creep = std::max(creep, row.number("creep_um"));
    error = std::max(error, std::abs(row.number("error_rel")));
  }
  const std::string sticks = "tress: a sticking strand moves by less than 1 nm";
  const std::string slides = "tress: a strand slides within 1 % of Coulomb's law";
  if (judged == 0) {
    verdicts.not_judged(sticks);
    verdicts.not_judged(slides);
    return;
  }
  verdicts.check(sticks, creep < 1e-3, creep);
  verdicts.check(slides, error < 0.01, error);
}

/// What another library does not hold is the finding.
bool finding(const Row& row) { return !row.ok(); }

constexpr Unused unused[] = {{"models", "the other_simulators have their own"},
                             {"integrators", "the other_simulators have their own"},
                             {"elements", "the scenes have their own"},
                             not_repeated,
                             not_random};

}  // namespace
}  // namespace tress::experiments::other_simulators

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::other_simulators;
  const Experiment experiment{.name = "other_simulators_rubbing",
                              .question = "what sticks in other simulators?",
                              .example = "",
                              .timed = false,
                              .columns = columns,
                              .unused = unused,
                              .cases = cases,
                              .checks = check_other_simulators,
                              .finding = finding};
  return run_experiment(experiment, argc, argv);
}
