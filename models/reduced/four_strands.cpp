#include "models/reduced/four_strands.h"

#include <algorithm>
#include <cmath>

#include "contract/forms/explicit_form.h"
#include "contract/forms/natural_strains.h"
#include "models/groom/strand_block.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/strand_sweeps.h"
#include "models/reduced/super_helix.h"

namespace tress::models {
namespace {

class FourStrands final : public StrandBlock,
                          public NaturalStrains,
                          private ExplicitForm {
 public:
  /// `sweeps`: over the strands.
  FourStrands(std::vector<std::unique_ptr<System>> strands,
              std::unique_ptr<StrandSweepsOf<Pack>> sweeps)
      : StrandBlock(std::move(strands)), sweeps_(std::move(sweeps)) {
    for (auto* x : {&q_, &v_, &a_, &x_}) x->resize(static_cast<std::size_t>(first(1)));
  }

  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    gather(q, q_);
    gather(v, v_);
    gather(a, a_);
    sweeps_->residual(t, q_, v_, a_, x_);
    return scatter(r);
  }

  /// Strands are solved one by one where some pivot is lost to rounding.
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    gather(q, q_);
    gather(v, v_);
    gather(a, a_);
    swept_ = sweeps_->factor(t, q_, v_, a_, w);
    factored_ = swept_ ? Status::ok : each([&](std::size_t k) {
      return strand(k).linearize(t, part(q, k), part(v, k), part(a, k), w);
    });
    return factored_;
  }

  Status solve(In b, Out x) noexcept override {
    if (factored_ != Status::ok) return factored_;
    if (!swept_) {
      return each([&](std::size_t k) { return strand(k).solve(part(b, k), part(x, k)); });
    }
    gather(b, x_);
    sweeps_->solve(x_, x_);
    return scatter(x);
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
    sweeps_->set_rest(q_);
  }
  std::vector<double> natural_stiffness() const override {
    return of_strands(&NaturalStrains::natural_stiffness);
  }
  bool strains_are_coordinates() const override { return true; }

 private:
  using Packs = std::vector<Pack>;

  Status acceleration(double t, In q, In v, Out a) noexcept override {
    return each([&](std::size_t k) {
      return strand(k).explicit_form()->acceleration(t, part(q, k), part(v, k),
                                                     part(a, k));
    });
  }

  template <class Act>
  Status each(const Act& act) {
    for (std::size_t k = 0; k < strands(); ++k) {
      if (const Status s = act(k); s != Status::ok) return s;
    }
    return Status::ok;
  }
  std::vector<double> of_strands(std::vector<double> (NaturalStrains::*values)()
                                     const) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < strands(); ++k) {
      const std::vector<double> one = (natural_strains(strand(k))->*values)();
      all.insert(all.end(), one.begin(), one.end());
    }
    return all;
  }

  /// Lanes without a strand repeat the first.
  void gather(In x, Packs& to) const {
    const double* from[Pack::lanes];
    for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
      from[lane] = part(x, lane < strands() ? lane : 0).data();
    }
    for (std::size_t k = 0; k < to.size(); ++k) {
      to[k] = Pack(from[0][k], from[1][k], from[2][k], from[3][k]);
    }
  }
  /// From x_; `retry` unless all numbers are finite.
  Status scatter(Out to) const {
    for (std::size_t lane = 0; lane < strands(); ++lane) {
      const Out own = part(to, lane);
      for (std::size_t k = 0; k < own.size(); ++k) {
        own[k] = x_[k][static_cast<int>(lane)];
      }
    }
    return std::ranges::all_of(to, [](double x) { return std::isfinite(x); })
               ? Status::ok
               : Status::retry;
  }

  std::unique_ptr<StrandSweepsOf<Pack>> sweeps_;
  bool swept_ = false;
  Status factored_ = Status::retry;
  Packs q_, v_, a_, x_;
};

/// These options with the largest number of quadrature points that any strand needs.
ReducedOptions with_same_points(std::span<const Strand> strands, Unknown unknown,
                                ReducedOptions options) {
  int most = 0;
  for (const Strand& strand : strands) {
    const ReducedStrand made = reduced_strand(strand, unknown, options, {});
    const ReducedSegment& first = made.segments.front();
    most = std::max(most,
                    Pack::lanes * static_cast<int>(first.last_block - first.first_block));
  }
  options.quadrature = most;
  return options;
}

}  // namespace

std::unique_ptr<System> four_strands(std::span<const Strand> strands, Unknown unknown,
                                     const ReducedOptions& given,
                                     const std::vector<Effects>& effects) {
  if (given.jacobian != ReducedJacobian::elastic) return nullptr;
  const ReducedOptions options = with_same_points(strands, unknown, given);
  const auto alone = unknown == Unknown::curvature ? super_helix : articulated_chain;
  std::vector<std::unique_ptr<System>> systems;
  std::vector<ReducedStrand> made;
  ToSweep all;
  for (std::size_t k = 0; k < strands.size(); ++k) {
    systems.push_back(alone(strands[k], options, effects[k]));
    made.push_back(reduced_strand(strands[k], unknown, options, effects[k]));
    all.strands.push_back(dynamic_cast<SweptStrand*>(systems.back().get()));
  }
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
    all.made.push_back(&made[lane < made.size() ? lane : 0]);
  }
  auto sweeps = sweeps_of_four(all, unknown, options.dofs);
  if (sweeps == nullptr) return nullptr;
  return std::make_unique<FourStrands>(std::move(systems), std::move(sweeps));
}

}  // namespace tress::models
