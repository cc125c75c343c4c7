#pragma once

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/natural_strains.h"
#include "models/batch/packed_strands.h"
#include "models/groom/strand_block.h"
#include "models/reduced/contact_tangent.h"
#include "models/reduced/recursive_solver.h"
#include "models/reduced/stiff_tangent.h"
#include "models/reduced/strand_energies.h"
#include "models/reduced/transport_sweeps.h"

namespace tress::models {

/// The equations of ReducedSystem with the elastic Jacobian, solved recursively, for four
/// strands if the kernel's scalar is a pack.
template <class Kernel, int modes>
class RecursiveMechanics {
 public:
  using K = Kinematics<Kernel, modes>;
  using In = typename K::In;
  using Out = std::span<typename K::Real>;

  RecursiveMechanics(K& kinematics, InverseDynamics<Kernel, modes>& dynamics)
      : dynamics_(dynamics), tangent_(kinematics, dynamics), solver_(tangent_.last()) {}

  void residual(double t, In q, In v, In a, Out r) { dynamics_.residual(t, q, v, a, r); }
  Status linearize(double t, In q, In v, Weights w) {
    return solver_.factor(tangent_.at(t, q, v, w));
  }
  Status solve(In b, Out x) { return solver_.solve(b, x); }

  using Load = typename TreeSolver<MassShapeOf<Kernel, modes>>::Load;
  /// Computes the response of tips of a chain to loads on them.
  bool respond(std::span<const Load> loads, Out blocks) {
    return solver_.respond(loads, blocks);
  }

 private:
  InverseDynamics<Kernel, modes>& dynamics_;
  StiffTangent<Kernel, modes> tangent_;
  RecursiveSolver<MassShapeOf<Kernel, modes>> solver_;
};

/// The equations of ForceTransport, solved by sweeps.
template <class Kernel, int modes>
class TransportMechanics {
 public:
  using K = Kinematics<Kernel, modes>;
  using In = typename K::In;
  using Out = std::span<typename K::Real>;

  TransportMechanics(K& kinematics, InverseDynamics<Kernel, modes>& dynamics)
      : mass_(kinematics, dynamics), sweeps_(kinematics, dynamics, mass_) {}

  void residual(double t, In q, In v, In a, Out r) { sweeps_.residual(t, q, v, a, r); }
  Status linearize(double, In q, In, Weights w) { return sweeps_.factor(q, w); }
  Status solve(In b, Out x) {
    sweeps_.solve(b, x);
    return Status::ok;
  }

 private:
  StiffTangent<Kernel, modes> mass_;
  TransportSweeps<Kernel, modes> sweeps_;
};

/// Up to four strands, one per lane of a pack, with the elastic Jacobian. Results match
/// those of single strands to rounding (points are summed in another order), at little
/// more than the cost of one strand. The Kernel is over packs.
template <template <class, int> class Mechanics, class Kernel, int modes>
class ReducedBatch final : public StrandBlock,
                           public NaturalStrains,
                           private ExplicitForm {
 public:
  /// `strands`: the packed strands as single systems, used for everything but steps.
  ReducedBatch(PackedStrands packed, std::vector<std::unique_ptr<System>> strands)
      : StrandBlock(std::move(strands)),
        kinematics_(std::move(packed.segments), std::move(packed.blocks),
                    std::move(packed.roots), std::nullopt, packed.root_rotor),
        dynamics_(kinematics_, std::move(packed.effects)),
        mechanics_(kinematics_, dynamics_),
        chains_(kinematics_.is_chain()),
        q_(unknowns()),
        v_(unknowns()),
        a_(unknowns()),
        zero_(unknowns(), Pack(0)),
        r_(unknowns()),
        all_points_(points()) {
    std::iota(all_points_.begin(), all_points_.end(), 0);
  }

  bool responds_at_once() const override { return can_respond && chains_; }

  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    gather(q, q_);
    gather(v, v_);
    gather(a, a_);
    mechanics_.residual(t, q_, v_, a_, r_);
    return scatter(r_, r);
  }

  Status linearize(double t, In q, In v, In, Weights w) noexcept override {
    gather(q, q_);
    gather(v, v_);
    responded_ = false;
    return factored_ = mechanics_.linearize(t, q_, v_, w);
  }

  Status solve(In b, Out x) noexcept override {
    if (factored_ != Status::ok) return factored_;
    gather(b, r_);
    const Status s = mechanics_.solve(r_, r_);
    return s == Status::ok ? scatter(r_, x) : s;
  }

  ExplicitForm* explicit_form() override {
    for (std::size_t k = 0; k < strands(); ++k) {
      if (strand(k).explicit_form() == nullptr) return nullptr;
    }
    return this;
  }

  std::vector<double> natural() const override {
    return of_strands(&NaturalStrains::natural);
  }
  void set_natural(In values) override {
    for (std::size_t k = 0; k < strands(); ++k) {
      natural_strains(strand(k))->set_natural(part(values, k));
    }
    gather(values, q_);
    for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
      kinematics_.set_rest(i, Kinematics<Kernel, modes>::components(q_, i));
    }
  }
  std::vector<double> natural_stiffness() const override {
    return of_strands(&NaturalStrains::natural_stiffness);
  }
  bool strains_are_coordinates() const override { return true; }

 private:
  std::vector<double> of_strands(std::vector<double> (NaturalStrains::*values)()
                                     const) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < strands(); ++k) {
      const std::vector<double> one = (natural_strains(strand(k))->*values)();
      all.insert(all.end(), one.begin(), one.end());
    }
    return all;
  }

  static constexpr bool can_respond = requires {
    typename Mechanics<Kernel, modes>::Load;
  };

  std::size_t unknowns() const { return static_cast<std::size_t>(first(1)); }  // each

  Status acceleration(double t, In q, In v, Out a) noexcept override {
    for (std::size_t k = 0; k < strands(); ++k) {
      const Status s =
          strand(k).explicit_form()->acceleration(t, part(q, k), part(v, k), part(a, k));
      if (s != Status::ok) return s;
    }
    return Status::ok;
  }

  void gather(In x, std::vector<Pack>& packed) const {
    const std::size_t n = unknowns();
    const double* from[Pack::lanes];
    for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
      from[lane] = &x[lane < strands() ? lane * n : 0];
    }
    for (std::size_t k = 0; k < n; ++k) {
      packed[k] = Pack(from[0][k], from[1][k], from[2][k], from[3][k]);
    }
  }
  /// Returns `retry` unless all numbers are finite.
  Status scatter(const std::vector<Pack>& packed, Out x) const {
    const std::size_t n = unknowns();
    bool finite = true;
    for (std::size_t lane = 0; lane < strands(); ++lane) {
      for (std::size_t k = 0; k < n; ++k) {
        const double entry = packed[k][static_cast<int>(lane)];
        x[lane * n + k] = entry;
        finite = finite && std::isfinite(entry);
      }
    }
    return finite ? Status::ok : Status::retry;
  }

  Energy energy(double t, In q, In v) override {
    gather(q, q_);
    gather(v, v_);
    kinematics_.move(t, q_, v_, zero_);
    const auto own = strand_energies<Kernel, modes>(kinematics_, q_, v_);
    const Needs wanted =
        dynamics_.effect_needs() | Needs{.position = true, .velocity = true};
    dynamics_.place(wanted);
    Energy sum;
    for (std::size_t k = 0; k < strands(); ++k) {
      const auto lane = static_cast<int>(k);
      sum.kinetic += own.kinetic[lane];
      sum.potential += own.elastic[lane];
      const Points points = dynamics_.points(k, wanted);
      for (const auto& effect : dynamics_.effects(k)) {
        sum.potential += effect->potential(t, points);
      }
    }
    return sum;
  }

  /// Material points of a strand: the root and the tips of all segments.
  std::size_t points() const { return kinematics_.segments().size() + 1; }

  void positions(double t, In q, Out x) override {
    gather(q, q_);
    scatter_points(
        kinematics_.template tips<true>(t, q_, zero_),
        [](const auto& tip) { return tip.x; }, x);
  }
  void velocities(double t, In q, In v, Out u) override {
    gather(q, q_);
    gather(v, v_);
    scatter_points(
        kinematics_.tips(t, q_, v_), [](const auto& tip) { return tip.frame * tip.v; },
        u);
  }
  template <class Tips, class Of>
  void scatter_points(const Tips& tips, Of of, Out x) const {
    for (std::size_t i = 0; i < points(); ++i) {
      const Vec3<Pack> all = of(tips[i]);
      for (std::size_t lane = 0; lane < strands(); ++lane) {
        const int l = static_cast<int>(lane);
        store3(Vec{all.x[l], all.y[l], all.z[l]}, &x[3 * (lane * points() + i)]);
      }
    }
  }

  bool pull_back(double t, In q, std::span<const int> points, In f, InOut b) override {
    if (!responds_at_once()) return false;
    const std::size_t n = this->points();
    forces_.assign(3 * n, Pack(0));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t lane = static_cast<std::size_t>(points[i]) / n,
                        point = static_cast<std::size_t>(points[i]) % n;
      for (std::size_t d = 0; d < 3; ++d) {
        forces_[3 * point + d].set(static_cast<int>(lane), f[3 * i + d]);
      }
    }
    gather(q, q_);
    std::ranges::fill(r_, Pack(0));
    TipForces<Kernel, modes>(kinematics_, t, q_).pull_back(all_points_, forces_, r_);
    for (std::size_t lane = 0; lane < strands(); ++lane) {
      for (std::size_t k = 0; k < unknowns(); ++k) {
        b[lane * unknowns() + k] += r_[k][static_cast<int>(lane)];
      }
    }
    return true;
  }

  /// Finds the responses of all points at once, with the first request.
  bool responses(double t, In q, std::span<const int> points, Out blocks) override {
    if (!responds_at_once() || factored_ != Status::ok) return false;
    if (!std::exchange(responded_, true)) respond(t, q);
    const std::size_t n = this->points();
    double* to = blocks.data();
    for (const int of : points) {
      const auto first = static_cast<std::size_t>(of);
      for (const int on : points) {
        const auto second = static_cast<std::size_t>(on);
        const Pack* const from = &responses_[9 * (first % n * n + second % n)];
        const bool one_strand = first / n == second / n;
        for (std::size_t k = 0; k < 9; ++k) {
          *to++ = one_strand ? from[k][static_cast<int>(first / n)] : 0.0;
        }
      }
    }
    return true;
  }
  void respond([[maybe_unused]] double t, [[maybe_unused]] In q) {
    if constexpr (can_respond) {
      gather(q, q_);
      const TipForces<Kernel, modes> forces(kinematics_, t, q_);
      std::vector<typename Mechanics<Kernel, modes>::Load> loads;
      loads.reserve(points());
      for (int i = 0; i < static_cast<int>(points()); ++i) {
        loads.push_back({i - 1, forces.units(i)});
      }
      responses_.resize(9 * points() * points());
      mechanics_.respond(loads, responses_);
    }
  }

  Kinematics<Kernel, modes> kinematics_;
  InverseDynamics<Kernel, modes> dynamics_;
  Mechanics<Kernel, modes> mechanics_;
  bool chains_;
  Status factored_ = Status::retry;
  std::vector<Pack> q_, v_, a_, zero_, r_;
  std::vector<Pack> responses_;
  bool responded_ = false;       // they are those of the last linearize()
  std::vector<Pack> forces_;     // scratch of pull_back()
  std::vector<int> all_points_;  // 0, 1, ... of a strand
};

}  // namespace tress::models
