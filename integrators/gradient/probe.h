#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/material_points.h"
#include "integrators/gradient/varied_system.h"

namespace tress::integrators {

/// A state away from the initial one, by parts of the typical sizes that differ from
/// coordinate to coordinate.
struct Probe {
  /// Values of several functions.
  using Values = std::vector<std::vector<double>>;
  /// Reach of a probe near the start.
  static constexpr double near_start = 0.02;

  /// `reach`: largest part of a typical size.
  explicit Probe(System& system, double reach = near_start)
      : q(static_cast<std::size_t>(system.layout().coordinates)),
        v(q),
        a(q),
        q_typ(q),
        v_typ(q) {
    system.initial_state(q, v);
    system.scale(q_typ, v_typ);
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double part = reach * std::sin(1 + 2.7 * static_cast<double>(i));
      q[i] += part * q_typ[i];
      v[i] += 5 * part * v_typ[i];
      a[i] = 7 * part * v_typ[i] * v_typ[i] / q_typ[i];
    }
  }
  std::vector<double> q, v, a;       // coordinates, rates, accelerations
  std::vector<double> q_typ, v_typ;  // typical sizes of q and v (System::scale)

  /// All that may depend on a parameter: the start, then residuals, points and
  /// constraints. NaN where a residual is not finite.
  Values of(System& system, In times = probed_times) const {
    Values all(2, std::vector<double>(q.size()));
    system.initial_state(all[0], all[1]);
    MaterialPoints* points = system.material_points();
    for (const double t : times) {
      std::vector<double> r(q.size());
      if (system.residual(t, q, v, a, r) != Status::ok) r.assign(q.size(), std::nan(""));
      all.push_back(std::move(r));
      if (points != nullptr) {
        all.emplace_back(3 * static_cast<std::size_t>(points->count()));
        points->positions(t, q, all.back());
      }
      if (ConstraintForm* constraints = system.constraint_form()) {
        std::vector<double> g(static_cast<std::size_t>(system.layout().constraints)),
            gt(static_cast<std::size_t>(constraints->pattern().nonzeros()));
        if (constraints->value(t, q, g) != Status::ok ||
            constraints->gradient(t, q, gt) != Status::ok) {
          g.assign(g.size(), std::nan(""));
        }
        all.push_back(std::move(g));
        all.push_back(std::move(gt));
      }
    }
    return all;
  }
};

/// The points at a state, at several times; empty of a system that has none.
inline std::vector<double> points_at(System& system, In q) {
  MaterialPoints* const points = system.material_points();
  std::vector<double> all;
  if (points == nullptr) return all;
  for (const double t : probed_times) {
    std::vector<double> x(3 * static_cast<std::size_t>(points->count()));
    points->positions(t, q, x);
    all.insert(all.end(), x.begin(), x.end());
  }
  return all;
}

/// Whether f(1/2) is the mean of f(0) and f(1), entry by entry, up to rounding.
inline bool affine(const std::vector<double>& at_0, const std::vector<double>& at_half,
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

}  // namespace tress::integrators
