// Filament benchmark: an inextensible elastic filament in a viscous fluid, pulled at its
// ends by a rotating magnetic field. Drag balances all other forces, so that the
// equations are of first order:
//
//     r' = P(r) (B r + F(t)),   P = 1 - G^T (G G^T)^-1 G,   n = 3 (N + 1)
//
// with N segments and joints r_0 .. r_N. Row i of G has -u_i at joint i and u_i at joint
// i + 1, u_i = r_{i+1} - r_i: P removes the velocities that would change a length. B =
// -(N + 1)^4 D^T D, D r = (r_{i-1} - 2 r_i + r_{i+1}). F = (N + 1) C (cos omega t, sin
// omega t, 0) at the last joint, minus this at the first. All numbers are without units.
//
// An equation of first order is written in the contract with v = r, the state, and q, its
// integral over time, which nothing depends on: M = 1, and a = r'. So every integrator
// of ordinary differential equations applies. Stiff: the fastest mode decays with about
// 16 (N + 1)^4. S(w) is solved exactly with the tensions as further unknowns, a band of
// half-width 8. Every call is O(N).
//
// Jacobian `elastic` is the one of the benchmark, P B: it leaves the change of P out.
//
// Source: R. Livanovics, A. Cebers, Magnetic dipole with a flexible tail as a
// self-propelling microdevice, Phys. Rev. E 85 (2012) 041502; SciMLBenchmarks.jl, commit
// 054ed767, benchmarks/MOLPDE/Filament.jmd (N = 20, C = 32, omega = 200, t = 0 to 0.01).
// Differences here: O(N) sweeps in place of full matrices.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "contract/forms/explicit_form.h"
#include "contract/jacobian_choice.h"
#include "contract/system.h"
#include "math/banded_lu.h"
#include "math/vec3.h"
#include "models/entry.h"

namespace tress::models {
namespace {

class Filament final : public System, public ExplicitForm {
 public:
  Filament(int segments, double magnetic, double rate, Jacobian jacobian)
      : n_(segments),
        magnetic_(magnetic),
        rate_(rate),
        jacobian_(jacobian),
        side_(joints() - 1),
        held_(joints() - 1),
        flow_(joints()),
        tension_(joints() - 1),
        pivot_(joints() - 1),
        unknowns_(static_cast<std::size_t>(unknowns(segments))),
        lu_(unknowns(segments), reach, reach) {}

  Layout layout() const override { return {3 * (n_ + 1), 0}; }
  Traits traits() const override { return {.constant_mass = true, .regular_mass = true}; }
  void initial_state(Out q, Out v) const override {
    std::ranges::fill(q, 0.0);
    std::ranges::fill(v, 0.0);
    for (std::size_t i = 0; i < flow_.size(); ++i) v[3 * i] = static_cast<double>(i) / n_;
  }
  void scale(Out q_typ, Out v_typ) const override {
    std::ranges::fill(q_typ, 1 / rate_);  // a position over a radian of the field
    std::ranges::fill(v_typ, 1.0);        // the length
  }

  Status residual(double t, In /*q*/, In v, In a, Out r) noexcept override {
    sweep(t, v);
    for (std::size_t i = 0; i < flow_.size(); ++i) {
      store3(load3(&a[3 * i]) - flow_[i], &r[3 * i]);
    }
    return finite(r);
  }

  ExplicitForm* explicit_form() override { return this; }
  Status acceleration(double t, In /*q*/, In v, Out a) noexcept override {
    sweep(t, v);
    for (std::size_t i = 0; i < flow_.size(); ++i) store3(flow_[i], &a[3 * i]);
    return finite(a);
  }

  // With w_a, w_v the weights, T the tensions and f = r', the unknowns are x and s = w_v
  // dT: w_a x - w_v (B x - dG^T T) + G^T s = b, and, by d(G f) = 0, G (w_a x) + w_v dG f
  // = G b. `elastic` has no dG.
  Status linearize(double t, In /*q*/, In v, In /*a*/, Weights w) noexcept override {
    sweep(t, v);
    held_ = side_;
    lu_.clear();
    const bool exact = jacobian_ == Jacobian::exact;
    const double bend = w.vel * std::pow(n_ + 1, 4);
    for (int i = 0; i <= n_; ++i) {
      for (int k = 0; k < 3; ++k) lu_.at(4 * i + k, 4 * i + k) += w.acc;
    }
    for (int i = 1; i < n_; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int l = 0; l < 3; ++l) {
          const double entry = bend * bent[j] * bent[l];
          for (int k = 0; k < 3; ++k)
            lu_.at(4 * (i + j - 1) + k, 4 * (i + l - 1) + k) += entry;
        }
      }
    }
    for (int i = 0; i < n_; ++i) {
      const auto e = static_cast<std::size_t>(i);
      const int here = 4 * i, next = here + 4, row = here + 3;
      const double turning = exact ? w.vel : 0, pull = turning * tension_[e];
      double u[3], slopes[3];
      store3(side_[e], u);
      store3(w.acc * side_[e] + turning * (flow_[e + 1] - flow_[e]), slopes);
      for (int k = 0; k < 3; ++k) {
        const double along = u[k], slope = slopes[k];
        lu_.at(here + k, row) -= along;
        lu_.at(next + k, row) += along;
        lu_.at(row, here + k) = -slope;
        lu_.at(row, next + k) = slope;
        lu_.at(here + k, here + k) += pull;
        lu_.at(next + k, next + k) += pull;
        lu_.at(here + k, next + k) -= pull;
        lu_.at(next + k, here + k) -= pull;
      }
    }
    return lu_.factor() ? Status::ok : Status::retry;
  }

  Status solve(In b, Out x) noexcept override {
    for (std::size_t i = 0; i < flow_.size(); ++i) {
      store3(load3(&b[3 * i]), &unknowns_[4 * i]);
      if (i == side_.size()) break;
      unknowns_[4 * i + 3] = dot(held_[i], load3(&b[3 * i + 3]) - load3(&b[3 * i]));
    }
    lu_.solve(unknowns_);
    for (std::size_t i = 0; i < flow_.size(); ++i) {
      store3(load3(&unknowns_[4 * i]), &x[3 * i]);
    }
    return Status::ok;
  }

 private:
  static constexpr int reach = 8;  // of the band: two joints of four unknowns each
  static constexpr std::array<double, 3> bent = {1, -2, 1};  // D

  static int unknowns(int segments) { return 4 * segments + 3; }
  std::size_t joints() const { return static_cast<std::size_t>(n_) + 1; }
  static Status finite(Out x) {
    return std::ranges::all_of(x, [](double entry) { return std::isfinite(entry); })
               ? Status::ok
               : Status::retry;
  }

  /// side_, tension_ and flow_ <- u, T and r' = B r + F - G^T T at r = v.
  void sweep(double t, In v) noexcept {
    const auto joint = [v](std::size_t i) { return load3(&v[3 * i]); };
    const double stiffness = std::pow(n_ + 1, 4), push = (n_ + 1) * magnetic_;
    const Vec end = {push * std::cos(rate_ * t), push * std::sin(rate_ * t), 0};
    std::ranges::fill(flow_, Vec{});
    flow_.front() = -1.0 * end;
    flow_.back() = end;
    const std::size_t count = side_.size();
    for (std::size_t i = 0; i < count; ++i) side_[i] = joint(i + 1) - joint(i);
    for (std::size_t i = 1; i < count; ++i) {
      const Vec turn = stiffness * (side_[i] - side_[i - 1]);
      for (std::size_t j = 0; j < 3; ++j)
        flow_[i + j - 1] = flow_[i + j - 1] - bent[j] * turn;
    }
    // G G^T T = G (B r + F), a tridiagonal system.
    for (std::size_t i = 0; i < count; ++i) {
      pivot_[i] = 2 * dot(side_[i], side_[i]);
      tension_[i] = dot(side_[i], flow_[i + 1] - flow_[i]);
      if (i == 0) continue;
      const double beside = -dot(side_[i - 1], side_[i]), ratio = beside / pivot_[i - 1];
      pivot_[i] -= ratio * beside;
      tension_[i] -= ratio * tension_[i - 1];
    }
    for (std::size_t i = count; i-- > 0;) {
      if (i + 1 < count) tension_[i] += dot(side_[i], side_[i + 1]) * tension_[i + 1];
      tension_[i] /= pivot_[i];
    }
    for (std::size_t i = 0; i < count; ++i) {
      flow_[i] = flow_[i] + tension_[i] * side_[i];
      flow_[i + 1] = flow_[i + 1] - tension_[i] * side_[i];
    }
  }

  int n_;            // segments
  double magnetic_;  // C
  double rate_;      // omega
  Jacobian jacobian_;
  // Scratch, rewritten by each call that reads it; held_ and lu_ live from linearize to
  // solve.
  std::vector<Vec> side_, held_;  // (N) u, and u of lu_
  std::vector<Vec> flow_;         // (N + 1) r'
  std::vector<double> tension_;   // (N) T
  std::vector<double> pivot_;     // (N)
  std::vector<double> unknowns_;  // (4 N + 3) x_i, s_i
  BandedLu lu_;
};

constexpr std::array<Parameter, 4> filament_table = {
    {{.name = "segments",
      .help = "inextensible segments",
      .number = 20,
      .min = 2,
      .max = 1e6,
      .whole = true},
     {.name = "magnetic", .help = "force on the ends over (segments + 1)", .number = 32},
     {.name = "field_rate",
      .help = "angular velocity of the field",
      .number = 200,
      .min = 1e-12,
      .max = 1e12},
     jacobian_parameter}};

std::unique_ptr<System> make_filament(const Parameters& p) {
  return std::make_unique<Filament>(p.whole("segments"), p.number("magnetic"),
                                    p.number("field_rate"), jacobian_choice(p));
}

}  // namespace

ModelEntry filament_entry() {
  return {.id = "filament",
          .summary = "first order: positions of n + 1 joints, inextensible, stiff",
          .source = "Livanovics & Cebers 2012; SciMLBenchmarks.jl, Filament",
          .parameters = filament_table,
          .make = make_filament};
}

}  // namespace tress::models
