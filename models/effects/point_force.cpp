#include "models/effects/point_force.h"

#include <cmath>
#include <utility>

#include "contract/input_error.h"
#include "math/mat3.h"
#include "math/vec3.h"
#include "models/effects/place.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_force[] = {
    {.name = "at",
     .help = "place along the strand, 0: root, 1: tip",
     .number = 1,
     .min = 0,
     .max = 1},
    {.name = "force_n",
     .help = "force x, y, z, which keeps its direction (N)",
     .min = -1e9,
     .max = 1e9,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "follower_n",
     .help = "force along the tangent at the place, towards the tip; negative: towards "
             "the root (N)",
     .number = 0,
     .min = -1e9,
     .max = 1e9},
    {.name = "factor_over_time",
     .help =
         "factor of both forces: rows of [time in s, factor], linear between rows and "
         "constant beyond them. Without rows it is 1",
     .min = -1e9,
     .max = 1e9,
     .components = 2,
     .rows = true}};

}  // namespace

std::span<const Parameter> point_force_parameters() { return parameters_of_force; }

std::unique_ptr<const Effect> make_point_force(const Parameters& parameters,
                                               const RootMotion&) {
  PointForce::Settings settings;
  settings.at = parameters.number("at");
  settings.force = parameters.vec("force_n");
  settings.follower = parameters.number("follower_n");
  settings.rows = FactorOverTime::rows_of(parameters.numbers("factor_over_time"));
  return std::make_unique<PointForce>(std::move(settings));
}

PointForce::PointForce(Settings settings) : s_(std::move(settings)) {
  const std::string where = "effect point_force";
  refuse_if(!is_finite(s_.force) || !std::isfinite(s_.follower),
            "the force is not finite", where, "give finite numbers in N");
  refuse_if(!(s_.at >= 0 && s_.at <= 1), "the place along the strand is not on it", where,
            "give `at` between 0 (root) and 1 (tip)");
  factor_ = FactorOverTime(s_.rows, where);
}

void PointForce::add_load(double t, const Points& p, InOut f) const noexcept {
  const PlaceShares of = shares_of_place(p, s_.at);
  const double c = factor_(t);
  for (std::size_t k = 0; k < of.count; ++k) {
    const std::size_t at = 3 * (of.first + k);
    Vec force = s_.force;
    if (s_.follower != 0) force = force + s_.follower * load3(&p.tangent[at]);
    store3(load3(&f[at]) + (c * of.weight[k]) * force, &f[at]);
  }
}

void PointForce::add_direction_derivatives(double t, const Points& p, double factor,
                                           InOut blocks) const noexcept {
  if (s_.follower == 0) return;
  const PlaceShares of = shares_of_place(p, s_.at);
  const double c = factor * factor_(t) * s_.follower;
  for (std::size_t k = 0; k < of.count; ++k) {
    add9((c * of.weight[k]) * identity(), &blocks[9 * (of.first + k)]);
  }
}

double PointForce::potential(double t, const Points& p) const noexcept {
  return -factor_(t) * dot(s_.force, shares_of_place(p, s_.at).mean(p.x));
}

double PointForce::power(double t, const Points& p) const noexcept {
  const PlaceShares of = shares_of_place(p, s_.at);
  double sum = -factor_.rate(t) * dot(s_.force, of.mean(p.x));
  if (s_.follower == 0) return sum;
  for (std::size_t k = 0; k < of.count; ++k) {
    const std::size_t at = 3 * (of.first + k);
    sum += factor_(t) * s_.follower * of.weight[k] *
           dot(load3(&p.tangent[at]), load3(&p.v[at]));
  }
  return sum;
}

}  // namespace tress::models
