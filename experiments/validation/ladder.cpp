// A stiff rod leans on a wall, both rough: it holds if it is steeper than tan = (1 -
// mu^2)/(2 mu), at which both its ends slide at once.
//
// Before it holds it may slide a little, until the wall's friction bears its share: a rod
// has fallen that has moved by 2 % of its length. Floor and wall yield by 1e-5 L, the rod
// sags by 1e-4 L (Gamma = 0.01). Near the threshold it falls slowly, with the part by
// which it is too flat of g: 0.5 % of it move the foot by more than L/5 in ten times
// sqrt(L/g).
#include <cmath>
#include <memory>
#include <stdexcept>

#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/numerics.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/test.h"
#include "models/effects/exact_body.h"
#include "models/effects/gravity.h"

namespace tress::experiments::validation {
namespace {

const double ladder_length = TestRod().length;
const double ladder_gravity = TestRod().gravity(0.01);

/// The rod from its foot up to the wall, towards -x.
Strand ladder(int elements, double slope) {
  const double angle = std::atan(slope);
  const Frame up{{-std::cos(angle), 0, std::sin(angle)},
                 {0, 1, 0},
                 {-std::sin(angle), 0, -std::cos(angle)}};
  Strand strand = TestRod().strand(elements, up);
  strand.free_root = FreeRoot{{}, up, {}, {}};
  return strand;
}

bool falls(const ModelTrial& trial, double slope) {
  const ContactRun& run = trial.contact;
  const Strand strand = ladder(trial.elements, slope);
  const double thick = strand.segments.front().section.a1;
  const double weight = TestRod().line_mass() * ladder_length * ladder_gravity;
  // At both ends stands half a segment, or the part of one at a quadrature point.
  const double touching = 0.5 * strand.segments.front().length;
  const NormalContact normal{.stiffness = weight / (1e-5 * ladder_length * touching),
                             .offset = thick};
  // What touches first is a little inside of the ends in models that integrate.
  const double inside = lowest_point(trial.variant, strand);
  const double reach = ladder_length * std::cos(std::atan(slope)) - inside / slope;
  const StrandPlace floor{{0, 0, inside - thick}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  // The wall's outside is towards +x.
  const StrandPlace wall{{-reach - thick, 0, 0}, {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
  const ExactContact law{normal, run.is_rigid(false), trial.parameter};
  const auto system =
      on_strand(trial.variant, run.strand(strand),
                {std::make_shared<Gravity>(run.turned * Vec{0, 0, -ladder_gravity}),
                 std::make_shared<ExactBody>(Plane{}, run.place(floor), law),
                 std::make_shared<ExactBody>(Plane{}, run.place(wall), law)});
  const double t_end = 10 * std::sqrt(ladder_length / ladder_gravity);
  const auto gone = [](double x) { return std::abs(x) > 0.02 * ladder_length; };
  const Track foot =
      track(run.integrator, *system, t_end / 500, t_end, run.look(*system, 0, 0), gone);
  return gone(foot.value.back());
}

double least_slope(double friction) { return (1 - friction * friction) / (2 * friction); }

double measured_slope(const ModelTrial& trial) {
  double low = least_slope(trial.parameter) / 1.1,
         high = least_slope(trial.parameter) * 1.1;
  if (!falls(trial, low)) throw std::runtime_error("holds where it is much too flat");
  if (falls(trial, high)) throw std::runtime_error("falls where it is steep enough");
  return threshold([&](double slope) { return !falls(trial, slope); }, low, high, 2e-3);
}

}  // namespace

std::vector<ValidationTest> ladder_tests() {
  return {{
      .name = "ladder",
      .what = "a stiff rod that leans on a rough wall slides where it is too flat",
      .source = "statics of two contacts at their limits of friction",
      .parameter = "friction coefficient mu of floor and wall",
      .quantity = "least slope tan that holds",
      .range = {0.05, 0.9},
      .quick = {{0.3}, {10}},
      .usual = {{0.2, 0.3, 0.5}, {10}},
      .full = {{0.2, 0.3, 0.4, 0.5, 0.7}, {10, 20}},
      .tolerance = 0.005,
      .why = "0.1 % of the search, 0.3 % by which a rod changes its slope before it has "
             "fallen, and sag and yield",
      .judged_from = 10,
      .claimed = {"super_helix", "super_clothoid", "der", "corde", "xpbd_cosserat",
                  "dynamic_spline", "mass_spring", "inextensible_strand"},
      .reference = least_slope,
      .measure = measured_slope,
  }};
}

}  // namespace tress::experiments::validation
