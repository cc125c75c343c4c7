#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/joints/joint_end.h"
#include "models/supports/section_gap.h"

namespace tress::models {

/// Force and moment on the second end of a joint, world components. The first end has the
/// opposite ones.
struct JointLoad {
  Vec force;   // N
  Vec moment;  // N m, about the point of the second end
};

/// The equations of one joint of ends a and b. With x the places of the points and c the
/// rotation of the section of b from its place on that of a (SectionGap), its rows are
///
///     g = x_b - x_a   (ball, weld, hinge),      g = c_k   (weld: all k; hinge: two).
///
/// The place on a is that of the start. Elastic halves are natural where c = 0. A hinge
/// measures the angle between the axes that the two sections carry. Where an elastic half
/// edge lies before a section, both halves are one elastic joint with the stress of c, in
/// series, in place of rows of c:
///
///     stress = k c + d c',    1/k = 1/k_a + 1/k_b
///
/// as matrices in the frame of b at the start, in whose axes k is diagonal. A hinge has
/// no stress about its axis. A spring acts with F = k (1 - l/|x_b - x_a|)(x_b - x_a) and
/// a damper on the rate of the distance, or on that of x_b - x_a if l = 0.
class JointPair {
 public:
  /// `q`: the state of all strands at the start. Throws InputError naming `where` if the
  /// models do not admit the joint.
  JointPair(JointEnd a, JointEnd b, const Joint& joint, In q, const std::string& where);

  /// Returns the ends: 0 is a, 1 is b.
  JointEnd& end(int k) { return k == 0 ? a_ : b_; }
  /// Returns the number of constraints.
  int rows() const { return places() + static_cast<int>(components_.size()); }
  /// Returns true if a constraint is a rotation (rad), not a place (m).
  bool turns(int row) const { return row >= places(); }
  /// Returns the largest number of columns that add_couplings() appends.
  int couplings() const { return (spring_ ? 3 : 0) + (turning_ ? 3 : 0); }

  /// Evaluates g, (rows).
  void value(double t, In q, Out g);
  /// Evaluates g', (rows).
  void rate(double t, In q, In v, Out g);
  /// Evaluates g'' - G a, (rows).
  void bias(double t, In q, In v, Out g);
  /// Returns the rate of c, rad/s.
  Vec turning_rate(double t, In q, In v);
  /// b += G_k^T factor for constraint `row`.
  void add_gradient(double t, In q, int row, double factor, InOut b);

  /// Returns the load of springs and elastic halves, and of the multipliers (rows; none:
  /// empty).
  JointLoad load(double t, In q, In v, In lambda);
  /// b += J^T load, of both ends.
  void add_load(double t, In q, const JointLoad& load, InOut b);
  /// Returns the elastic energy, J.
  double energy(double t, In q);
  /// Returns the rate of the elastic energy, W.
  double energy_rate(double t, In q, In v);

  /// Makes write_couplings() exact, for derivatives of runs. `dt`: time in which the ends
  /// move a little.
  void be_exact(double dt) { dt_ = dt; }
  /// Derivative of the load by the motion, w.pos d/dq + w.vel d/dv, as U V^T: writes
  /// couplings() columns of both, so that S += U V^T. It leaves out derivatives of J at a
  /// constant load. Without be_exact() it also leaves out those of velocities by places,
  /// and bounds those of slack springs. The columns must be 0 before.
  void write_couplings(double t, In q, In v, In lambda, Weights w,
                       Eigen::Ref<Eigen::MatrixXd> u, Eigen::Ref<Eigen::MatrixXd> v_of);

 private:
  int places() const { return spring_ ? 0 : 3; }
  RootPose wall(double t, In q);
  RootPose wall(double t, In q, In v);
  SectionMotion section(double t, In q, In v);
  SectionGap gap(double t, In q) {
    return {measure_, wall(t, q), {b_.frame(t, q) * axes_, {}, {}}};
  }
  SectionGap gap(double t, In q, In v) {
    return {measure_, wall(t, q, v), section(t, q, v)};
  }
  Vec stress(const SectionGap& gap, In lambda) const;
  void hold(const Joint& joint, In q, const std::string& where);
  void add_force(double t, In q, const Vec& force, InOut b) {
    b_.add_force(t, q, force, b);
    a_.add_force(t, q, -1.0 * force, b);
  }
  void add_moment(double t, In q, const Vec& moment, InOut b) {
    b_.add_moment(t, q, moment, b);
    a_.add_moment(t, q, -1.0 * moment, b);
  }

  /// b += the derivative of add(t, q, load, b) along the motion.
  template <class Add>
  void add_drift(double t, In q, In v, const Vec& load, InOut b, const Add& add);
  Vec along_spring(const Vec& d, const Vec& u, const Vec& e, Weights w) const;

  JointEnd a_, b_;
  bool spring_;
  double stiffness_, damping_, rest_length_;  // of a spring
  bool turning_ = false;                      // the joint turns sections
  Sections::Turning measure_ = Sections::Turning::frame;
  std::vector<int> components_;  // of c, with rows
  Frame axes_;                   // in the section of b
  Frame to_wall_;                // the same axes in the section of a, at the start
  Vec elastic_, friction_;       // of c; 0: without half edges
  std::vector<double> zero_;
  double dt_ = 0;  // of be_exact()
  std::vector<double> moved_;
};

}  // namespace tress::models
