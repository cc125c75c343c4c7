#include "models/reduced/force_transport.h"

#include "models/reduced/ball_chain.h"
#include "models/reduced/composite_matrix.h"
#include "models/reduced/dense_factor.h"
#include "models/reduced/transport_matrix.h"
#include "models/strand/geometry.h"
#include "models/strand/strand_parameters.h"

namespace tress {
namespace {

template <int dofs>
class ForceTransport final : public ReducedSystem<BallLink, dofs> {
  using Base = ReducedSystem<BallLink, dofs>;
  using Base::dynamics_, Base::kinematics_, Base::scratch_, Base::zero_, Base::mass_;

 public:
  ForceTransport(ReducedStrand strand, bool sweeps)
      : Base(std::move(strand)),
        sweeps_(sweeps),
        transport_(kinematics_.segments().size()),
        dense_(Base::exact_ || !sweeps ? kinematics_.unknowns() : 0, false),
        gyroscopic_(Base::full_, dense_.matrix),
        restoring_(zero_) {}

  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    dynamics_.residual(t, q, v, zero_, r);
    compose(q);
    transport_.add_product(a, r);
    return Base::finite(r);
  }

  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    const bool exact = Base::exact_ && (w.vel != 0 || w.pos != 0);
    dense_in_use_ = exact || !sweeps_;
    kinematics_.shape(q);
    compose(q);
    if (!dense_in_use_) return factored_ = transport_.factor(w.acc, restoring(w));
    if (exact) {
      Base::take_exact_tangent(t, q, v, zero_, {0, w.vel, w.pos});
      gyroscopic_.assemble(Base::full_);
      transport_.add_slope(kinematics_, w.pos, a, dense_.matrix);
    } else {
      dense_.matrix =
          Eigen::Map<const Eigen::VectorXd>(restoring(w).data(), dense_.matrix.rows())
              .asDiagonal();
    }
    transport_.add_dense(w.acc, dense_.matrix);
    return factored_ = dense_.factor();
  }

  Status solve(In b, Out x) noexcept override {
    if (factored_ != Status::ok) return factored_;
    if (dense_in_use_) {
      const Status s = dense_.solve(b, x);
      return s == Status::ok ? Base::finite(x) : s;
    }
    transport_.solve(b, x);
    return Base::finite(x);
  }

 private:
  /// Composite bodies at q, kept for the next call.
  void compose(In q) {
    if (std::ranges::equal(q, composed_)) return;
    transport_.compose(mass_.here({1, 0, 0}));
    composed_.assign(q.begin(), q.end());
  }

  In restoring(Weights w) {
    for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
      const Vec of_segment = tress::restoring(kinematics_.segments()[i], w);
      for (int k = 0; k < dofs; ++k) {
        restoring_[dofs * i + static_cast<std::size_t>(k)] =
            dot(Base::K::unit(k), of_segment);
      }
    }
    return restoring_;
  }

  Status acceleration(double t, In q, In v, Out a) noexcept override {
    dynamics_.residual(t, q, v, zero_, scratch_);
    compose(q);
    const Status s = transport_.factor(1, zero_);
    if (s != Status::ok) return s;
    for (double& entry : scratch_) entry = -entry;
    transport_.solve(scratch_, a);
    return Base::finite(a);
  }

  /// With the whole inertia M a - f = (M - M_ft) a is what the joints would have to bear:
  /// a load that is not there, so its power is that of the inertia left out.
  double power(double t, In q, In v) override {
    double sum = Base::power(t, q, v);
    if (!Base::regular_mass_) return sum;
    std::vector<double> a(zero_.size());
    if (acceleration(t, q, v, a) != Status::ok) return std::nan("");
    dynamics_.residual(t, q, v, a, scratch_);
    for (std::size_t i = 0; i < a.size(); ++i) sum += v[i] * scratch_[i];
    return sum;
  }

  bool sweeps_;
  TransportMatrix<BallLink, dofs> transport_;
  DenseFactor dense_;
  CompositeMatrix<ExactShape<dofs>> gyroscopic_;
  std::vector<double> restoring_, composed_;
  bool dense_in_use_ = false;
  Status factored_ = Status::retry;
};

}  // namespace

std::unique_ptr<System> force_transport(const Strand& strand,
                                        const ReducedOptions& options, Effects effects) {
  check_unbranched(strand, "force_transport");
  ReducedStrand reduced =
      reduced_strand(strand, Unknown::joint_angle, options, std::move(effects));
  const bool sweeps = options.method != TreeMethod::composite;
  switch (options.dofs) {
    case 1:
      return std::make_unique<ForceTransport<1>>(std::move(reduced), sweeps);
    case 2:
      return std::make_unique<ForceTransport<2>>(std::move(reduced), sweeps);
    default:
      return std::make_unique<ForceTransport<3>>(std::move(reduced), sweeps);
  }
}

std::span<const Parameter> force_transport_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> own;
    for (Parameter p : reduced_parameters()) {
      if (p.name == "solver") {
        p.help = "of the stiff tangent; the exact one is a dense matrix always";
        p.choices = "sweep|composite";
      } else if (p.name == "tangent") {
        p.help = "terms of dr/dq, dr/dv: all; mass, friction, elastic stiffness";
        p.choices = "exact|stiff";
      }
      own.push_back(p);
    }
    std::vector<Parameter> shared = with_strand_parameters(own);
    // The joint at a free root would have no mass on its other side.
    for (Parameter& p : shared) {
      if (p.name == "root") p.choices = bound_root_choices;
    }
    return shared;
  }();
  return all;
}

std::unique_ptr<System> make_force_transport(const Strand& strand,
                                             const Parameters& parameters,
                                             Effects effects) {
  return force_transport(strand, reduced_options(parameters), std::move(effects));
}

}  // namespace tress
