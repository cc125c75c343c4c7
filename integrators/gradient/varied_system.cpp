#include "integrators/gradient/varied_system.h"

#include <algorithm>
#include <cmath>

#include "contract/forms/material_points.h"
#include "contract/forms/natural_strains.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// A state away from the initial one, by parts of the typical sizes that differ from
/// coordinate to coordinate.
struct Probe {
  explicit Probe(System& system)
      : q(static_cast<std::size_t>(system.layout().coordinates)), v(q), a(q) {
    std::vector<double> q_typ(q), v_typ(q);
    system.initial_state(q, v);
    system.scale(q_typ, v_typ);
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double part = 0.02 * std::sin(1 + 2.7 * static_cast<double>(i));
      q[i] += part * q_typ[i];
      v[i] += 5 * part * v_typ[i];
      a[i] = 7 * part * v_typ[i] * v_typ[i] / q_typ[i];
    }
  }
  std::vector<double> q, v, a;

  /// All that may depend on a parameter: the start, then residuals and points. NaN where
  /// a residual is not finite.
  std::vector<std::vector<double>> of(System& system) const {
    std::vector<std::vector<double>> all(2, std::vector<double>(q.size()));
    system.initial_state(all[0], all[1]);
    MaterialPoints* points = system.material_points();
    for (const double t : probed_times) {
      std::vector<double> r(q.size());
      if (system.residual(t, q, v, a, r) != Status::ok) r.assign(q.size(), std::nan(""));
      all.push_back(std::move(r));
      if (points == nullptr) continue;
      all.emplace_back(3 * static_cast<std::size_t>(points->count()));
      points->positions(t, q, all.back());
    }
    return all;
  }
};

/// Whether f(1/2) is the mean of f(0) and f(1), entry by entry, up to rounding.
bool affine(const std::vector<double>& at_0, const std::vector<double>& at_half,
            const std::vector<double>& at_1) {
  constexpr double rounding = 1e-12;  // a sum of some thousand terms
  double size = 0, bend = 0;
  for (std::size_t i = 0; i < at_0.size(); ++i) {
    size = std::max({size, std::abs(at_0[i]), std::abs(at_1[i])});
    const double away = std::abs(at_half[i] - (at_0[i] + at_1[i]) / 2);
    if (!(away <= bend)) bend = away;  // NaN, too
  }
  return bend <= rounding * size;
}

bool same(const std::vector<double>& x, const std::vector<double>& y) {
  constexpr double rounding = 1e-14;
  double size = 0, apart = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    size = std::max(size, std::abs(y[i]));
    if (!(std::abs(x[i] - y[i]) <= apart)) apart = std::abs(x[i] - y[i]);  // NaN, too
  }
  return apart <= rounding * size;
}

}  // namespace

std::vector<double> natural_direction(System& system, const RunParameter& parameter) {
  NaturalStrains* const own = natural_strains(system);
  if (own == nullptr) return {};
  const std::vector<double> here = own->natural();
  const auto at = [&](double s, bool& alone) {
    const auto changed = parameter(s);
    NaturalStrains* const form = natural_strains(*changed);
    alone = form != nullptr && form->natural().size() == here.size();
    if (!alone) return std::vector<double>{};
    std::vector<double> natural = form->natural();
    form->set_natural(here);
    const Probe probe(system);
    const auto with = probe.of(*changed), without = probe.of(system);
    alone = std::ranges::equal(with, without, same);
    return natural;
  };
  bool alone = true;
  const double far = affine_stencil.at[0];
  const std::vector<double> natural = at(far, alone);
  if (!alone) return {};
  const std::vector<double> middle = at(far / 2, alone);
  const bool straight = affine(here, middle, natural);
  const Stencil stencil = straight ? affine_stencil : central_stencil;
  std::vector<double> direction(here.size());
  add(direction, stencil.base, here);
  for (std::size_t i = 0; i < stencil.at.size(); ++i) {
    add(direction, stencil.weight[i],
        straight ? natural : natural_strains(*parameter(stencil.at[i]))->natural());
  }
  return direction;
}

VariedSystem varied_system(System& system, const RunParameter& parameter,
                           VariedMemory memory) {
  VariedSystem varied{central_stencil, {}};
  if (system.history() == nullptr || memory == VariedMemory::of_run) {
    const Probe probe(system);
    auto far = parameter(affine_stencil.at[0]);
    const auto middle = parameter(affine_stencil.at[0] / 2);
    const auto at_0 = probe.of(system), at_half = probe.of(*middle),
               at_1 = probe.of(*far);
    bool all_affine = true;
    for (std::size_t i = 0; i < at_0.size(); ++i) {
      all_affine = all_affine && affine(at_0[i], at_half[i], at_1[i]);
    }
    if (all_affine) {
      varied.stencil = affine_stencil;
      varied.systems.push_back(std::move(far));
      return varied;
    }
  }
  for (const double s : varied.stencil.at) varied.systems.push_back(parameter(s));
  return varied;
}

}  // namespace tress::integrators
