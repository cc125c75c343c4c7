#include "models/reduced/force_transport.h"

#include "contract/input_error.h"
#include "linear/dense_factor.h"
#include "models/reduced/ball_chain.h"
#include "models/reduced/transport_sweeps.h"
#include "models/reduced/tree/composite_matrix.h"
#include "models/strand/geometry.h"

namespace tress::models {
namespace {

template <int dofs>
class ForceTransport final : public ReducedSystem<BallLink, dofs> {
  using Base = ReducedSystem<BallLink, dofs>;
  using Base::dynamics_, Base::kinematics_, Base::scratch_, Base::zero_;

 public:
  ForceTransport(ReducedStrand strand, bool dense)
      : Base(std::move(strand)),
        always_dense_(dense),
        sweeps_(kinematics_, dynamics_, Base::mass_),
        of_mass_(kinematics_, dynamics_, Base::acceleration_),
        dense_(Base::exact_ || dense ? kinematics_.unknowns() : 0, false),
        gyroscopic_(Base::full_, dense_.matrix) {}

  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    sweeps_.residual(t, q, v, a, r);
    return Base::finite(r);
  }

  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return linearize_loaded(t, q, v, a, w, {}, {});
  }
  Status linearize_loaded(double t, In q, In v, In a, Weights w,
                          std::span<const SectionLoad> loads,
                          In springs) noexcept override {
    const bool exact = Base::exact_ && (w.vel != 0 || w.pos != 0);
    dense_in_use_ = exact || always_dense_;
    if (!dense_in_use_) return factored_ = sweeps_.factor(q, w);
    kinematics_.shape(q);
    sweeps_.compose(q);
    if (exact) {
      Base::take_exact_tangent(t, q, v, zero_, {0, w.vel, w.pos}, loads, springs);
      gyroscopic_.assemble(Base::full_);
      sweeps_.matrix().add_slope(kinematics_, w.pos, a, dense_.matrix);
    } else {
      dense_.matrix = Eigen::Map<const Eigen::VectorXd>(sweeps_.restoring(w).data(),
                                                        dense_.matrix.rows())
                          .asDiagonal();
    }
    sweeps_.matrix().add_dense(w.acc, dense_.matrix);
    return factored_ = dense_.factor();
  }

  Status solve(In b, Out x) noexcept override {
    if (factored_ != Status::ok) return factored_;
    if (dense_in_use_) {
      const Status s = dense_.solve(b, x);
      return s == Status::ok ? Base::finite(x) : s;
    }
    sweeps_.solve(b, x);
    return Base::finite(x);
  }
  /// The base's is that of the full inertia.
  bool factor_transposed(double, In, In, In, Weights) noexcept override { return false; }
  std::vector<double> constants() const override { return {}; }

 private:
  Status acceleration(double t, In q, In v, Out a) noexcept override {
    dynamics_.residual(t, q, v, zero_, scratch_);
    const Status s = of_mass_.factor(q, {1, 0, 0});
    if (s != Status::ok) return s;
    for (double& entry : scratch_) entry = -entry;
    of_mass_.solve(scratch_, a);
    return Base::finite(a);
  }

  /// With the full inertia, M a - f = (M - M_ft) a would be an additional load on the
  /// joints; as it is absent, its power is that of the omitted inertia.
  double power(double t, In q, In v) override {
    double sum = Base::power(t, q, v);
    if (!Base::regular_mass_) return sum;
    std::vector<double> a(zero_.size());
    if (acceleration(t, q, v, a) != Status::ok) return std::nan("");
    dynamics_.residual(t, q, v, a, scratch_);
    for (std::size_t i = 0; i < a.size(); ++i) sum += v[i] * scratch_[i];
    return sum;
  }

  bool always_dense_;
  TransportSweeps<BallLink, dofs> sweeps_, of_mass_;
  DenseFactor dense_;
  CompositeMatrix<ExactShape<dofs>> gyroscopic_;
  bool dense_in_use_ = false;
  Status factored_ = Status::retry;
};

}  // namespace

std::unique_ptr<System> force_transport(const Strand& strand,
                                        const ReducedOptions& options, Effects effects) {
  check_unbranched(strand, "force_transport");
  if (strand.free_root) {
    throw InputError("a root that moves freely is not among its joints",
                     "model force_transport",
                     "use motion = free with articulated_chain or super_helix");
  }
  ReducedStrand reduced =
      reduced_strand(strand, Unknown::joint_angle, options, std::move(effects));
  const bool dense = options.method == TreeMethod::composite;
  switch (options.dofs) {
    case 1:
      return std::make_unique<ForceTransport<1>>(std::move(reduced), dense);
    case 2:
      return std::make_unique<ForceTransport<2>>(std::move(reduced), dense);
    default:
      return std::make_unique<ForceTransport<3>>(std::move(reduced), dense);
  }
}

std::span<const Parameter> force_transport_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> own;
    for (Parameter p : reduced_parameters()) {
      if (p.name == "solver") {
        p.help =
            "solver of the elastic Jacobian; the exact Jacobian is always a dense matrix";
        p.choices = "sweep|composite";
      } else if (p.name == "jacobian") {
        p.help = "terms of dr/dq, dr/dv: all; mass, friction, elastic stiffness";
        p.choices = "exact|elastic";
      }
      own.push_back(p);
    }
    return own;
  }();
  return all;
}

std::unique_ptr<System> make_force_transport(const Strand& strand,
                                             const Parameters& parameters,
                                             Effects effects) {
  return force_transport(strand, reduced_options(parameters), std::move(effects));
}

}  // namespace tress::models
