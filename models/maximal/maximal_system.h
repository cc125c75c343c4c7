#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "contract/forms/compliance_form.h"
#include "contract/forms/constraint_form.h"
#include "contract/forms/contact_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/history.h"
#include "contract/forms/material_points.h"
#include "contract/forms/moving_history.h"
#include "contract/forms/point_accelerations.h"
#include "contract/forms/sections.h"
#include "contract/forms/sparse_form.h"
#include "contract/forms/stress_form.h"
#include "contract/forms/teleports.h"
#include "contract/forms/transposed_form.h"
#include "contract/jacobian_choice.h"
#include "contract/pattern.h"
#include "linear/kkt.h"
#include "linear/linear_solver.h"
#include "models/constrained/constraint_set.h"
#include "models/coupling/coupled_solver.h"
#include "models/effects/effect.h"
#include "models/held/held_contacts.h"
#include "models/maximal/elasticity.h"
#include "models/maximal/point_directions.h"

namespace tress::models {

/// The parts of a strand of redundant coordinates. All coordinates are z = (x_0, ...,
/// x_n, others): node positions (m), then those of the model (angles, quaternions). If
/// `clamped`, node 0 is the root and prescribed, z = [x_0; q]; otherwise q = z.
struct MaximalStrand {
  /// A point that carries mass and receives the loads of effects.
  struct MassPoint {
    NodeMean at;          // the point as a mean of nodes
    double mass, length;  // kg, m
    double arc;           // from the root, m
  };

  bool clamped = true;                // whether node 0 is prescribed
  double length = 0;                  // arc length at rest, m
  int nodes = 0;                      // number of nodes
  std::vector<double> z, rate;        // at t = 0
  std::vector<double> z_typ, z_rate;  // typical sizes of z and its rate
  std::vector<double> inertia;        // inertia of the other coordinates, >= 0
  std::vector<MassPoint> mass;        // points with mass
  std::vector<NodeMean> shown;        // root and segments' ends: MaterialPoints
  std::vector<double> edges;  // m, between nodes at rest; none: Elasticity::stretch
  RootMotion root;            // motion of the root
  std::unique_ptr<Elasticity> elasticity;  // internal forces
  Frame to_root;    // from the first edge to the section at the root, at rest
  Frame to_tip;     // from the last edge (Elasticity::end_frame) to the tip, at rest
  Effects effects;  // effects on the mass points
  /// Constraints on q: particles are the nodes that are not prescribed, parameters the
  /// other coordinates.
  std::unique_ptr<ConstraintSet> constraints;
  LinearKind solver = LinearKind::automatic;  // solver of the sparse matrix
  Jacobian jacobian =
      Jacobian::exact;  // elastic: loads as if the strand's tangent were fixed
};

/// Strand of redundant coordinates behind the contract of contract/system.h:
///
///     r = M a + dE/dz + friction - loads,   M = sum m_p w_p w_p^T + diag(inertia)
///
/// M is constant. Loads of effects act on the mass points. linearize eliminates along the
/// strand if its elasticity does (StrandElimination) and nothing else couples coordinates
/// beyond a node. Otherwise it assembles S in a fixed sparse pattern and factors it with
/// `solver`. O(nodes) for a strand. Couplings of distant points (Coupling) are in
/// linearize and solve only; SparseForm has only their diagonal blocks per point. If mass
/// points are nodes and the elasticity has a StrainForm, the system has a ComplianceForm.
class MaximalSystem final : public System,
                            public NaturalStrains,
                            public TransposedForm,
                            public PointAccelerations,
                            public Sections,
                            public Teleports,
                            private SparseForm,
                            private ExplicitForm,
                            private ComplianceForm,
                            private StressForm,
                            private Energetics,
                            private MaterialPoints,
                            private MovingHistory {
 public:
  /// Takes the parts of a strand.
  explicit MaximalSystem(MaximalStrand strand);

  Layout layout() const override;
  Traits traits() const override;
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  double next_breakpoint(double t) const override {
    return std::min(strand_.root.next_breakpoint(t),
                    models::next_breakpoint(strand_.effects, t));
  }
  std::string not_finite(double t, In q, In v) override;

  SparseForm* sparse_form() override { return this; }
  ExplicitForm* explicit_form() override;
  ConstraintForm* constraint_form() override { return strand_.constraints.get(); }
  ComplianceForm* compliance_form() override;
  StressForm* stress_form() override {
    return strand_.elasticity->takes_stresses() ? this : nullptr;
  }
  Energetics* energetics() override { return this; }
  History* history() override { return this; }
  MaterialPoints* material_points() override { return this; }
  ContactForm* contact_form() override { return held_contacts_.form(); }

  std::vector<double> natural() const override {
    const NaturalStrains* strains = strand_.elasticity->natural_strains();
    return strains == nullptr ? std::vector<double>{} : strains->natural();
  }
  bool factor_transposed(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve_transposed(In b, Out mu, Out by_q, Out by_v) noexcept override;
  std::vector<double> constants() const override;
  void place_transposed(double t, In q, In v, In a, In mu) noexcept override;
  void add_by_constants(InOut by) noexcept override;
  double power_of_loads(System& other) noexcept override;

  double next_teleport(double t) const override { return strand_.root.next_teleport(t); }
  void teleport(double t, InOut q, InOut v) override;
  void follow(double t) override;

  void accelerations(double t, In q, In v, In a, Out x) override;

  /// Returns the kind of the tip, and of a free root; others have no section.
  Kind section_kind(int point) const override;
  std::vector<int> section_coordinates(int point) const override;
  Frame section_frame(double t, In q, int point) override;
  SectionMotion section(double t, In q, In v, In a, int point) override;
  void add_moment(double t, In q, int point, const Vec& moment, InOut b) override;

  void set_natural(In values) override {
    strand_.elasticity->natural_strains()->set_natural(values);
  }
  std::vector<double> natural_stiffness() const override {
    return strand_.elasticity->natural_strains()->natural_stiffness();
  }

 private:
  bool accept(double t, InOut q, InOut v) override;
  bool carry(double t, InOut q, InOut v, InOut a) const override;
  std::string not_smooth() const override;
  void reset() override { strand_.elasticity->reset(); }
  std::vector<double> memory() const override { return strand_.elasticity->memory(); }
  void recall(In memory) override { strand_.elasticity->recall(memory); }

  const Pattern& pattern() const override { return pattern_; }
  Status values(double t, In q, In v, In, Weights w, Out s) noexcept override {
    return assemble(t, q, v, w, s, false);
  }
  void take_stresses(double t, In q, Stresses stresses) noexcept override;
  Status acceleration(double t, In q, In v, Out a) noexcept override;
  const std::vector<Block>& blocks() const override { return compliant_; }
  void inverse_mass(Out w) const override;
  Status rest(double t, In q, In v, Out a) noexcept override;
  void evaluate(double t, std::size_t k, In x, Value& value) noexcept override;
  bool add_second(double t, std::size_t k, In x, In stress, Second& h) noexcept override;
  const std::vector<Orientation>& orientations() override { return orientations_; }
  void orient(double t, double h, std::size_t k, In origin, InOut x) noexcept override;
  Energy energy(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  std::optional<Momentum> momentum(double t, In q, In v) override;
  int count() const override { return static_cast<int>(strand_.shown.size()); }
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;
  std::optional<double> stretch(double t, In q) override;
  std::optional<Mean> mean(int point) override;
  std::optional<std::array<double, 9>> end_frame(double t, In q) override;

  std::size_t held() const { return strand_.clamped ? 3 : 0; }
  std::optional<EndTurn> end_turn(int point) const;
  /// Index in z of the first of the two nodes at an end.
  std::size_t first_of_end(int point) const {
    return point == 0 ? 0 : 3 * (static_cast<std::size_t>(strand_.nodes) - 2);
  }
  Mean mean_of(const NodeMean& at) const;  // over the coordinates in q
  void build_pattern();
  bool diagonal_mass() const;
  void look_at(double t) noexcept;
  Frame frame_of(int point, const EndTurn& turn) const;
  void place(double t, In q) noexcept;
  void place(double t, In q, In v) noexcept;
  Placement placement() const { return {pose_, z_, rate_}; }
  Points points(Needs wanted) noexcept;
  bool eliminate(double t, Weights w) noexcept;
  void find_blocks(double t, Weights w, bool coupled_apart) noexcept;
  bool directed() const {
    return needs_.directions && strand_.jacobian == Jacobian::exact;
  }
  void add_directions(double t, const Points& p, double pos, Out s) noexcept;
  Status assemble(double t, In q, In v, Weights w, Out s, bool coupled_apart) noexcept;
  void add_mass(Weights w, GroupSum& sum) noexcept;
  void loads(double t) noexcept;
  void forces(double t, In a) noexcept;
  Status constrained_acceleration(double t, In q, In v, Out a) noexcept;
  double root_power(double t, In q, In v);

  MaximalStrand strand_;
  HeldContacts held_contacts_;
  Needs needs_;
  bool nodal_;  // mass point i is node i
  bool regular_mass_ = true;
  Groups elastic_, massive_, inert_;  // for energies, mass points, other coordinates
  PointDirections directions_;
  Pattern pattern_;
  StrandElimination* elimination_ = nullptr;  // null: S is assembled
  bool eliminated_ = false;                   // by the last linearize()
  // Of factor_transposed().
  Weights eliminated_weights_;
  std::vector<double> a_transposed_, mu_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<Coupling> contacts_;
  std::unique_ptr<CoupledSolver> coupled_solver_;  // if effects have couplings
  std::unique_ptr<LinearSolver> mass_solver_;      // made on first use
  std::unique_ptr<Kkt> kkt_;                       // made on first use
  RootPose pose_;                                  // at pose_time_
  double pose_time_ = std::numeric_limits<double>::quiet_NaN();
  StressOrigin origin_;                   // of the last take_stresses()
  bool displaced_ = false;                // the next tangent has its stresses from there
  double jumped_at_ = 0;                  // s, first of Elasticity::jumps()
  std::vector<double> z_, rate_, force_;  // all coordinates
  std::vector<double> x_, v_, tangent_, load_, mass_, length_, arc_;  // per mass point
  std::vector<double> blocks_;                                        // (9 mass points)
  std::vector<double> values_, scratch_;
  // Made on first use: blocks and orientations, and the number of prescribed coordinates
  // of each.
  std::vector<Block> compliant_;
  std::vector<Orientation> orientations_;
  std::vector<std::size_t> prescribed_, prescribed_of_orientation_;
};

}  // namespace tress::models
