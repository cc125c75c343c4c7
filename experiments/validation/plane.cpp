// A straight rod on a rigid plane with exact friction. On a slope it holds if and only if
// the coefficient of friction is the slope's tan or more. Thrown flat onto a plane, it
// comes to rest in the normal direction, and friction takes mu times that speed of the
// other one, at most all of it [Moreau 1999].
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

/// Lies along y and may leave.
Strand flat_rod(const ModelTrial& trial, const Vec& velocity) {
  const Frame along_y{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  Strand strand = TestRod().strand(trial.elements, along_y);
  strand.free_root = FreeRoot{{}, along_y, velocity, {}};
  return strand;
}

std::shared_ptr<const Effect> rigid_floor(const ModelTrial& trial, const Strand& strand,
                                          double friction) {
  const double thick = strand.segments.front().section.a1;
  const StrandPlace under{{0, 0, lowest_point(trial.variant, strand) - thick},
                          {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  return std::make_shared<ExactBody>(
      Plane{}, trial.contact.place(under),
      ExactContact{NormalContact{.stiffness = 1, .offset = thick},
                   trial.contact.is_rigid(true), friction});
}

constexpr double slope_time = 0.5, slope_step = 1.0 / 30;  // s

/// What holds moves by rounding errors; a coefficient too small by 1e-5 lets it slide by
/// 12 um.
bool slides_down(const ModelTrial& trial, double friction) {
  const Strand strand = flat_rod(trial, {});
  const double cosine = 1 / std::hypot(1, trial.parameter);
  const Vec down = earth_gravity * cosine * Vec{trial.parameter, 0, -1};
  const auto system = on_strand(trial.variant, trial.contact.strand(strand),
                                {std::make_shared<Gravity>(trial.contact.turned * down),
                                 rigid_floor(trial, strand, friction)});
  const Track x = track(trial.contact.integrator, *system, slope_step, slope_time,
                        trial.contact.look(*system, 0, 0));
  return std::abs(x.value.back()) > 1e-8;
}

double least_holding(const ModelTrial& trial) {
  const double low = 0.9 * trial.parameter, high = 1.1 * trial.parameter;
  if (!slides_down(trial, low))
    throw std::runtime_error("holds with too little friction");
  if (slides_down(trial, high)) throw std::runtime_error("slides against more friction");
  return threshold([&](double friction) { return !slides_down(trial, friction); }, low,
                   high, 1e-6);
}

constexpr double fall = 1;  // m/s, and as much along the plane

double speed_after(const ModelTrial& trial) {
  const Strand strand = flat_rod(trial, {fall, 0, -fall});
  const auto system = on_strand(trial.variant, trial.contact.strand(strand),
                                {rigid_floor(trial, strand, trial.parameter)});
  const double step = 1e-3;
  const Track x = track(trial.contact.integrator, *system, step, 10 * step,
                        trial.contact.look(*system, 0, 0));
  const std::size_t last = x.value.size() - 1;
  return (x.value[last] - x.value[last - 1]) / (step * fall);
}

}  // namespace

std::vector<ValidationTest> plane_tests() {
  const std::vector<std::string_view> claimed = {
      "super_helix", "super_clothoid",     "der", "corde", "dynamic_spline",
      "mass_spring", "inextensible_strand"};
  return {
      {
          .name = "tilted_plane",
          .what = "a hair on a slope holds if friction is its tan or more",
          .source = "Coulomb 1785",
          .parameter = "tan of the slope",
          .quantity = "least friction coefficient that holds",
          .range = {0.01, 2},
          .quick = {{0.3}, {10}},
          .usual = {{0.1, 0.3, 1}, {10}},
          .full = {{0.1, 0.3, 0.5, 1}, {5, 10, 20}},
          .tolerance = 1e-5,
          .why = "1e-6 of the search, and what moves by less than 1e-8 m holds",
          .judged_from = 5,
          .claimed = claimed,
          .reference = [](double slope) { return slope; },
          .measure = least_holding,
      },
      {
          .name = "flat_impact",
          .what = "a hair thrown flat onto a plane keeps the speed that friction leaves",
          .source = "Moreau 1999: impulses obey the laws of Signorini and Coulomb",
          .parameter = "friction coefficient mu",
          .quantity = "speed along the plane after over before",
          .range = {0, 0.9},
          .quick = {{0.3}, {10}},
          .usual = {{0, 0.3, 0.7}, {10}},
          .full = {{0, 0.1, 0.3, 0.5, 0.7, 0.9}, {5, 10, 20}},
          .tolerance = 1e-6,
          .why = "the tolerance of contact, 1e-6 of the speed",
          .judged_from = 5,
          .claimed = claimed,
          .reference = [](double friction) { return 1 - friction; },
          .measure = speed_after,
      }};
}

}  // namespace tress::experiments::validation
