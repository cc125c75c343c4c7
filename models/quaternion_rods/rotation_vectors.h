#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/material_points.h"
#include "contract/forms/moving_history.h"
#include "contract/forms/natural_strains.h"
#include "contract/forms/point_accelerations.h"
#include "contract/forms/sections.h"
#include "contract/forms/sparse_form.h"
#include "contract/forms/stress_form.h"
#include "contract/forms/teleports.h"
#include "linear/linear_solver.h"
#include "models/quaternion_rods/conformal_rotation.h"

namespace tress::models {

/// A rod of quaternions in coordinates without constraints: a rotation vector c for every
/// quaternion q = q_ref p(c) (ConformalRotation), relative to a reference that follows
/// the motion. Norms are 1 to rounding. With J = dq/dc, the residual r of the rod gives
///
///     q' = J c',    q'' = J c'' + J' c',    J^T r(q, q', q''),
///
/// and S its derivative by c, with the curvature of q(c). J^T takes out the force along
/// q, so penalties on norms do nothing.
///
/// References are renewed after an accepted step in which some rotation from its
/// reference has exceeded an angle, at 0 after every step. A method with memory carries
/// it into the new coordinates exactly. With generalized_alpha and renewal after every
/// step, that is a time integration in incremental rotation vectors [Cardona & Geradin
/// 1988]. Lie-group generalized-alpha adds h ((1 - gamma) a_n + gamma a_{n+1}) to the
/// angular velocity, this method to c'. Steps differ by terms of order h^3.
///
/// There is no ComplianceForm: position-based methods correct quaternions.
class RotationVectors final : public System,
                              public NaturalStrains,
                              public PointAccelerations,
                              public Sections,
                              public Teleports,
                              private SparseForm,
                              private ExplicitForm,
                              private StressForm,
                              private Energetics,
                              private MaterialPoints,
                              private MovingHistory {
 public:
  /// Takes a rod whose last coordinates are `edges` quaternions. Each has the same
  /// inertia along its four components. The rod has every form of this class, and no
  /// other. `renewal`: angle (rad), below 2 pi.
  RotationVectors(std::unique_ptr<System> rod, std::size_t edges, double renewal,
                  LinearKind solver);

  Layout layout() const override { return {static_cast<int>(first_ + 3 * edges())}; }
  Traits traits() const override { return {.regular_mass = rod_->traits().regular_mass}; }
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  double next_breakpoint(double t) const override { return rod_->next_breakpoint(t); }
  std::string not_finite(double t, In q, In v) override;

  SparseForm* sparse_form() override { return this; }
  ExplicitForm* explicit_form() override {
    return rod_->explicit_form() == nullptr ? nullptr : this;
  }
  StressForm* stress_form() override { return this; }
  Energetics* energetics() override { return this; }
  MaterialPoints* material_points() override { return this; }
  History* history() override { return this; }

  std::vector<double> natural() const override { return strains_->natural(); }
  void set_natural(In values) override { strains_->set_natural(values); }
  std::vector<double> natural_stiffness() const override {
    return strains_->natural_stiffness();
  }
  void accelerations(double t, In q, In v, In a, Out x) override;
  Kind section_kind(int point) const override { return sections_->section_kind(point); }
  std::vector<int> section_coordinates(int point) const override;
  Frame section_frame(double t, In q, int point) override;
  SectionMotion section(double t, In q, In v, In a, int point) override;
  void add_moment(double t, In q, int point, const Vec& moment, InOut b) override;

  double next_teleport(double t) const override;
  void teleport(double t, InOut q, InOut v) override;
  void follow(double t) override;

  /// Writes the coordinates of the rod, with its quaternions.
  void rod_coordinates(In q, Out of_rod);

 private:
  /// Entries of S of the rod that couple two groups of coordinates, and their places in
  /// the reduced matrix. Groups are nodes (3 coordinates) and quaternions. Where the rod
  /// has no entry, the last of its values stands, which is 0.
  struct Coupled {
    std::size_t row, column;
    std::array<std::array<std::size_t, 4>, 4> from;
    std::array<std::array<std::size_t, 3>, 3> to;
  };
  /// Derivatives of an edge's quaternion and of its rate by the rotation vector.
  struct Slopes {
    double position[4][3] = {};  // dq/dc
    double rate[4][3] = {};      // dq'/dc
  };

  const Pattern& pattern() const override { return pattern_; }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override;
  Status acceleration(double t, In q, In v, Out a) noexcept override;
  void take_stresses(double t, In q, Stresses stresses) noexcept override;
  Energy energy(double t, In q, In v) override;
  std::optional<Momentum> momentum(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  int count() const override { return points_->count(); }
  int before(int i) const override { return points_->before(i); }
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;
  std::optional<double> stretch(double t, In q) override;
  std::optional<Mean> mean(int point) override { return points_->mean(point); }
  std::optional<std::array<double, 9>> end_frame(double t, In q) override;
  bool accept(double t, InOut q, InOut v) override;
  bool carry(double t, InOut q, InOut v, InOut a) const override;
  std::string not_smooth() const override { return {}; }
  void reset() override { reference_ = at_start_; }
  std::vector<double> memory() const override;
  void recall(In memory) override;

  std::size_t edges() const { return reference_.size(); }
  /// Index of an edge's rotation vector here, and of its quaternion in the rod.
  std::size_t at(std::size_t edge) const { return first_ + 3 * edge; }
  std::size_t in_rod(std::size_t edge) const { return first_ + 4 * edge; }
  /// x of an edge in the rod, in components of its reference.
  Quaternion relative(In x, std::size_t edge) const;
  void couple(const Pattern& of_rod);
  // Place the rod at a state.
  void place(In q) noexcept;
  void place(In q, In v) noexcept;
  void place(In q, In v, In a) noexcept;
  /// Computes to = J^T from.
  void pull_back(In from, Out to) const noexcept;
  Status rod_values(double t, Weights w, Out s) noexcept;
  Status find_force(double t) noexcept;
  void find_slopes(In v, bool rates) noexcept;
  /// h += J^T S J of two groups of these sizes in the rod. `rates`: with the friction of
  /// J'.
  template <std::size_t rows, std::size_t columns>
  void add_product(const Coupled& pair, bool rates, double (&h)[3][3]) const noexcept;
  void add_curvature(std::size_t edge, In v, In a, Weights w, double (&h)[3][3]) noexcept;

  std::unique_ptr<System> rod_;
  // Forms of the rod.
  NaturalStrains* strains_;
  PointAccelerations* accelerations_;
  Sections* sections_;
  MaterialPoints* points_;
  std::size_t first_;  // coordinate of the first rotation vector
  double renewal_;     // length of c beyond which references are renewed
  std::vector<Quaternion> at_start_, reference_, replaced_;
  std::vector<double> inertia_;                   // of quaternions, per edge
  bool damped_ = false;                           // quaternions have friction
  std::vector<ConformalRotation> rotations_;      // of place()
  std::vector<double> q_, v_, a_, force_, free_;  // coordinates of the rod
  std::vector<double> origin_;        // of the last take_stresses(), of the rod
  std::optional<Stresses> stresses_;  // of the next matrix, if from there
  Pattern pattern_;
  std::vector<Coupled> coupled_;
  std::vector<Slopes> slopes_;
  std::vector<double> of_rod_, friction_;  // S of the rod and its dr/dv, and 0 at the end
  std::vector<double> values_;
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace tress::models
