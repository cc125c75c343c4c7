#include "models/effects/point_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contract/input_error.h"
#include "math/lagrange.h"
#include "math/mat3.h"
#include "math/piecewise_linear.h"
#include "math/vec3.h"

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

/// A place nearer to a point than this part of the length is that point.
constexpr double same_place = 1e-9;

}  // namespace

std::span<const Parameter> point_force_parameters() { return parameters_of_force; }

std::unique_ptr<const Effect> make_point_force(const Parameters& parameters,
                                               const RootMotion&) {
  PointForce::Settings settings;
  settings.at = parameters.number("at");
  settings.force = parameters.vec("force_n");
  settings.follower = parameters.number("follower_n");
  const In rows = parameters.numbers("factor_over_time");
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    settings.rows.push_back({rows[i], rows[i + 1]});
  }
  return std::make_unique<PointForce>(std::move(settings));
}

PointForce::PointForce(Settings settings) : s_(std::move(settings)) {
  const std::string where = "effect point_force";
  refuse_if(!is_finite(s_.force) || !std::isfinite(s_.follower),
            "the force is not finite", where, "give finite numbers in N");
  refuse_if(!(s_.at >= 0 && s_.at <= 1), "the place along the strand is not on it", where,
            "give `at` between 0 (root) and 1 (tip)");
  const Row* before = nullptr;
  for (const Row& row : s_.rows) {
    refuse_if(!std::isfinite(row.time) || !std::isfinite(row.factor),
              "a row of factor_over_time is not finite", where, "give finite numbers");
    refuse_if(before != nullptr && !(row.time > before->time),
              "the times of factor_over_time do not increase", where,
              "give rows in order of time, each time once");
    before = &row;
  }
}

double PointForce::factor(double t) const noexcept {
  if (s_.rows.empty()) return 1;
  const auto [before, after, part] = between_rows(s_.rows, t, &Row::time);
  return std::lerp(before->factor, after->factor, part);
}

double PointForce::factor_rate(double t) const noexcept {
  if (s_.rows.empty()) return 0;
  const auto [before, after, part] = between_rows(s_.rows, t, &Row::time);
  if (before == after) return 0;
  return (after->factor - before->factor) / (after->time - before->time);
}

double PointForce::next_breakpoint(double t) const noexcept {
  const auto after = std::ranges::upper_bound(s_.rows, t, {}, &Row::time);
  return after == s_.rows.end() ? std::numeric_limits<double>::infinity() : after->time;
}

PointForce::Shares PointForce::shares(const Points& p) const noexcept {
  const double s = s_.at * p.longest;
  const auto away = [&](std::size_t i) { return std::abs(p.arc[i] - s); };
  Shares all;
  for (std::size_t i = 1; i < p.arc.size(); ++i) {
    // Points that only fill a pack carry no length.
    if (p.length[i] > 0 && away(i) < away(all.first)) all.first = i;
  }
  std::size_t end = all.first + 1;
  if (away(all.first) > same_place * p.longest) {
    const auto joins = [&](std::size_t i, std::size_t j) {
      return p.length[i] > 0 && p.length[j] > 0 && p.arc[i] < p.arc[j];
    };
    while (end - all.first < all.weight.size()) {
      const bool before = all.first > 0 && joins(all.first - 1, all.first),
                 after = end < p.arc.size() && joins(end - 1, end);
      if (!before && !after) break;
      if (before && (!after || away(all.first - 1) <= away(end))) {
        --all.first;
      } else {
        ++end;
      }
    }
  }
  all.count = end - all.first;
  for (std::size_t k = 0; k < all.count; ++k) {
    all.weight[k] =
        lagrange(k, all.count, s, [&](std::size_t n) { return p.arc[all.first + n]; });
  }
  return all;
}

Vec PointForce::mean(const Shares& of, In values) noexcept {
  Vec sum;
  for (std::size_t k = 0; k < of.count; ++k) {
    sum = sum + of.weight[k] * load3(&values[3 * (of.first + k)]);
  }
  return sum;
}

void PointForce::add_load(double t, const Points& p, InOut f) const noexcept {
  const Shares of = shares(p);
  const double c = factor(t);
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
  const Shares of = shares(p);
  const double c = factor * this->factor(t) * s_.follower;
  for (std::size_t k = 0; k < of.count; ++k) {
    add9((c * of.weight[k]) * identity(), &blocks[9 * (of.first + k)]);
  }
}

double PointForce::potential(double t, const Points& p) const noexcept {
  return -factor(t) * dot(s_.force, mean(shares(p), p.x));
}

double PointForce::power(double t, const Points& p) const noexcept {
  const Shares of = shares(p);
  double sum = -factor_rate(t) * dot(s_.force, mean(of, p.x));
  if (s_.follower == 0) return sum;
  for (std::size_t k = 0; k < of.count; ++k) {
    const std::size_t at = 3 * (of.first + k);
    sum += factor(t) * s_.follower * of.weight[k] *
           dot(load3(&p.tangent[at]), load3(&p.v[at]));
  }
  return sum;
}

}  // namespace tress::models
