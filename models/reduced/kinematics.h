#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "models/math/pack.h"
#include "models/reduced/free_root.h"
#include "models/reduced/reduced_strand.h"
#include "models/reduced/shapes.h"
#include "models/strand/strand.h"
#include "models/system.h"

namespace tress {

/// Where everything is and how it moves, for unknowns q, v, a: one sweep from the root to
/// the free ends. What depends on q alone is kept and used again at the same q.
template <class Kernel, int dofs>
class Kinematics {
 public:
  template <class T>
  using Point = typename Kernel::template At<T>;

  struct BlockGeometry {
    Point<Pack> at;
    Vec3<Pack> position;
    std::array<Vec3<Pack>, dofs> slope;  // dP/dq_k
  };
  struct SegmentGeometry {
    Kernel kernel;
    Point<double> tip{};
    Vec position;  // of the tip
    Frame rotation;
    std::array<Vec, dofs> slope, turn;  // dP/dq_k and W e_k at the tip
  };
  struct SegmentMotion {
    FrameMotion tip;
    Vec rate, acceleration;                                      // kappa', kappa''
    decltype(Kernel().first(Vec())) moving;                      // P'
    decltype(Kernel().acceleration(Vec(), Vec())) accelerating;  // P''
    Vec velocity;                                                // P' at the tip
    Vec turning;                                                 // W kappa' at the tip
    Vec tip_v, tip_a, tip_alpha;  // of the tip, in the components of the start
  };

  Kinematics(std::vector<ReducedSegment> segments, std::vector<PointBlock> blocks,
             RootMotion root, std::optional<FreeRootFrame> free_root, double root_rotor)
      : segments_(std::move(segments)),
        blocks_(std::move(blocks)),
        root_motion_(std::move(root)),
        free_root_(std::move(free_root)),
        root_rotor_(root_rotor),
        geometry_(segments_.size()),
        block_geometry_(blocks_.size()),
        motion_(segments_.size()) {
    if (std::ranges::any_of(segments_, &ReducedSegment::mounted)) {
      mounted_.resize(segments_.size());
    }
  }

  int count() const { return static_cast<int>(segments_.size()); }
  int unknowns() const { return count() * dofs + (free_root_ ? 6 : 0); }
  const std::vector<ReducedSegment>& segments() const { return segments_; }
  const std::vector<PointBlock>& blocks() const { return blocks_; }
  const SegmentGeometry& geometry(std::size_t i) const { return geometry_[i]; }
  const BlockGeometry& block_geometry(std::size_t b) const { return block_geometry_[b]; }
  const SegmentMotion& motion(std::size_t i) const { return motion_[i]; }
  const FrameMotion& start(std::size_t i) const {
    const ReducedSegment& segment = segments_[i];
    return segment.mounted ? mounted_[i] : parent_tip(segment);
  }
  const FrameMotion& root() const { return root_; }
  bool free() const { return free_root_.has_value(); }
  FreeRootFrame& free_root() { return *free_root_; }
  const FreeRootFrame& free_root() const { return *free_root_; }
  double root_rotor() const { return root_rotor_; }  // of a free root, kg m^2
  bool moving_root() const { return !free_root_ && !root_motion_.fixed(); }

  /// The unknowns of a segment as a vector (twist, curvature 1, curvature 2); components
  /// that are not unknowns are 0.
  static Vec components(In x, std::size_t i) {
    const double* p = &x[dofs * i];
    if constexpr (dofs == 3) return {p[0], p[1], p[2]};
    if constexpr (dofs == 2) return {0, p[0], p[1]};
    return {0, p[0], 0};
  }
  static Vec unit(int k) {
    const int component = Space<dofs>::component(k);
    return {component == 0 ? 1.0 : 0, component == 1 ? 1.0 : 0, component == 2 ? 1.0 : 0};
  }

  /// Shapes of all segments at q, and the place of a free root.
  void shape(In q) {
    if (free_root_) free_root_->place(q.last(6));
    if (std::ranges::equal(q, shaped_)) return;
    for (std::size_t i = 0; i < segments_.size(); ++i) shape_segment(i, q);
    shaped_.assign(q.begin(), q.end());
  }

  /// Accelerations are from now on relative to a frame that falls with this one (m/s^2):
  /// inertial forces then hold the uniform load, at no cost.
  void fall(const Vec& acceleration) { falling_ = acceleration; }

  /// Frames and their motion; calls shape().
  void move(double t, In q, In v, In a) {
    shape(q);
    root_ = free_root_ ? free_root_->motion(q.last(6), v.last(6), a.last(6))
                       : clamped(root_motion_.at(t));
    root_.a = root_.a - root_.frame.back(falling_);
    for (std::size_t i = 0; i < segments_.size(); ++i) move_segment(i, v, a);
  }

  /// The position of a segment's points and their velocity, world components; after
  /// move().
  Vec3<Pack> world(std::size_t i, const Vec3<Pack>& x) const {
    const Frame& f = start(i).frame;
    return x.x * Vec3<Pack>(f.e0) + x.y * Vec3<Pack>(f.e1) + x.z * Vec3<Pack>(f.e2);
  }
  Vec3<Pack> velocity(std::size_t i, std::size_t block) const {
    const FrameMotion& from = start(i);
    const BlockGeometry& b = block_geometry_[block];
    return Vec3<Pack>(from.v) + cross(Vec3<Pack>(from.omega), b.position) +
           motion_[i].moving.at(b.at);
  }

 private:
  static FrameMotion clamped(const RootPose& pose) {
    const Frame& f = pose.frame;
    return {f,
            pose.x,
            f.back(pose.v),
            f.back(pose.omega),
            f.back(pose.a),
            f.back(pose.alpha)};
  }

  void shape_segment(std::size_t i, In q) {
    const ReducedSegment& segment = segments_[i];
    SegmentGeometry& g = geometry_[i];
    g.kernel = Kernel(segment.held + components(q, i), segment.length);
    const auto position = g.kernel.position();
    g.tip = g.kernel.tip();
    g.position = position.at(g.tip);
    g.rotation = g.kernel.rotation(g.tip);
    std::array<decltype(g.kernel.first(Vec{})), dofs> slope;
    for (int k = 0; k < dofs; ++k) {
      slope[k] = g.kernel.first(unit(k));
      g.slope[k] = slope[k].at(g.tip);
      g.turn[k] = g.kernel.W(unit(k)).at(g.tip);
    }
    for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
      BlockGeometry& block = block_geometry_[b];
      block.at = g.kernel.point(blocks_[b].s);
      block.position = position.at(block.at);
      for (int k = 0; k < dofs; ++k) block.slope[k] = slope[k].at(block.at);
    }
  }

  void move_segment(std::size_t i, In v, In a) {
    const ReducedSegment& segment = segments_[i];
    const SegmentGeometry& g = geometry_[i];
    SegmentMotion& m = motion_[i];
    if (segment.mounted) mount(i);
    const FrameMotion& from = start(i);
    m.rate = components(v, i);
    m.acceleration = components(a, i);

    const Vec omega = from.omega, alpha = from.alpha;
    m.velocity = Vec{};
    m.moving = g.kernel.first(m.rate);
    m.accelerating = g.kernel.acceleration(m.rate, m.acceleration);
    Vec turning_bias = g.kernel.dW(m.rate, m.rate).at(g.tip);
    m.turning = Vec{};
    for (int k = 0; k < dofs; ++k) {
      const double rate = dot(unit(k), m.rate), second = dot(unit(k), m.acceleration);
      m.velocity = m.velocity + rate * g.slope[k];
      m.turning = m.turning + rate * g.turn[k];
      turning_bias = turning_bias + second * g.turn[k];
    }
    m.tip_v = from.v + cross(omega, g.position) + m.velocity;
    m.tip_a = from.a + cross(alpha, g.position) + m.accelerating.at(g.tip) +
              cross(omega, cross(omega, g.position) + 2.0 * m.velocity);
    m.tip_alpha = alpha + turning_bias + cross(omega, m.turning);

    m.tip.frame = from.frame * g.rotation;
    m.tip.x = from.x + from.frame * g.position;
    m.tip.v = g.rotation.back(m.tip_v);
    m.tip.omega = g.rotation.back(omega + m.turning);
    m.tip.a = g.rotation.back(m.tip_a);
    m.tip.alpha = g.rotation.back(m.tip_alpha);
  }

  const FrameMotion& parent_tip(const ReducedSegment& segment) const {
    return segment.parent < 0 ? root_
                              : motion_[static_cast<std::size_t>(segment.parent)].tip;
  }
  void mount(std::size_t i) {
    const ReducedSegment& segment = segments_[i];
    FrameMotion& m = mounted_[i];
    m = parent_tip(segment);
    m.frame = m.frame * segment.mount;
    for (Vec* x : {&m.v, &m.omega, &m.a, &m.alpha}) *x = segment.mount.back(*x);
  }

  std::vector<ReducedSegment> segments_;
  std::vector<PointBlock> blocks_;
  RootMotion root_motion_;
  std::optional<FreeRootFrame> free_root_;
  double root_rotor_;
  std::vector<SegmentGeometry> geometry_;
  std::vector<BlockGeometry> block_geometry_;
  std::vector<SegmentMotion> motion_;
  std::vector<FrameMotion> mounted_;  // starts of mounted segments
  FrameMotion root_;
  Vec falling_;
  std::vector<double> shaped_;  // the q of geometry_
};

}  // namespace tress
