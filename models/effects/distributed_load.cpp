#include "models/effects/distributed_load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contract/input_error.h"
#include "math/mat3.h"
#include "math/vec3.h"

namespace tress::models {
namespace {

constexpr double most_load = 1e9;

constexpr Parameter parameters_of_load[] = {
    {.name = "from",
     .help = "start of the loaded part, over the length, 0: root",
     .number = 0,
     .min = 0,
     .max = 1},
    {.name = "to",
     .help = "end of the loaded part, over the length, 1: tip",
     .number = 1,
     .min = 0,
     .max = 1},
    {.name = "force_n_per_m",
     .help = "force per length x, y, z, which keeps its direction (N/m)",
     .min = -most_load,
     .max = most_load,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "along_n_per_m",
     .help = "force per length along the tangent, towards the tip; negative: towards the "
             "root (N/m)",
     .number = 0,
     .min = -most_load,
     .max = most_load},
    {.name = "turned_n_per_m",
     .help = "vector B x, y, z of the force B x tangent per length, which is across the "
             "strand (N/m). This is a pressure in the plane with normal B, or the force "
             "of a magnetic field on a current",
     .min = -most_load,
     .max = most_load,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "factor_over_time",
     .help = "factor of all three: rows of [time in s, factor], linear between rows and "
             "constant beyond them. Without rows it is 1",
     .min = -most_load,
     .max = most_load,
     .components = 2,
     .rows = true}};

}  // namespace

std::span<const Parameter> distributed_load_parameters() { return parameters_of_load; }

std::unique_ptr<const Effect> make_distributed_load(const Parameters& parameters,
                                                    const RootMotion&) {
  DistributedLoad::Settings settings;
  settings.from = parameters.number("from");
  settings.to = parameters.number("to");
  settings.force = parameters.vec("force_n_per_m");
  settings.along = parameters.number("along_n_per_m");
  settings.turned = parameters.vec("turned_n_per_m");
  settings.rows = FactorOverTime::rows_of(parameters.numbers("factor_over_time"));
  return std::make_unique<DistributedLoad>(std::move(settings));
}

DistributedLoad::DistributedLoad(Settings settings) : s_(std::move(settings)) {
  const std::string where = "effect distributed_load";
  refuse_if(!is_finite(s_.force) || !is_finite(s_.turned) || !std::isfinite(s_.along),
            "the load is not finite", where, "give finite numbers in N/m");
  refuse_if(!(s_.from >= 0 && s_.to <= 1 && s_.from < s_.to),
            "the loaded part ends before it starts", where,
            "give from < to, both between 0 (root) and 1 (tip)");
  factor_ = FactorOverTime(s_.rows, where);
}

/// A point carries half of its length on either side. The ends of the strand are open: a
/// node there carries half of an element, on one side.
double DistributedLoad::length(const Points& p, std::size_t i) const noexcept {
  constexpr double open = std::numeric_limits<double>::infinity();
  const double own = p.length[i];
  if (!(own > 0)) return 0;
  const double begin = s_.from > 0 ? s_.from * p.longest : -open,
               end = s_.to < 1 ? s_.to * p.longest : open;
  const double within =
      std::min(p.arc[i] + own / 2, end) - std::max(p.arc[i] - own / 2, begin);
  return std::clamp(within, 0.0, own);
}

void DistributedLoad::add_load(double t, const Points& p, InOut f) const noexcept {
  const double c = factor_(t);
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    Vec force = s_.force;
    if (follows()) force = force + following(load3(&p.tangent[3 * i]));
    store3(load3(&f[3 * i]) + (c * length(p, i)) * force, &f[3 * i]);
  }
}

void DistributedLoad::add_direction_derivatives(double t, const Points& p, double factor,
                                                InOut blocks) const noexcept {
  if (!follows()) return;
  const Mat3 slope = s_.along * identity() + cross_matrix(s_.turned);
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    add9((factor * factor_(t) * length(p, i)) * slope, &blocks[9 * i]);
  }
}

double DistributedLoad::potential(double t, const Points& p) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    sum -= length(p, i) * dot(s_.force, load3(&p.x[3 * i]));
  }
  return factor_(t) * sum;
}

double DistributedLoad::power(double t, const Points& p) const noexcept {
  const double c = factor_(t), rate = factor_.rate(t);
  double sum = 0;
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    const double own = length(p, i);
    if (rate != 0) sum -= rate * own * dot(s_.force, load3(&p.x[3 * i]));
    if (!follows()) continue;
    sum += c * own * dot(following(load3(&p.tangent[3 * i])), load3(&p.v[3 * i]));
  }
  return sum;
}

}  // namespace tress::models
