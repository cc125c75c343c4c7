// An overhand (trefoil) knot in a straight elastic rod, pulled tight: force against the
// size of its loop. With h half the thickness, R the loop's circumference over 2 pi and e
// = sqrt(h/R), a knot that is being tightened needs
//
//     F h^2/EI = e^4/2 + 0.492 mu e^3
//
// [Audoly, Clauvelin & Neukirch 2007, PRL 99, 164301; Choi et al. 2021, eq. 25], at
// leading order in e. The two strands touch along a braid of some e R; the loop is what
// lies between its ends. A loop that begins smaller than the force would make it is held
// by friction: the knot is tied loosely, and damped so that it does not overshoot.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "contract/parameters.h"
#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/touching.h"
#include "experiments/validation/test.h"
#include "simulation/scene/shapes.h"

namespace tress::experiments::validation {
namespace {

const double rope = TestRod().length;     // m, what is tied
const double half_thick = 1.8e-3 * rope;  // h
constexpr double tight = 0.22;            // e that is aimed at

/// A torus knot cut open where it is outermost, its ends bent away to both sides. It has
/// half of the rope, and its loop is larger than that of `tight`.
std::vector<double> overhand_knot() {
  const double a = rope / 64;
  std::vector<double> points;
  const auto add = [&](double x, double y, double z) {
    points.insert(points.end(), {a * x, a * y, a * z});
  };
  add(4, 16, 0.8);
  add(4, 10, 0.8);
  add(3.8, 4, 0.8);
  const double from = 0.3, to = 2 * std::numbers::pi - from;
  for (int k = 0; k <= 40; ++k) {
    const double t = from + (to - from) * k / 40, r = 2 + std::cos(3 * t);
    add(r * std::cos(2 * t), r * std::sin(2 * t), std::sin(3 * t));
  }
  add(3.8, -4, -0.8);
  add(4, -10, -0.8);
  add(4, -16, -0.8);
  return points;
}

double force_of(double e, double friction) {
  return std::pow(e, 4) / 2 + 0.492 * friction * std::pow(e, 3);
}

/// Force over that of theory at the size of the loop.
double measured_force(const ModelTrial& trial) {
  const auto curve =
      simulation::through_points(overhand_knot(), trial.elements, 1, {0, 0, 1}, "knot");
  TestRod rod;
  rod.length = curve.length;
  rod.initial = curve.shape;
  Strand strand = rod.strand(trial.elements, curve.frame);
  strand.free_root = FreeRoot{curve.position, curve.frame, {}, {}};

  const double mu = trial.parameter, unit = rod.bending() / (half_thick * half_thick);
  const double pull = unit * force_of(tight, mu);
  const double size = half_thick / (tight * tight);  // R
  const double period = size * size / std::sqrt(rod.bending() / rod.line_mass());
  const double t_end = 300 * period, dt = period / 5;
  std::vector<EffectSettings> effects;
  for (const double end : {0.0, 1.0}) {
    const double far = end == 0 ? 1e3 : -1e3;
    effects.push_back({"tether",
                       {{"at", number_text(end)},
                        {"pull_n", number_text(pull)},
                        {"target_m", "0," + number_text(far) + ",0"},
                        {"t_off_s", "1e6"},
                        {"ramp_s", number_text(0.1 * t_end)}}});
  }
  effects.push_back(
      {"linear_drag",
       {{"drag_kg_m_s", "0"}, {"mass_damping_per_s", number_text(1 / period)}}});
  effects.push_back({"strand_friction",
                     {{"friction", number_text(mu)},
                      {"thickness_m", number_text(2 * half_thick)},
                      {"tolerance_m_s", number_text(1e-5 * size / period)}}});
  simulation::World world(
      touching_strands(trial.variant, {strand}, effects, dt, trial.contact.integrator));
  for (int i = 1; i <= 100; ++i) {
    go_on(world, t_end * i / 100, trial.contact);
    if (trial.deadline.passed())
      throw std::runtime_error("the time for the row was over");
  }
  // The loop is what lies between the two ends of the braid.
  double leaves = 0, returns = curve.length, pushed = 0;
  for (const StrandFriction::Touch& touch : world.friction()->touches()) {
    if (!(norm(touch.force) > 0)) continue;
    leaves = std::fmax(leaves, touch.first);
    returns = std::fmin(returns, touch.second);
    pushed += norm(touch.force);
  }
  if (pushed == 0) throw std::runtime_error("the knot has come undone");
  const double loop = (returns - leaves) / (2 * std::numbers::pi);
  return pull / (unit * force_of(std::sqrt(half_thick / loop), mu));
}

}  // namespace

std::vector<ValidationTest> knot_tests() {
  return {{
      .name = "knot",
      .what = "an overhand knot pulled tight",
      .source = "Audoly et al. 2007; Choi et al. 2021, eq. 25",
      .parameter = "friction coefficient mu",
      .quantity = "force over that of theory at the size of the loop",
      .range = {0.01, 0.2},
      .quick = {{0.1}, {180}},
      .usual = {{0.05, 0.1, 0.2}, {180}},
      .full = {{0.02, 0.05, 0.1, 0.2}, {180, 360}},
      .tolerance = 0.2,
      .why = "theory is of leading order in e = 0.2",
      .judged_from = 180,
      .claimed = {"der", "corde", "xpbd_cosserat", "dynamic_spline", "mass_spring",
                  "inextensible_strand"},
      .reference = [](double) { return 1.0; },
      .slow = {"super_helix", "super_clothoid", "articulated_chain", "force_transport",
               "kirchhoff_nodal", "xpbd_cosserat", "dynamic_spline",
               "inextensible_strand"},
      .measure = measured_force,
  }};
}

}  // namespace tress::experiments::validation
