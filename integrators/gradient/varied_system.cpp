#include "integrators/gradient/varied_system.h"

#include <algorithm>
#include <cmath>

#include "contract/forms/natural_strains.h"
#include "integrators/gradient/probe.h"
#include "linear/largest_size.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

using Values = Probe::Values;
constexpr double far_away = 0.3;  // reach of a probe

bool all_affine(const Values& at_0, const Values& at_half, const Values& at_1) {
  for (std::size_t i = 0; i < at_0.size(); ++i) {
    if (!affine(at_0[i], at_half[i], at_1[i])) return false;
  }
  return true;
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

/// dr/ds from systems at s = 0 and s = affine_at[0], and the largest |r|.
struct Slope {
  Slope(System& at_0, System& far, double t, In q, In v, In a) : by(q.size()) {
    std::vector<double> r(q.size());
    ok = at_0.residual(t, q, v, a, r) == Status::ok;
    size = largest_size(r);
    add(by, affine_stencil.base, r);
    ok = far.residual(t, q, v, a, r) == Status::ok && ok;
    size = std::max(size, largest_size(r));
    add(by, affine_stencil.weight[0], r);
  }
  std::vector<double> by;
  double size = 0;
  bool ok = false;
};

std::optional<SimpleDerivative> simple_derivative(System& at_0, System& far,
                                                  const Probe& probe) {
  constexpr double rounding = 1e-14;  // of differences, over the largest |r|
  constexpr double part = 0.05;       // of typical sizes
  const std::size_t n = probe.q.size();
  const std::vector<double> none(n);
  std::vector<double> q(probe.q), v(probe.v);
  add(q, part, probe.q_typ);
  add(v, part, probe.v_typ);
  const double t = probed_times[1];
  const Slope here(at_0, far, t, probe.q, probe.v, none),
      moved(at_0, far, t, q, probe.v, none), faster(at_0, far, t, probe.q, v, none);
  SimpleDerivative simple{here.by, none, none};
  const double unseen = rounding * std::max({here.size, moved.size, faster.size});
  for (std::size_t i = 0; i < n; ++i) {
    const auto slope = [&](double change, double by) {
      return std::abs(change) > unseen ? change / by : 0;
    };
    simple.by_q[i] = slope(moved.by[i] - here.by[i], q[i] - probe.q[i]);
    simple.by_v[i] = slope(faster.by[i] - here.by[i], v[i] - probe.v[i]);
    simple.constant[i] -= simple.by_q[i] * probe.q[i] + simple.by_v[i] * probe.v[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double away = part * std::cos(2 + 1.9 * static_cast<double>(i));
    q[i] += away * probe.q_typ[i];
    v[i] -= away * probe.v_typ[i];
  }
  const Slope tried(at_0, far, probed_times[2], q, v, probe.a);
  const double size = std::max(tried.size, unseen / rounding);
  // A parameter that does not act here may act elsewhere, as that of a contact.
  bool holds = here.ok && moved.ok && faster.ok && tried.ok &&
               largest_size(tried.by) > 100 * rounding * size;
  for (std::size_t i = 0; i < n; ++i) {
    const double expected =
        simple.constant[i] + simple.by_q[i] * q[i] + simple.by_v[i] * v[i];
    holds = holds && std::abs(tried.by[i] - expected) <= 10 * rounding * size;
  }
  return holds ? std::optional(simple) : std::nullopt;
}

/// At the states of varied_system(), of systems at s = 0, 1/8 and 1/4.
bool is_affine(System& system, System& middle, System& far) {
  const Probe start(system);
  const Values here = start.of(system), there = start.of(far);
  // A parameter that does not act at these states, of what is not touched yet, may be
  // anything.
  if (here == there || !same(points_at(far, start.q), points_at(system, start.q))) {
    return false;
  }
  if (!all_affine(here, start.of(middle), there)) return false;
  const Probe away(system, far_away);
  const In once(&probed_times[2], 1);
  return all_affine(away.of(system, once), away.of(middle, once), away.of(far, once));
}

/// Whether the residual stays as it is, bit by bit. Joints of clamps read the shape at
/// the start in some models.
bool starts_alone(System& system, const RunParameter& parameter) {
  if (system.history() != nullptr) return false;
  const Probe probe(system, far_away);
  Values here = probe.of(system), there = probe.of(*parameter(affine_stencil.at[0]));
  for (Values* values : {&here, &there})
    values->erase(values->begin(), values->begin() + 2);
  return here == there;
}

}  // namespace

Stencil placed_stencil(const RunParameter& parameter) {
  return parameter.places ? placing_differences(*parameter.places) : central_stencil;
}

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
  // One that changes no natural strain acts elsewhere, at other states perhaps.
  if (natural == here) return {};
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
  VariedSystem varied{placed_stencil(parameter), {}, {}, parameter.name};
  varied.starts = parameter.starts && starts_alone(system, parameter);
  const bool own_history = system.history() != nullptr && memory == VariedMemory::own;
  const bool known = parameter.law != ParameterLaw::unknown;
  if (known && !parameter.places && !own_history) {
    auto far = parameter(affine_stencil.at[0]);
    if (is_affine(system, *parameter(affine_stencil.at[0] / 2), *far)) {
      varied.stencil = affine_stencil;
      const bool smooth = parameter.law == ParameterLaw::smooth;
      if (smooth && system.layout().constraints == 0) {
        varied.simple = simple_derivative(system, *far, Probe(system));
      }
      varied.systems.push_back(std::move(far));
      return varied;
    }
  }
  for (const double s : varied.stencil.at) varied.systems.push_back(parameter(s));
  return varied;
}

}  // namespace tress::integrators
