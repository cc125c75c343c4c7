#pragma once

#include <span>
#include <vector>

#include "models/strand/rod_joint.h"

namespace tress::models {

/// Clamped rod discretised for kirchhoff_nodal.cpp: n edges between nodes 0 (at the
/// clamp) to n. Joint j turns edge j relative to edge j - 1, joint 0 relative to the
/// clamp.
struct StaggeredRod {
  std::vector<double> length;    // per edge, m
  std::vector<double> rotor;     // per edge, inertia about the tangent, kg m^2
  std::vector<double> mass;      // per node, kg
  std::vector<double> arc;       // arc length per joint, m
  std::vector<RodJoint> joints;  // joints, each before the edge of its number

  /// Returns the number of edges.
  std::size_t edges() const { return length.size(); }
};

/// A constant times a vector, at a third of the cost of a product of derivative numbers.
template <class T>
Vec3<T> scaled(double s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

/// cay(phi) in the components of the frame that it turns, with c of kirchhoff_nodal.cpp:
/// (1 - c |phi|^2/2) + c [phi]x + c phi phi^T/2.
template <class T>
FrameOf<T> cayley(const Vec3<T>& phi, const T& c) {
  const Vec3<T> u = (0.5 * c) * phi, w = scaled(2, u);
  const T xy = u.x * phi.y, xz = u.x * phi.z, yz = u.y * phi.z;
  const T xx = u.x * phi.x, yy = u.y * phi.y, zz = u.z * phi.z;
  return {{T(1) - yy - zz, xy + w.z, xz - w.y},
          {xy - w.z, T(1) - xx - zz, yz + w.x},
          {xz + w.y, yz - w.x, T(1) - xx - yy}};
}

/// Motion of a StaggeredRod for joint curvatures q (1/m; twist, curvature about e1, about
/// e2) and their rates; equations in kirchhoff_nodal.cpp. T is double or a derivative
/// number. O(n).
template <class T>
class StaggeredMotion {
 public:
  /// Allocates for a rod.
  explicit StaggeredMotion(const StaggeredRod& rod)
      : x(rod.mass.size()),
        v(x.size()),
        load(x.size()),
        edges_(rod.edges()),
        joints_(rod.edges()),
        rows_(rod.edges()),
        force_(x.size()),
        acceleration_(x.size()) {}

  /// Computes frames, positions and velocities of a state.
  void place(const StaggeredRod& rod, const RootPose& root, std::span<const T> q,
             std::span<const T> rate) noexcept;
  /// Call after `place`, with `load` of the nodes set.
  void accelerate(const StaggeredRod& rod, const RootPose& root, std::span<T> a) noexcept;

  /// Returns the tangent of an edge.
  const Vec3<T>& tangent(std::size_t edge) const { return edges_[edge].frame.e0; }
  /// Returns the rate at which an edge rolls about its tangent.
  const T& roll(std::size_t edge) const { return edges_[edge].roll; }
  /// Returns the strain of a joint.
  const Vec3<T>& strain(std::size_t joint) const { return joints_[joint].strain; }
  /// Returns the strain rate of a joint.
  const Vec3<T>& strain_rate(std::size_t joint) const { return joints_[joint].rate; }
  /// After `accelerate`: force of the first edge on the clamp, and its moment in the
  /// clamp's frame.
  const Vec3<T>& root_force() const { return force_.front(); }
  /// Returns the moment of the first edge on the clamp, N m.
  Vec3<T> root_moment() const { return moment(joints_.front(), 0.5); }

  std::vector<Vec3<T>> x, v;  // nodes: m, m/s; set by `place`
  std::vector<Vec3<T>> load;  // nodes, N

 private:
  struct Edge {
    FrameOf<T> frame;
    Vec3<T> spin, turning;  // omega and t', rad/s
    T roll;                 // omega . t
    T twisting;             // omega' . t
  };
  struct Joint {
    Vec3<T> strain, rate;  // phi and phi'
    Vec3<T> turn;          // omega_j - omega_{j-1} in the frame before
    T c;                   // 1/(1 + |phi|^2/4)
    Vec3<T> stress;
  };
  struct Row {
    T lower, diagonal, right;  // of the equations of the tension; symmetric
  };

  /// The joint's moment in the components of the frame before it (half = 1/2) or behind
  /// it (-1/2).
  static Vec3<T> moment(const Joint& joint, double half) {
    const Vec3<T>& phi = joint.strain;
    return joint.stress + scaled(half, cross(phi, joint.stress)) +
           (0.25 * dot(phi, joint.stress)) * phi;
  }
  static FrameOf<T> frame_of(const RootPose& root) {
    return {Vec3<T>(root.frame.e0), Vec3<T>(root.frame.e1), Vec3<T>(root.frame.e2)};
  }
  void shear(const StaggeredRod& rod) noexcept;
  void tension(const StaggeredRod& rod) noexcept;

  std::vector<Edge> edges_;
  std::vector<Joint> joints_;
  std::vector<Row> rows_;
  std::vector<Vec3<T>> force_;         // edges, 0 beyond the last
  std::vector<Vec3<T>> acceleration_;  // nodes
};

template <class T>
void StaggeredMotion<T>::place(const StaggeredRod& rod, const RootPose& root,
                               std::span<const T> q, std::span<const T> rate) noexcept {
  FrameOf<T> frame = frame_of(root);
  Vec3<T> spin(root.omega);
  x[0] = Vec3<T>(root.x);
  v[0] = Vec3<T>(root.v);
  for (std::size_t j = 0; j < edges_.size(); ++j) {
    Joint& joint = joints_[j];
    Edge& edge = edges_[j];
    const Vec3<T> phi = joint.strain = scaled(rod.arc[j], load3(&q[3 * j]));
    joint.rate = scaled(rod.arc[j], load3(&rate[3 * j]));
    joint.c = T(1) / (1.0 + 0.25 * dot(phi, phi));
    joint.turn = joint.c * (joint.rate + scaled(0.5, cross(phi, joint.rate)));
    spin = spin + frame * joint.turn;
    frame = frame * cayley(phi, joint.c);
    edge.frame = frame;
    edge.spin = spin;
    edge.turning = cross(spin, frame.e0);
    edge.roll = dot(spin, frame.e0);
    x[j + 1] = x[j] + scaled(rod.length[j], frame.e0);
    v[j + 1] = v[j] + scaled(rod.length[j], edge.turning);
  }
}

/// Transverse forces of the edges and rotation about them from the balance of moments.
template <class T>
void StaggeredMotion<T>::shear(const StaggeredRod& rod) noexcept {
  const auto times = [](const Vec& k, const Vec3<T>& y) {
    return Vec3<T>{k.x * y.x, k.y * y.y, k.z * y.z};
  };
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const RodJoint& law = rod.joints[j];
    Joint& joint = joints_[j];
    joint.stress = times(law.stiffness, joint.strain - Vec3<T>(law.rest)) +
                   times(law.friction, joint.rate);
  }
  for (std::size_t j = 0; j < edges_.size(); ++j) {
    Edge& edge = edges_[j];
    // In the edge's own frame, moments of neighbours are nearly equal, and their
    // difference loses no digits to a rotation.
    Vec3<T> gain = scaled(-1, moment(joints_[j], -0.5));
    if (j + 1 < edges_.size()) gain = gain + moment(joints_[j + 1], 0.5);
    edge.twisting = (1 / rod.rotor[j]) * gain.x;
    const Vec3<T> gyroscopic =
        (rod.rotor[j] * edge.roll) * cross(edge.frame.e0, edge.turning);
    force_[j] = scaled(1 / rod.length[j],
                       gain.y * edge.frame.e2 - gain.z * edge.frame.e1 - gyroscopic);
  }
}

/// Adds the tension to the forces, and its contribution to the accelerations.
template <class T>
void StaggeredMotion<T>::tension(const StaggeredRod& rod) noexcept {
  const std::size_t n = edges_.size();
  for (std::size_t j = 0; j < n; ++j) {
    const Edge& edge = edges_[j];
    Row& row = rows_[j];
    row.diagonal = T(1 / rod.mass[j + 1]);
    row.right = rod.length[j] * dot(edge.turning, edge.turning) +
                dot(edge.frame.e0, acceleration_[j + 1] - acceleration_[j]);
    row.lower = T(0);
    if (j > 0) {
      const double mobility = 1 / rod.mass[j];
      row.diagonal += T(mobility);
      row.lower = -mobility * dot(edge.frame.e0, edges_[j - 1].frame.e0);
      const T factor = row.lower / rows_[j - 1].diagonal;
      row.diagonal -= factor * row.lower;
      row.right -= factor * rows_[j - 1].right;
    }
  }
  T behind(0), coupling(0);
  for (std::size_t j = n; j-- > 0;) {
    behind = (rows_[j].right - coupling * behind) / rows_[j].diagonal;
    coupling = rows_[j].lower;
    const Vec3<T> pull = behind * edges_[j].frame.e0;
    force_[j] = force_[j] + pull;
    acceleration_[j + 1] = acceleration_[j + 1] - scaled(1 / rod.mass[j + 1], pull);
    if (j > 0) acceleration_[j] = acceleration_[j] + scaled(1 / rod.mass[j], pull);
  }
}

template <class T>
void StaggeredMotion<T>::accelerate(const StaggeredRod& rod, const RootPose& root,
                                    std::span<T> a) noexcept {
  const std::size_t n = edges_.size();
  shear(rod);
  acceleration_[0] = Vec3<T>(root.a);
  for (std::size_t i = 1; i <= n; ++i) {
    acceleration_[i] = scaled(1 / rod.mass[i], force_[i] - force_[i - 1] + load[i]);
  }
  tension(rod);
  FrameOf<T> frame = frame_of(root);
  Vec3<T> spin(root.omega), spinning(root.alpha);
  for (std::size_t j = 0; j < n; ++j) {
    const Edge& edge = edges_[j];
    const Joint& joint = joints_[j];
    const Vec3<T> bending =
        scaled(1 / rod.length[j], acceleration_[j + 1] - acceleration_[j]);
    const Vec3<T> next = cross(edge.frame.e0, bending) + edge.roll * edge.turning +
                         edge.twisting * edge.frame.e0;
    const Vec3<T>& phi = joint.strain;
    const Vec3<T> y = frame.back(next - spinning - cross(spin, edge.spin)) +
                      (0.5 * joint.c * dot(phi, joint.rate)) * joint.turn;
    const Vec3<T> strain = y - scaled(0.5, cross(phi, y)) + (0.25 * dot(phi, y)) * phi;
    store3(scaled(1 / rod.arc[j], strain), &a[3 * j]);
    frame = edge.frame;
    spin = edge.spin;
    spinning = next;
  }
}

}  // namespace tress::models
