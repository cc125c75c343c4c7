#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "contract/forms/contact_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/history.h"
#include "contract/forms/loaded_tangent.h"
#include "contract/forms/material_points.h"
#include "contract/forms/moved_clamp.h"
#include "contract/forms/natural_strains.h"
#include "contract/forms/point_accelerations.h"
#include "contract/forms/sections.h"
#include "contract/forms/teleports.h"
#include "contract/forms/transposed_form.h"
#include "linear/vector_ops.h"
#include "models/held/held_contacts.h"
#include "models/reduced/contact_tangent.h"
#include "models/reduced/exact_tangent.h"
#include "models/reduced/reduced_strand.h"
#include "models/reduced/stiff_tangent.h"
#include "models/reduced/strand_energies.h"
#include "models/reduced/strand_sweeps.h"
#include "models/reduced/tree/transposed_tangent.h"
#include "models/reduced/tree/tree_solver.h"
#include "models/strand/not_finite.h"

namespace tress::models {

/// A chain or tree of segments with one or two unknowns for each mode, of any kernel
/// (Helix, Clothoid, BallLink), behind the contract of contract/system.h. The residual is
/// that of Newton-Euler recursion, O(N). linearize() and solve() take the mass tangent or
/// the exact one, by the chosen method. If the strand touches itself, they take
/// `composite`. The acceleration of the explicit form always comes from the recursion.
/// With the elastic Jacobian, StrandSweeps replace both where they exist.
template <class Kernel, int modes>
class ReducedSystem : public System,
                      public NaturalStrains,
                      public TransposedForm,
                      public MovedClamp,
                      public PointAccelerations,
                      public Sections,
                      public LoadedTangent,
                      public Teleports,
                      protected ExplicitForm,
                      protected Energetics,
                      protected MaterialPoints,
                      protected History,
                      public SweptStrand {
 public:
  /// `swept`: kind of the unknowns, if sweeps over elements may serve them.
  explicit ReducedSystem(ReducedStrand strand, std::optional<Unknown> swept = {})
      : sweeps_(swept ? strand_sweeps({{&strand}, {this}}, *swept, modes) : nullptr),
        acceleration_sweeps_(sweeps_ ? strand_sweeps({{&strand}, {this}}, *swept, modes)
                                     : nullptr),
        exact_(strand.jacobian == ReducedJacobian::exact),
        regular_mass_(strand.regular_mass),
        unknown_scale_(strand.unknown_scale),
        length_(strand.length),
        rate_(strand.rate),
        to_tip_(strand.to_tip),
        rigid_links_(strand.rigid_links),
        kinematics_(strand.segments, std::move(strand.blocks), std::move(strand.root),
                    strand.free_root ? std::optional(FreeRootFrame(*strand.free_root))
                                     : std::nullopt,
                    strand.root_rotor),
        held_contacts_(strand.effects, kinematics_.points(),
                       [this](double t, In q, In v) {
                         kinematics_.move(t, q, v, zero_);
                         return placed();
                       }),
        dynamics_(kinematics_, std::move(strand.effects)),
        exact_tangent_(kinematics_, dynamics_),
        mass_(kinematics_, dynamics_),
        acceleration_(kinematics_, dynamics_),
        mass_solver_(make_tree_solver<Mass>(strand.method, mass_.last())),
        acceleration_solver_(
            make_tree_solver<Mass>(TreeMethod::recursive, acceleration_.last())) {
    const auto n = static_cast<std::size_t>(kinematics_.unknowns());
    zero_.assign(n, 0.0);
    scratch_.assign(n, 0.0);
    if (sweeps_) v_factored_.assign(n, 0.0);
    chain_ = kinematics_.is_chain();
    if (!exact_ && swept && dynamics_.stiffened()) {
      by_state_.resize(9 * kinematics_.points());
    }
    if (!exact_) return;
    if (dynamics_.effect_needs().derivatives) {
      for (auto* x : {&by_position_, &by_velocity_}) {
        x->resize(9 * kinematics_.points());
      }
    }
    if (dynamics_.effect_needs().directions) {
      by_direction_.resize(9 * kinematics_.points());
    }
    full_ = empty_tangent<Exact>(kinematics_);
    full_solver_ = make_tree_solver<Exact>(strand.method, full_);
    if (dynamics_.effect_needs().couplings) {
      coupled_solver_ = make_tree_solver<Exact>(TreeMethod::composite, full_);
    }
  }

  Layout layout() const override { return {kinematics_.unknowns(), 0}; }
  Traits traits() const override {
    return {.constant_mass = false, .regular_mass = regular_mass_};
  }

  void initial_state(Out q, Out v) const override {
    std::ranges::fill(v, 0.0);
    const auto& segments = kinematics_.segments();
    for (std::size_t i = 0; i < segments.size(); ++i) {
      for (int k = 0; k < dofs; ++k) {
        q[dofs * i + static_cast<std::size_t>(k)] = dot(K::unit(k), segments[i].initial);
      }
    }
    if (kinematics_.free()) kinematics_.free_root().initial_state(q.last(6), v.last(6));
  }

  void scale(Out q_typ, Out v_typ) const override {
    std::ranges::fill(q_typ, unknown_scale_);
    if (kinematics_.free()) {
      std::ranges::fill(q_typ.last(6).first(3), length_);
      std::ranges::fill(q_typ.last(3), 1.0);
    }
    for (std::size_t i = 0; i < q_typ.size(); ++i) v_typ[i] = rate_ * q_typ[i];
  }

  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    if (sweeps_ && !exact_) {
      sweeps_->residual(t, q, v, a, r);
    } else {
      dynamics_.residual(t, q, v, a, r);
    }
    return finite(r);
  }

  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return ReducedSystem::linearize_loaded(t, q, v, a, w, {}, {});
  }
  bool takes_loads() const override { return exact_ && chain_; }
  Status linearize_loaded(double t, In q, In v, In a, Weights w,
                          std::span<const SectionLoad> loads,
                          In springs) noexcept override {
    // Without velocity and position weights, only the mass remains.
    full_in_use_ = exact_ && (w.vel != 0 || w.pos != 0);
    swept_ = false;
    if (!full_in_use_) return factored_ = factor_mass(t, q, v, a, w);
    take_exact_tangent(t, q, v, a, w, loads, springs);
    return factored_ = exact_solver().factor(full_);
  }

  Status solve(In b, Out x) noexcept override {
    if (factored_ != Status::ok) return factored_;
    if (swept_) {
      sweeps_->solve(b, x);
      return finite(x);
    }
    const Status s =
        full_in_use_ ? exact_solver().solve(b, x) : mass_solver_->solve(b, x);
    return s == Status::ok ? finite(x) : s;
  }

  double next_breakpoint(double t) const override {
    return std::min(kinematics_.next_breakpoint(t),
                    models::next_breakpoint(dynamics_.effects(), t));
  }
  double next_teleport(double t) const override { return kinematics_.next_teleport(t); }
  /// Unknowns are relative to the root.
  void teleport(double t, InOut /*q*/, InOut /*v*/) override { follow(t); }
  void follow(double t) override { kinematics_.follow(t); }
  std::string not_finite(double t, In q, In v) override {
    const auto of_unknowns = [this](In x, const std::string& what) {
      const std::size_t chain = dofs * kinematics_.segments().size();
      return first_words(
          [&] { return not_finite_place(x.first(chain), dofs, what + " of element"); },
          [&] {
            return not_finite_place(x.subspan(chain), 3, what + " of the root, part");
          });
    };
    return first_words([&] { return of_unknowns(q, "coordinates"); },
                       [&] { return of_unknowns(v, "rates"); },
                       [&] {
                         kinematics_.move(t, q, v, zero_);
                         const FrameMotion& root = kinematics_.root();
                         return not_finite_clamp(root.x, root.v, root.a);
                       },
                       [&] { return not_finite_load(dynamics_.effects(), t, placed()); },
                       [&] {
                         dynamics_.residual(t, q, v, zero_, scratch_);
                         return of_unknowns(scratch_, "inertia or elasticity");
                       });
  }

  ExplicitForm* explicit_form() override { return regular_mass_ ? this : nullptr; }
  Energetics* energetics() override { return this; }
  /// Returns the history of a free root, whose frame may turn without limit.
  History* history() override { return kinematics_.free() ? this : nullptr; }
  MaterialPoints* material_points() override { return this; }
  ContactForm* contact_form() override { return held_contacts_.form(); }

  std::vector<double> natural() const override { return of_segments(&Segment::rest); }
  void set_natural(In values) override {
    for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
      kinematics_.set_rest(i, K::components(values, i));
    }
    for (auto* sweeps : {sweeps_.get(), acceleration_sweeps_.get()}) {
      if (sweeps != nullptr) sweeps->set_rest(values);
    }
  }
  std::vector<double> natural_stiffness() const override {
    return of_segments(&Segment::stiffness);
  }
  bool strains_are_coordinates() const override { return !kinematics_.free(); }

  // Of gradients alone. Cold and out of line: else the compiler inlines, and rounds, what
  // runs without gradients call in another way.
  [[gnu::cold, gnu::noinline]] bool factor_transposed(double t, In q, In v, In a,
                                                      Weights w) noexcept override {
    if (!exact_ || coupled_solver_) return false;
    if (!transposed_solver_) {
      transposed_solver_ = make_tree_solver<Exact>(TreeMethod::recursive, full_);
      product_a_.resize(zero_.size());
    }
    transposed_weights_ = w;
    const bool of_mass = w.pos == 0;  // S is M
    if (of_mass && ReducedSystem::linearize(t, q, v, a, w) != Status::ok) return false;
    take_transposed_tangent(t, q, v, a, of_mass ? Weights{0, 0, 1} : w);
    return of_mass || transposed_solver_->factor(full_) == Status::ok;
  }
  /// by_q follows from the product with S, or is that with dr/dq itself where S is M.
  [[gnu::cold, gnu::noinline]] Status solve_transposed(In b, Out mu, Out by_q,
                                                       Out by_v) noexcept override {
    const Weights w = transposed_weights_;
    if (w.pos != 0) {
      transposed_solver_->solve_transposed(b, mu);
    } else if (const Status s = ReducedSystem::solve(b, mu); s != Status::ok) {
      return s;
    }
    transposed_.compute(full_, mu, by_q);
    pull_rates(mu, by_v, product_a_);
    for (std::size_t k = 0; k < by_q.size() && w.pos != 0; ++k) {
      by_q[k] = (by_q[k] - w.vel * by_v[k] - w.acc * product_a_[k]) / w.pos;
    }
    return finite(mu);
  }
  std::vector<double> constants() const override {
    if (!exact_ || coupled_solver_) return {};
    std::vector<double> all = of_segments(&Segment::stiffness);
    const auto append = [&all](const std::vector<double>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    append(of_segments(&Segment::friction));
    append(of_segments(&Segment::rest));
    if constexpr (Kernel::functions == 2) append(of_segments(&Segment::inertia));
    for (const Segment& segment : kinematics_.segments()) all.push_back(segment.rotor);
    all.push_back(kinematics_.root_rotor());
    for (const PointBlock& block : kinematics_.blocks()) {
      for (int lane = 0; lane < Pack::lanes; ++lane) all.push_back(block.mass[lane]);
    }
    return all;
  }
  [[gnu::cold, gnu::noinline]] void place_transposed(double t, In q, In v, In a,
                                                     In mu) noexcept override {
    product_a_.resize(zero_.size());
    take_transposed_tangent(t, q, v, a, {0, 0, 1});
    transposed_.compute(full_, mu, scratch_);
    pull_rates(mu, scratch_, product_a_);
  }
  [[gnu::cold, gnu::noinline]] void add_by_constants(InOut by) noexcept override {
    const auto& segments = kinematics_.segments();
    const std::size_t count = segments.size();
    const auto part = [&by](std::size_t length) {
      const InOut first = by.first(length);
      by = by.subspan(length);
      return first;
    };
    const InOut stiffness = part(dofs * count), friction = part(dofs * count),
                rest = part(dofs * count),
                inertia = part(Kernel::functions == 2 ? dofs * count : 0),
                rotor = part(count), root_rotor = part(1);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& m = kinematics_.motion(i);
      const auto strain = K::components(q_transposed_, i) - segments[i].rest;
      for (int k = 0; k < dofs; ++k) {
        const auto e = K::unit(k);
        const std::size_t at = dofs * i + static_cast<std::size_t>(k);
        const double mu = transposed_.rows(i)[Exact::wrench + k];
        stiffness[at] += mu * dot(e, strain);
        friction[at] += mu * dot(e, m.rate);
        rest[at] -= mu * dot(e, segments[i].stiffness);
        if constexpr (Kernel::functions == 2) inertia[at] += mu * dot(e, m.acceleration);
      }
      const Vec turn = exact_tangent_.vectors(transposed_.by_tip(i), 0).second;
      rotor[i] += dot(turn, dynamics_.rotor_moment(1, m.tip));
    }
    if (kinematics_.free()) {
      const Vec turn = exact_tangent_.vectors(transposed_.by_root(), 0).second;
      root_rotor[0] += dot(turn, dynamics_.rotor_moment(1, kinematics_.root()));
    }
    for (std::size_t b = 0; b < u_.size(); ++b) {
      const Pack power = dot(dynamics_.force(b) + dynamics_.load(b), u_[b]);
      const Pack& mass = kinematics_.blocks()[b].mass;
      for (int lane = 0; lane < Pack::lanes; ++lane) {
        if (mass[lane] > 0) {
          by[K::first_point(b) + static_cast<std::size_t>(lane)] +=
              power[lane] / mass[lane];
        }
      }
    }
  }
  [[gnu::cold, gnu::noinline]] double power_of_loads(System& other) noexcept override {
    auto* const of = dynamic_cast<ReducedSystem*>(&other);
    if (of == nullptr || of->kinematics_.points() != kinematics_.points()) {
      return std::nan("");
    }
    if (!of->dynamics_.loaded()) return 0;
    const Needs wanted = of->dynamics_.effect_needs();
    if (!loads_placed_) {
      // residual() has placed the points of the own effects.
      const Needs own = dynamics_.effect_needs();
      const bool placed = dynamics_.loaded() && own.position >= wanted.position &&
                          own.velocity >= wanted.velocity &&
                          own.tangent >= wanted.tangent;
      if (!placed)
        dynamics_.place(own | wanted | Needs{.position = true, .velocity = true});
      for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
        const auto& segment = kinematics_.segments()[i];
        for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
          scatter3(kinematics_.world(i, u_[b]), &u_world_[3 * K::first_point(b)], 3);
        }
      }
      loads_placed_ = true;
    }
    const In loads = of->dynamics_.find_loads(t_transposed_, dynamics_.points(wanted));
    return scalar_product(loads, u_world_);
  }

  /// Motion across the plane of a planar strand is not among the states of its tangent.
  [[gnu::cold, gnu::noinline]] double power_of_clamp(System& other) noexcept override {
    auto* const of = dynamic_cast<ReducedSystem*>(&other);
    if (of == nullptr || modes == 1 || kinematics_.free() || of->kinematics_.free()) {
      return std::nan("");
    }
    return exact_tangent_.change(transposed_.at_root(), kinematics_.root(),
                                 of->kinematics_.clamp(t_transposed_));
  }

  /// Rigid links have one at the tip; others at all points, except a clamped root.
  Kind section_kind(int point) const override {
    const bool tip = point == kinematics_.count();
    if (!chain_ || (rigid_links_ ? !tip : point == 0 && !kinematics_.free())) return {};
    using enum Turning;
    return {modes == 3   ? frame
            : modes == 2 ? tangent
                         : in_plane,
            rigid_links_, rigid_links_};
  }
  std::vector<int> section_coordinates(int) const override {
    std::vector<int> all(zero_.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  [[gnu::noinline]] Frame section_frame(double t, In q, int point) override {
    const Frame& frame = kinematics_.frames(t, q)[static_cast<std::size_t>(point)];
    return point == kinematics_.count() ? frame * to_tip_ : frame;
  }
  // Cold and out of line for the reason that is given at factor_transposed().
  [[gnu::cold, gnu::noinline]] SectionMotion section(double t, In q, In v, In a,
                                                     int point) override {
    kinematics_.move(t, q, v, a);
    const FrameMotion& m =
        point == 0 ? kinematics_.root()
                   : kinematics_.motion(static_cast<std::size_t>(point) - 1).tip;
    return {point == kinematics_.count() ? m.frame * to_tip_ : m.frame, m.frame * m.omega,
            m.frame * m.alpha};
  }
  [[gnu::cold, gnu::noinline]] void add_moment(double t, In q, int point,
                                               const Vec& moment, InOut b) override {
    TipForces<Kernel, modes>(kinematics_, t, q).pull_back_moment(point, moment, b);
  }

 protected:
  bool accept(double, InOut q, InOut v) override {
    return kinematics_.free_root().rebase(q.last(6), v.last(6));
  }
  void reset() override { kinematics_.free_root().reset(); }
  std::vector<double> memory() const override {
    std::vector<double> reference(9);
    store9(kinematics_.free_root().reference(), reference.data());
    return reference;
  }
  void recall(In memory) override {
    kinematics_.free_root().recall(load9(memory.data()));
  }

  // For ForceTransport, which changes how accelerations enter.
  using K = Kinematics<Kernel, modes>;
  static constexpr int dofs = K::dofs;
  using Mass = MassShapeOf<Kernel, modes>;
  using Exact = ExactShapeOf<Kernel, modes>;

  using Segment = typename K::Segment;
  /// The unknowns' components of a member of every segment.
  std::vector<double> of_segments(typename Kernel::Strain Segment::*member) const {
    std::vector<double> all;
    for (const Segment& segment : kinematics_.segments()) {
      for (int k = 0; k < dofs; ++k) all.push_back(dot(K::unit(k), segment.*member));
    }
    return all;
  }

  static Status finite(In x) {
    return std::ranges::all_of(x, [](double y) { return std::isfinite(y); })
               ? Status::ok
               : Status::retry;
  }

  FrameMotion clamp(double t) override { return kinematics_.clamp(t); }
  Places places() override {
    const auto of_effects = dynamics_.places();
    return {of_effects.x, of_effects.v, of_effects.tangent};
  }
  bool loaded() const override { return dynamics_.pushed(); }
  bool stiffened() const override { return dynamics_.stiffened(); }
  In loads(double t) override { return dynamics_.find_placed_loads(t); }
  In stiffness(double t, Weights w) override {
    if (!stiffened()) return {};
    // Of all effects together; the sweeps have those of viscous ones.
    dynamics_.derivatives(t, -w.pos, -w.vel, by_state_);
    make_semidefinite(by_state_);
    dynamics_.subtract_viscous(w.vel, by_state_);
    return by_state_;
  }

  /// Factors by sweeps over the elements of the kernels, if these are accurate.
  Status factor_mass(double t, In q, In v, In a, Weights w) {
    if (sweeps_) {
      swept_ = sweeps_->factor(t, q, v, a, w);
      std::ranges::copy(v, v_factored_.begin());
      weights_ = w;
      if (swept_) return Status::ok;
    }
    return mass_solver_->factor(mass_.at(t, q, v, w));
  }

  void take_exact_tangent(double t, In q, In v, In a, Weights w,
                          std::span<const SectionLoad> loads, In springs) {
    dynamics_.residual(t, q, v, a, scratch_);
    if (!loads.empty()) dynamics_.hang(loads);
    if (!hung_.empty()) release_tips();
    const auto effects = effect_blocks(t);
    dynamics_.couplings(t, contacts_);
    full_.couplings.clear();
    for (const Coupling& contact : contacts_) {
      full_.couplings.push_back(ContactTangent(kinematics_).of(contact, w));
    }
    fill_tangent(w, effects, v, a, full_);
    if (!loads.empty() || !springs.empty()) add_loads(loads, w.pos, springs);
  }

  // Of supports alone; see factor_transposed().
  [[gnu::cold, gnu::noinline]] void release_tips() {
    for (const std::size_t i : hung_) full_.segments[i].tip.setZero();
    hung_.clear();
  }
  /// Adds the derivatives of loads, which hang on the strand, and of springs times
  /// `factor`.
  [[gnu::cold, gnu::noinline]] void add_loads(std::span<const SectionLoad> loads,
                                              double factor, In springs) {
    for (const SectionLoad& load : loads) {
      if (load.point == 0) {
        if (full_.free_root) exact_tangent_.load_root(load, full_.root);
        continue;
      }
      const auto i = static_cast<std::size_t>(load.point) - 1;
      exact_tangent_.load(load, kinematics_.motion(i).tip, full_.segments[i].tip);
      hung_.push_back(i);
    }
    if (springs.empty()) return;
    const std::size_t root = dofs * full_.segments.size();
    for (std::size_t i = 0; i < root; ++i) {
      const auto k = static_cast<int>(i % dofs);
      full_.segments[i / dofs].local(Exact::wrench + k, Exact::states + k) +=
          factor * springs[i];
    }
    for (std::size_t i = root; i < springs.size(); ++i) {
      const auto k = static_cast<int>(i - root);
      full_.root.local(k, k) += factor * springs[i];
    }
  }

  /// Fills in the matrices of all segments, at the motion of the last residual().
  void fill_tangent(Weights w,
                    const typename ExactTangent<Kernel, modes>::EffectBlocks& effects,
                    In v, In a, TreeTangent<Exact>& to) const {
    for (std::size_t i = 0; i < to.segments.size(); ++i) {
      exact_tangent_.segment(i, w, effects, to.segments[i]);
    }
    if (to.free_root) exact_tangent_.root(w, v.last(6), a.last(6), to.root);
  }

  void take_transposed_tangent(double t, In q, In v, In a, Weights w) {
    dynamics_.residual(t, q, v, a, scratch_);
    if (!hung_.empty()) release_tips();
    fill_tangent(w, effect_blocks(t), v, a, full_);
    t_transposed_ = t;
    q_transposed_.assign(q.begin(), q.end());
    v_transposed_.assign(v.begin(), v.end());
    a_transposed_.assign(a.begin(), a.end());
    u_.resize(kinematics_.blocks().size());
    u_world_.resize(3 * kinematics_.points());
  }

  /// (dr/dv)^T mu and (dr/da)^T mu after the product with full_; u_.
  void pull_rates(In mu, Out by_v, Out by_a) {
    loads_placed_ = false;
    const typename ExactTangent<Kernel, modes>::EffectBlocks effects{
        by_position_, by_velocity_, by_direction_};
    const std::size_t segments = kinematics_.segments().size();
    for (std::size_t i = 0; i < segments; ++i) {
      exact_tangent_.pull_rates(i, effects, transposed_.rows(i), transposed_.by_state(i),
                                by_v.subspan(dofs * i, dofs),
                                by_a.subspan(dofs * i, dofs), u_);
    }
    if (!kinematics_.free()) return;
    const std::size_t root = dofs * segments;
    RootTangent<Exact> tangent;
    const auto pull = [&](Weights w, Out to) {
      exact_tangent_.root(w, In(v_transposed_).last(6), In(a_transposed_).last(6),
                          tangent);
      transposed_.compute_root(tangent, mu.subspan(root), to.subspan(root));
    };
    pull({0, 1, 0}, by_v);
    pull({1, 0, 0}, by_a);
  }

  /// Strands that touch themselves need a solver for all unknowns at once.
  TreeSolver<Exact>& exact_solver() {
    return full_.couplings.empty() ? *full_solver_ : *coupled_solver_;
  }

  typename ExactTangent<Kernel, modes>::EffectBlocks effect_blocks(double t) {
    if (by_position_.empty() && by_direction_.empty()) return {};
    dynamics_.place(dynamics_.effect_needs());
    if (!by_position_.empty()) {
      dynamics_.uncoupled_derivatives(t, 1, 0, by_position_);
      dynamics_.uncoupled_derivatives(t, 0, 1, by_velocity_);
    }
    if (!by_direction_.empty()) dynamics_.direction_derivatives(t, by_direction_);
    return {by_position_, by_velocity_, by_direction_};
  }

  Status acceleration(double t, In q, In v, Out a) noexcept override {
    if (acceleration_sweeps_) {
      acceleration_sweeps_->residual(t, q, v, zero_, scratch_);
      if (acceleration_sweeps_->factor(t, q, v, zero_, {1, 0, 0})) {
        for (double& entry : scratch_) entry = -entry;
        acceleration_sweeps_->solve(scratch_, a);
        return finite(a);
      }
    }
    dynamics_.residual(t, q, v, zero_, scratch_);
    const Status s = acceleration_solver_->factor(acceleration_.here({1, 0, 0}));
    if (s != Status::ok) return s;
    for (double& entry : scratch_) entry = -entry;
    const Status solved = acceleration_solver_->solve(scratch_, a);
    return solved == Status::ok ? finite(a) : solved;
  }

  static Vec rotor_momentum(double inertia, const FrameMotion& m) {
    return (inertia * m.omega.x) * m.frame.e0;
  }

  /// The points of effects, with everything that potential() and power() read.
  Points placed() {
    const Needs wanted =
        dynamics_.effect_needs() | Needs{.position = true, .velocity = true};
    dynamics_.place(wanted);
    return dynamics_.points(wanted);
  }

  Energy energy(double t, In q, In v) override {
    kinematics_.move(t, q, v, zero_);
    const auto own = strand_energies(kinematics_, q, v);
    Energy e{own.kinetic, own.elastic};
    const Points points = placed();
    for (const auto& effect : dynamics_.effects()) {
      e.potential += effect->potential(t, points);
    }
    return e;
  }

  double power(double t, In q, In v) override {
    kinematics_.move(t, q, v, zero_);
    const Points points = placed();
    double sum = 0;
    for (const auto& effect : dynamics_.effects()) sum += effect->power(t, points);
    for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
      sum -= weighed_square(kinematics_.segments()[i].friction, K::components(v, i));
    }
    return sum + root_power(t, q, v);
  }

  /// Power of the clamp that holds the root on its path.
  double root_power(double t, In q, In v) {
    if (!kinematics_.moving_root() || !regular_mass_) return 0;
    std::vector<double> a(zero_.size());
    if (acceleration(t, q, v, a) != Status::ok) return std::nan("");
    dynamics_.residual(t, q, v, a, scratch_);
    const Wrench& w = dynamics_.at_root();
    return dot(w.force, kinematics_.root().v) + dot(w.moment, kinematics_.root().omega);
  }

  std::optional<Momentum> momentum(double t, In q, In v) override {
    kinematics_.move(t, q, v, zero_);
    Vec linear;
    Vec angular = rotor_momentum(kinematics_.root_rotor(), kinematics_.root());
    for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
      const auto& segment = kinematics_.segments()[i];
      angular = angular + rotor_momentum(segment.rotor, kinematics_.motion(i).tip);
      for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
        const Vec3<Pack> x = Vec3<Pack>(kinematics_.start(i).x) +
                             kinematics_.world(i, kinematics_.block_geometry(b).position);
        const Vec3<Pack> p = kinematics_.blocks()[b].mass *
                             kinematics_.world(i, kinematics_.velocity(i, b));
        const Vec3<Pack> l = cross(x, p);
        linear = linear + Vec{sum(p.x), sum(p.y), sum(p.z)};
        angular = angular + Vec{sum(l.x), sum(l.y), sum(l.z)};
      }
    }
    return Momentum{{linear.x, linear.y, linear.z}, {angular.x, angular.y, angular.z}};
  }

  // Material points: the root and the tips of all segments.
  int count() const override { return kinematics_.count() + 1; }
  int before(int i) const override {
    return i == 0 ? -1
                  : kinematics_.segments()[static_cast<std::size_t>(i) - 1].parent + 1;
  }
  void positions(double t, In q, Out x) override {
    for (const auto& tip : kinematics_.template tips<true>(t, q, zero_)) {
      store3(tip.x, x.data());
      x = x.subspan(3);
    }
  }
  void velocities(double t, In q, In v, Out u) override {
    for (const auto& tip : kinematics_.tips(t, q, v)) {
      store3(tip.frame * tip.v, u.data());
      u = u.subspan(3);
    }
  }
  /// Kinematics measure accelerations relative to a frame that falls.
  void accelerations(double t, In q, In v, In a, Out x) override {
    const Vec fall = uniform_acceleration(dynamics_.effects());
    kinematics_.move(t, q, v, a);
    const auto put = [&](std::size_t point, const FrameMotion& m) {
      store3(m.frame * m.a + fall, &x[3 * point]);
    };
    put(0, kinematics_.root());
    for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
      put(i + 1, kinematics_.motion(i).tip);
    }
  }
  /// A point moves by the slope of every segment before it, and turns about its tip.
  bool jacobian(double t, In q, Out j) override {
    kinematics_.move(t, q, zero_, zero_);
    std::ranges::fill(j, 0.0);
    const std::size_t n = q.size();
    const auto set = [&](std::size_t point, std::size_t column, const Vec& u) {
      j[(3 * point) * n + column] = u.x;
      j[(3 * point + 1) * n + column] = u.y;
      j[(3 * point + 2) * n + column] = u.z;
    };
    const auto& segments = kinematics_.segments();
    for (std::size_t p = 1; p <= segments.size(); ++p) {
      const Vec& x = kinematics_.motion(p - 1).tip.x;
      for (int before = static_cast<int>(p) - 1; before >= 0;) {
        const auto i = static_cast<std::size_t>(before);
        const Frame& from = kinematics_.start(i).frame;
        const Vec arm = x - kinematics_.motion(i).tip.x;
        for (std::size_t k = 0; k < dofs; ++k) {
          const auto& g = kinematics_.geometry(i);
          set(p, dofs * i + k, from * g.slope[k] + cross(from * g.turn[k], arm));
        }
        before = segments[i].parent;
      }
    }
    if (kinematics_.free()) add_free_root(n - 6, set);
    return true;
  }
  bool pull_back(double t, In q, std::span<const int> points, In f, InOut b) override {
    if (!chain_) return false;
    TipForces<Kernel, modes>(kinematics_, t, q).pull_back(points, f, b);
    return true;
  }
  bool responses(double t, In q, std::span<const int> points, Out blocks) override {
    if (!chain_ || full_in_use_ || factored_ != Status::ok) return false;
    const TipForces<Kernel, modes> forces(kinematics_, t, q);
    if (swept_) {
      const Status s = mass_solver_->factor(mass_.at(t, q, v_factored_, weights_));
      if (s != Status::ok) return false;
    }
    loads_.clear();
    for (const int point : points) loads_.push_back({point - 1, forces.units(point)});
    return mass_solver_->respond(loads_, blocks);
  }
  /// Columns of the root's position and rotation.
  template <class Set>
  void add_free_root(std::size_t first, Set set) const {
    const FreeRootFrame& root = kinematics_.free_root();
    const Vec& at = kinematics_.root().x;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec axis{k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0};
      const Vec turn = root.frame() * root.joint().W_transposed(root.at(), axis);
      for (std::size_t p = 0; p <= kinematics_.segments().size(); ++p) {
        const Vec& x = p == 0 ? at : kinematics_.motion(p - 1).tip.x;
        set(p, first + k, axis);
        set(p, first + 3 + k, cross(turn, x - at));
      }
    }
  }
  /// Lengths are no unknowns.
  std::optional<double> stretch(double, In) override { return 0; }

  /// With several free ends, that of the last segment.
  std::optional<std::array<double, 9>> end_frame(double t, In q) override {
    std::array<double, 9> axes;
    store9(kinematics_.last_frame(t, q) * to_tip_, axes.data());
    return axes;
  }

  std::unique_ptr<StrandSweeps> sweeps_, acceleration_sweeps_;
  bool exact_, regular_mass_;
  double unknown_scale_, length_, rate_;
  Frame to_tip_;
  bool rigid_links_;
  K kinematics_;
  HeldContacts held_contacts_;
  InverseDynamics<Kernel, modes> dynamics_;
  ExactTangent<Kernel, modes> exact_tangent_;
  StiffTangent<Kernel, modes> mass_, acceleration_;
  TreeTangent<Exact> full_;
  TransposedProduct<Exact> transposed_;
  std::unique_ptr<TreeSolver<Mass>> mass_solver_, acceleration_solver_;
  std::unique_ptr<TreeSolver<Exact>> full_solver_, coupled_solver_;
  std::unique_ptr<TreeSolver<Exact>> transposed_solver_;  // made on first use
  double t_transposed_ = 0;
  std::vector<double> q_transposed_, v_transposed_, a_transposed_, product_a_;
  std::vector<Vec3<Pack>> u_;    // of points for v = mu, in components of the starts
  std::vector<double> u_world_;  // likewise, of power_of_loads()
  bool loads_placed_ = false;    // u_world_ and points are those of u_
  bool full_in_use_ = false, swept_ = false;
  std::vector<std::size_t> hung_;  // segments with loads on their tips in full_
  Weights weights_, transposed_weights_;
  Status factored_ = Status::retry;
  std::vector<double> zero_, scratch_, by_position_, by_velocity_, by_direction_,
      by_state_, v_factored_;
  std::vector<Coupling> contacts_;
  bool chain_ = true;
  std::vector<typename TreeSolver<Mass>::Load> loads_;  // scratch of responses()
};

/// `PlanarKernel` is the kernel for one mode, `BentKernel` that for two.
template <class Kernel, class PlanarKernel, class BentKernel = Kernel>
std::unique_ptr<System> make_reduced_system(ReducedStrand strand, Unknown unknown,
                                            int modes) {
  const auto make = [&]<class System>() {
    return std::make_unique<System>(std::move(strand), unknown);
  };
  switch (modes) {
    case 1:
      return make.template operator()<ReducedSystem<PlanarKernel, 1>>();
    case 2:
      return make.template operator()<ReducedSystem<BentKernel, 2>>();
    default:
      return make.template operator()<ReducedSystem<Kernel, 3>>();
  }
}

}  // namespace tress::models
