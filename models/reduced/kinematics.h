#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "contract/basics.h"
#include "math/lanes.h"
#include "models/reduced/free_root.h"
#include "models/reduced/reduced_strand.h"
#include "models/reduced/tree/shapes.h"
#include "models/strand/strand.h"

namespace tress::models {

/// The rule by which a kernel without closed forms integrates; std::monostate for others.
template <class Kernel>
struct RuleOf {
  using Type = std::monostate;  // no rule
};
/// The rule of a kernel that has one.
template <class Kernel>
requires requires { typename Kernel::Rule; }
struct RuleOf<Kernel> {
  using Type = typename Kernel::Rule;  // rule of the kernel
};

/// Positions and motion of all frames for unknowns q, v, a: one sweep from the root to
/// the free ends. Quantities that depend on q only are kept and reused at the same q.
template <class Kernel, int modes>
class Kinematics {
  using Strain = typename Kernel::Strain;
  using FrameMotion = FrameMotionOf<typename Kernel::Real>;
  template <class T>
  using Point = typename Kernel::template At<T>;

 public:
  using Real = typename Kernel::Real;        // scalar: a number, or a pack of SIMD lanes
  using Vec = Vec3<Real>;                    // vector of scalars
  using Frame = FrameOf<Real>;               // frame of scalars
  using In = std::span<const Real>;          // read-only array of scalars
  using Segment = ReducedSegmentOf<Strain>;  // segment as prepared, with its strains
  static constexpr int dofs = modes * Kernel::functions;  // unknowns of a segment

  /// Quantities at a block of points that depend on q only.
  struct BlockGeometry {
    Point<Pack> at;                      // places on the segment
    Vec3<Pack> position;                 // positions, seen from the segment's start
    std::array<Vec3<Pack>, dofs> slope;  // dP/dq_k
  };
  /// Quantities of a segment that depend on q only.
  struct SegmentGeometry {
    Kernel kernel;                      // shape of the segment
    Point<Real> tip{};                  // place of the tip
    Vec position;                       // position of the tip, seen from the start
    Frame rotation;                     // frame of the tip in that of the start
    std::array<Vec, dofs> slope, turn;  // dP/dq_k and W e_k at the tip
  };
  /// Motion of a segment.
  struct SegmentMotion {
    FrameMotion tip;                            // motion of the tip's frame
    Strain rate, acceleration;                  // kappa', kappa''
    decltype(Kernel().first(Strain())) moving;  // P'
    decltype(Kernel().acceleration(Strain(), Strain())) accelerating;  // P''
    Vec velocity;                                                      // P' at the tip
    Vec turning;                  // W kappa' at the tip
    Vec tip_v, tip_a, tip_alpha;  // motion of the tip, in the components of the start
  };

  /// Takes the parts of a ReducedStrand. `free_root`: none if the root moves as `root`;
  /// `root_rotor`: inertia about the tangent at the root, kg m^2.
  Kinematics(const std::vector<ReducedSegment>& segments, std::vector<PointBlock> blocks,
             RootMotion root, const std::optional<FreeRootFrame>& free_root,
             const Real& root_rotor)
      : segments_(segments.begin(), segments.end()),
        blocks_(std::move(blocks)),
        rule_(rule_of(segments_.front(), blocks_)),
        root_motion_(std::move(root)),
        free_root_(free_root),
        root_rotor_(root_rotor),
        geometry_(segments_.size()),
        block_geometry_(blocks_.size()),
        motion_(segments_.size()) {
    if (std::ranges::any_of(segments_, &Segment::mounted)) {
      mounted_.resize(segments_.size());
    }
  }

  /// Returns the number of segments.
  int count() const { return static_cast<int>(segments_.size()); }
  /// Returns the number of unknowns, a free root's included.
  int unknowns() const { return count() * dofs + (free_root_ ? 6 : 0); }
  /// Returns the segments, parents before children.
  const std::vector<Segment>& segments() const { return segments_; }
  /// Returns the blocks of quadrature points of all segments.
  const std::vector<PointBlock>& blocks() const { return blocks_; }
  /// Sets the unknowns of segment i at rest; other components are 0.
  void set_rest(std::size_t i, const Strain& rest) { segments_[i].rest = rest; }
  /// Returns the geometry of segment i at the q of the last shape().
  const SegmentGeometry& geometry(std::size_t i) const { return geometry_[i]; }
  /// Returns the geometry of block b at the q of the last shape().
  const BlockGeometry& block_geometry(std::size_t b) const { return block_geometry_[b]; }
  /// Returns the motion of segment i in the last move().
  const SegmentMotion& motion(std::size_t i) const { return motion_[i]; }
  /// Returns the motion of the frame at the start of segment i in the last move().
  const FrameMotion& start(std::size_t i) const {
    const Segment& segment = segments_[i];
    return segment.mounted ? mounted_[i] : parent_tip(segment);
  }
  /// Returns the motion of the root in the last move().
  const FrameMotion& root() const { return root_; }
  /// Whether the strand has no branches.
  bool is_chain() const {
    int before = -1;
    return std::ranges::all_of(segments_, [&before](const Segment& segment) {
      return segment.parent == before++;
    });
  }
  /// Returns true if the root moves freely.
  bool free() const { return free_root_.has_value(); }
  /// Returns the free root, which must exist: see free().
  FreeRootFrame& free_root() { return *free_root_; }
  /// Returns the free root, which must exist: see free().
  const FreeRootFrame& free_root() const { return *free_root_; }
  /// Returns the inertia of the rotor at the root, kg m^2.
  const Real& root_rotor() const { return root_rotor_; }
  /// Returns true if the root is clamped and the clamp moves.
  bool moving_root() const { return !free_root_ && !root_motion_.fixed(); }

  /// Returns the first breakpoint of the clamp after t (s), or infinity.
  double next_breakpoint(double t) const { return root_motion_.next_breakpoint(t); }
  /// Returns the first teleport of the clamp after t, or infinity.
  double next_teleport(double t) const { return root_motion_.next_teleport(t); }
  /// Moves the clamp as after the teleport at t (Teleports::follow).
  void follow(double t) {
    root_motion_.since = t;
    posed_at_ = std::numeric_limits<double>::quiet_NaN();
  }
  /// Returns the last teleport of the clamp that was carried out, or by_time.
  double since() const { return root_motion_.since; }

  /// Returns the size of arrays over points, including those that only fill a block.
  std::size_t points() const { return first_point(blocks_.size()); }
  /// Returns the index of a block's first point.
  static std::size_t first_point(std::size_t block) { return Pack::lanes * block; }

  /// Returns the unknowns of segment i in x as a strain, vectors of (twist, curvature 1,
  /// curvature 2); components that are not unknowns are 0.
  static Strain components(In x, std::size_t i) {
    const Real* p = &x[dofs * i];
    if constexpr (Kernel::functions == 2) {
      return {of_function(p), of_function(p + modes)};
    } else {
      return of_function(p);
    }
  }
  /// Returns the strain of a segment whose unknown k is 1 and all others 0.
  static Strain unit(int k) {
    const auto axis = [](int mode) {
      return Vec(Space<modes>::axis(Space<modes>::component(mode)));
    };
    if constexpr (Kernel::functions == 2) {
      return k < modes ? Strain{axis(k), {}} : Strain{{}, axis(k - modes)};
    } else {
      return axis(k);
    }
  }

  /// Shapes of all segments at q, and the position of a free root.
  void shape(In q) {
    if (free_root_) free_root_->place(q.last(6));
    const bool first = shaped_.size() != q.size();
    if (first) shaped_.assign(q.begin(), q.end());
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      const auto own = q.subspan(dofs * i, dofs);
      const auto known = std::span(shaped_).subspan(dofs * i, dofs);
      if (!first && std::ranges::equal(own, known)) continue;
      shape_segment(i, q);
      std::ranges::copy(own, known.begin());
    }
  }

  /// The frame at the tip of the last segment, without the rest of move().
  Frame last_frame(double t, In q) {
    shape(q);
    Frame frame;
    for (int i = count() - 1; i >= 0;) {
      const auto at = static_cast<std::size_t>(i);
      frame = geometry_[at].rotation * frame;
      if (segments_[at].mounted) frame = segments_[at].mount * frame;
      i = segments_[at].parent;
    }
    return (free_root_ ? free_root_->frame() : root_motion_.at(t).frame) * frame;
  }

  /// Position and motion of a tip; v and omega in the components of its frame.
  struct Tip {
    Frame frame;      // frame of the tip
    Vec x, v, omega;  // position in the world (m); velocity, angular velocity
  };
  /// The root and the tips of all segments, without what only move() needs; at rest:
  /// without v and omega. A function of its arguments alone, whatever was computed
  /// before.
  template <bool at_rest = false>
  const std::vector<Tip>& tips(double t, In q, In v) {
    if (free_root_) free_root_->place(q.last(6));
    if constexpr (collocated) shape(q);
    const FrameMotion root = root_motion(t, q, v, v);
    tips_.resize(segments_.size() + 1);
    tips_[0] = {root.frame, root.x, root.v, root.omega};
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      const Segment& segment = segments_[i];
      const Tip& parent = tips_[static_cast<std::size_t>(segment.parent + 1)];
      const Frame start = segment.mounted ? parent.frame * segment.mount : parent.frame;
      const auto& kernel = read_kernel(segment, q, i);
      const auto tip = kernel.tip();
      const Vec position = kernel.position().at(tip);
      const Frame rotation = kernel.rotation(tip);
      Tip& to = tips_[i + 1];
      to.frame = start * rotation;
      to.x = parent.x + start * position;
      if constexpr (at_rest) continue;
      Vec from_v = parent.v, from_omega = parent.omega;
      if (segment.mounted) {
        from_v = segment.mount.back(from_v);
        from_omega = segment.mount.back(from_omega);
      }
      const Strain rate = components(v, i);
      to.v = rotation.back(from_v + cross(from_omega, position) +
                           kernel.first(rate).at(tip));
      to.omega = rotation.back(from_omega + kernel.W(rate).at(tip));
    }
    return tips_;
  }

  /// Frames of the root and of the tips of all segments; calls shape().
  const std::vector<Frame>& frames(double t, In q) {
    shape(q);
    frames_.resize(segments_.size() + 1);
    frames_[0] = root_frame(t, q);
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      const Segment& segment = segments_[i];
      const Frame& parent = frames_[static_cast<std::size_t>(segment.parent + 1)];
      frames_[i + 1] =
          (segment.mounted ? parent * segment.mount : parent) * geometry_[i].rotation;
    }
    return frames_;
  }

  /// Measures accelerations relative to a frame that falls with this one (m/s^2) from now
  /// on: inertial forces then include the uniform load at no cost.
  void fall(const Vec& acceleration) { falling_ = acceleration; }

  /// Returns the motion of a clamped root relative to free fall, as move() computes it.
  FrameMotion clamp(double t) {
    FrameMotion root = root_motion(t, {}, {}, {});
    root.a = root.a - root.frame.back(falling_);
    return root;
  }

  /// Frames and their motion; calls shape().
  void move(double t, In q, In v, In a) {
    shape(q);
    root_ = root_motion(t, q, v, a);
    root_.a = root_.a - root_.frame.back(falling_);
    for (std::size_t i = 0; i < segments_.size(); ++i) move_segment(i, v, a);
  }

  /// The position of a segment's points and their velocity, world components; after
  /// move().
  Vec3<Pack> world(std::size_t i, const Vec3<Pack>& x) const {
    const Frame& f = start(i).frame;
    return x.x * Vec3<Pack>(f.e0) + x.y * Vec3<Pack>(f.e1) + x.z * Vec3<Pack>(f.e2);
  }
  /// Returns the velocities of a block of points, in the components of the segment's
  /// start.
  Vec3<Pack> velocity(std::size_t i, std::size_t block) const {
    const FrameMotion& from = start(i);
    const BlockGeometry& b = block_geometry_[block];
    return Vec3<Pack>(from.v) + cross(Vec3<Pack>(from.omega), b.position) +
           motion_[i].moving.at(b.at);
  }

 private:
  // A rule is on the points of a segment, the same for all segments.
  using Rule = typename RuleOf<Kernel>::Type;
  static constexpr bool collocated = !std::same_as<Rule, std::monostate>;
  static Rule rule_of(const Segment& segment, const std::vector<PointBlock>& blocks) {
    if constexpr (collocated) {
      return Rule(std::span(blocks).subspan(segment.first_block,
                                            segment.last_block - segment.first_block),
                  segment.length);
    } else {
      return {};
    }
  }
  Kernel bent(const Segment& segment, In q, std::size_t i) const {
    if constexpr (collocated) {
      return Kernel(segment.held + components(q, i), segment.length, rule_);
    } else {
      return Kernel(segment.held + components(q, i), segment.length);
    }
  }

  /// Returns the shape that tips() reads. Expensive shapes are kept for the next call.
  decltype(auto) read_kernel(const Segment& segment, In q, std::size_t i) const {
    if constexpr (collocated) {
      return (geometry_[i].kernel);
    } else {
      return bent(segment, q, i);
    }
  }

  static Vec of_function(const Real* p) {
    if constexpr (modes == 3) return {p[0], p[1], p[2]};
    if constexpr (modes == 2) return {Real(0), p[0], p[1]};
    return {Real(0), p[0], Real(0)};
  }

  Frame root_frame(double t, In q) {
    if (free_root_) return free_root_->frame();
    return root_motion(t, q, q, q).frame;
  }
  FrameMotion root_motion(double t, In q, In v, In a) {
    if (free_root_) return free_root_->motion(q.last(6), v.last(6), a.last(6));
    // Several calls of a step are at one time.
    if (t == posed_at_) return posed_;
    posed_at_ = t;
    const RootPose pose = root_motion_.at(t);
    const Frame& f = pose.frame;
    posed_ = {f,
              pose.x,
              f.back(pose.v),
              f.back(pose.omega),
              f.back(pose.a),
              f.back(pose.alpha)};
    return posed_;
  }

  void shape_segment(std::size_t i, In q) {
    const Segment& segment = segments_[i];
    SegmentGeometry& g = geometry_[i];
    g.kernel = bent(segment, q, i);
    const auto position = g.kernel.position();
    g.tip = g.kernel.tip();
    g.position = position.at(g.tip);
    g.rotation = g.kernel.rotation(g.tip);
    std::array<decltype(g.kernel.first(Strain{})), Kernel::functions == 2 ? 0 : dofs>
        slope;
    const auto slope_of = [&]([[maybe_unused]] std::size_t k) -> const auto& {
      if constexpr (Kernel::functions == 2) {
        return g.kernel.slope_of(static_cast<int>(k));
      } else {
        return slope[k];
      }
    };
    for (std::size_t k = 0; k < dofs; ++k) {
      const auto direction = static_cast<int>(k);
      if constexpr (Kernel::functions == 2) {
        g.turn[k] = g.kernel.turn_of(direction).at(g.tip);
      } else {
        slope[k] = g.kernel.first(unit(direction));
        g.turn[k] = g.kernel.W(unit(direction)).at(g.tip);
      }
      g.slope[k] = slope_of(k).at(g.tip);
    }
    for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
      BlockGeometry& block = block_geometry_[b];
      if constexpr (collocated) {
        block.at = g.kernel.point(static_cast<int>(b - segment.first_block));
      } else {
        block.at = g.kernel.point(blocks_[b].s);
      }
      block.position = position.at(block.at);
      for (std::size_t k = 0; k < dofs; ++k) block.slope[k] = slope_of(k).at(block.at);
    }
  }

  void move_segment(std::size_t i, In v, In a) {
    const Segment& segment = segments_[i];
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
    for (std::size_t k = 0; k < dofs; ++k) {
      const Real rate = v[dofs * i + k], second = a[dofs * i + k];
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

  const FrameMotion& parent_tip(const Segment& segment) const {
    return segment.parent < 0 ? root_
                              : motion_[static_cast<std::size_t>(segment.parent)].tip;
  }
  void mount(std::size_t i) {
    const Segment& segment = segments_[i];
    FrameMotion& m = mounted_[i];
    m = parent_tip(segment);
    m.frame = m.frame * segment.mount;
    for (Vec* x : {&m.v, &m.omega, &m.a, &m.alpha}) *x = segment.mount.back(*x);
  }

  std::vector<Segment> segments_;
  std::vector<PointBlock> blocks_;
  [[no_unique_address]] Rule rule_;
  RootMotion root_motion_;
  std::optional<FreeRootFrame> free_root_;
  Real root_rotor_;
  std::vector<SegmentGeometry> geometry_;
  std::vector<BlockGeometry> block_geometry_;
  std::vector<SegmentMotion> motion_;
  std::vector<FrameMotion> mounted_;  // starts of mounted segments
  FrameMotion root_;
  double posed_at_ = std::numeric_limits<double>::quiet_NaN();
  FrameMotion posed_;  // of a prescribed root, then
  std::vector<Tip> tips_;
  std::vector<Frame> frames_;
  Vec falling_;
  std::vector<Real> shaped_;  // q of geometry_
};

}  // namespace tress::models
