#pragma once

#include <array>
#include <utility>

#include "models/reduced/inverse_dynamics.h"
#include "models/reduced/mass_tangent.h"
#include "models/reduced/point_matrix.h"

namespace tress::models {

/// All derivatives of the residual of one segment (InverseDynamics), at the motion held
/// by Kinematics. States are variations of a frame in its own components: displacement
/// (d, phi), then of its velocity (v, omega) and acceleration (a, alpha). With C the
/// rotation to the tip, theta the rotation of the tip due to the unknowns, c a point's
/// acceleration and f its load,
///
///     d(C^T y) = C^T (dy + y x theta),    dF = m dc + phi x f - df
///
/// The Kernel provides the derivatives of shapes. O(1) per segment.
template <class Kernel, int modes>
class ExactTangent {
  using Shape = ExactShapeOf<Kernel, modes>;

 public:
  /// df/dx, df/dv and df/dtangent of the effects at the points, (9) row-major each; empty
  /// if no effect has derivatives.
  struct EffectBlocks {
    In position, velocity, direction;  // df/dx, df/dv and df/dtangent
  };

  /// Reads kinematics and dynamics, which must outlive it.
  ExactTangent(const Kinematics<Kernel, modes>& kinematics,
               const InverseDynamics<Kernel, modes>& dynamics)
      : kinematics_(kinematics), dynamics_(dynamics) {}

  /// Writes the derivatives of segment i for weights w. Expects zeros in tip and in the
  /// zero blocks of transfer (see SegmentTangent).
  void segment(std::size_t i, Weights w, const EffectBlocks& effects,
               SegmentTangent<Shape>& tangent) const {
    const auto& segment = kinematics_.segments()[i];
    tangent.local.setZero();
    const Derivatives derivatives(kinematics_.geometry(i).kernel, kinematics_.motion(i));
    points(i, w, effects, derivatives, tangent);
    tip(i, w, derivatives, tangent);
    for (int k = 0; k < dofs; ++k) {
      tangent.stiffness[k] = dot(K::unit(k), restoring(segment, w));
      tangent.local(size + k, 3 * size + k) += tangent.stiffness[k];
      if constexpr (Kernel::functions == 2) {
        tangent.local(size + k, 3 * size + k) += w.acc * dot(K::unit(k), segment.inertia);
      }
    }
    const Vec& omega = kinematics_.motion(i).tip.omega;
    if constexpr (modes == 1) {
      // The moment about e1 is I omega_x omega_z, by in_plane() I (omega_x^2 -
      // omega_z^2).
      const Vec turned = in_plane(omega, Frames::axis(S::rotation[0]));
      tangent.tip(t, t) = segment.rotor * (turned.x * omega.z + omega.x * turned.z);
    } else {
      rotor(segment.rotor, omega, tangent.tip);
      if (segment.mounted) Frames::mount(segment.mount, tangent);
    }
  }

  /// Writes the derivatives of a free root for weights w, at rates v and a of its
  /// unknowns (6 each). Does nothing in the plane.
  void root(Weights w, In v, In a, RootTangent<Shape>& root) const {
    if constexpr (modes > 1) {
      const FreeRootFrame& free = kinematics_.free_root();
      const FrameMotion& m = kinematics_.root();
      const Wrench& held = dynamics_.at_root();
      const Helix& joint = free.joint();
      const Frame rotation = joint.rotation(free.at());
      const Vec rate{v[3], v[4], v[5]}, second{a[3], a[4], a[5]};
      const Vec omega = joint.W(rate).at(free.at());
      const Vec alpha =
          joint.W(second).at(free.at()) + joint.dW(rate, rate).at(free.at());
      root.local.setZero();
      root.transfer.setZero();
      for (int c = 0; c < 3; ++c) {
        const Vec e = Frames::axis(c);
        const Vec back = free.frame().back(e);
        auto x = column_of(root.transfer, c);
        put(w.pos * back, {}, x, 0);
        put(w.vel * back, {}, x, 1);
        put(w.acc * back, {}, x, 2);

        const Vec turn = joint.W(e).at(free.at());  // in the reference's components
        const Vec phi = rotation.back(turn);
        const Vec turned = joint.dW(e, rate).at(free.at());
        const Vec d_omega = turned + cross(omega, turn);
        const Vec d_alpha = joint.dW(e, second).at(free.at()) +
                            joint.d2W(e, rate, rate).at(free.at()) + cross(alpha, turn);
        const Vec d_alpha_rate = turned + joint.dW(rate, e).at(free.at());
        auto theta = column_of(root.transfer, 3 + c);
        put({}, w.pos * phi, theta, 0);
        put(w.pos * cross(m.v, phi), w.pos * rotation.back(d_omega) + w.vel * phi, theta,
            1);
        put(w.pos * cross(m.a, phi),
            w.pos * rotation.back(d_alpha) + w.vel * rotation.back(d_alpha_rate) +
                w.acc * phi,
            theta, 2);

        Frames::put(free.frame() * e, {}, column_of(root.lift, c));
        Frames::put({}, turn, column_of(root.lift, 3 + c));
        const Vec force = free.frame() * cross(phi, held.force);
        const Vec moment = joint.dW(e, held.moment).at(free.at());
        Frames::put(w.pos * force, w.pos * moment, column_of(root.local, 3 + c));
      }
      Eigen::Matrix<double, size, Shape::states> spin;
      spin.setZero();
      rotor(kinematics_.root_rotor(), m.omega, spin);
      add_product(root.lift, product(spin, root.transfer), root.local);
    }
  }

  /// Adds the derivatives of a load on a point with this motion to those of the wrench at
  /// the point by its state (SegmentTangent::tip). Expects the load to be part of
  /// at_tip() and at_root() (InverseDynamics::hang). A force f that keeps its direction
  /// changes its components by f x phi, a moment likewise. A rotation phi at a fixed
  /// state v of the velocity changes the velocity by phi x v.
  static void load(const SectionLoad& load, const FrameMotion& m,
                   Eigen::Matrix<double, Shape::wrench, Shape::states>& tip) {
    const Frame& f = m.frame;
    const Vec force = f.back(load.force), moment = f.back(load.moment);
    for (int c = 0; c < t; ++c) {
      const Vec e = Frames::axis(S::translation[c]);
      Vec by_place = load.by_place * (f * e);
      if constexpr (modes == 1) {
        // Velocity across the plane is not among the states (points()).
        const Vec across{0, cross(m.omega, e).y, 0};
        by_place = by_place + load.by_velocity * (f * across);
      }
      subtract_wrench(f.back(by_place), {}, c, tip);
      subtract_wrench(f.back(load.by_velocity * (f * e)), {}, size + c, tip);
    }
    for (int c = 0; c < S::rotations; ++c) {
      const Vec e = Frames::axis(S::rotation[c]), turn = f * e;
      const Vec by_swing = f.back(load.by_velocity * (f * cross(e, m.v)));
      Vec by_turn = load.by_turn * turn;
      // In the plane, omega turns with the frame: its variation in the world is the
      // state.
      if constexpr (modes > 1) {
        by_turn = by_turn - load.by_spin * (f * cross(m.omega, e));
      }
      subtract_wrench(cross(force, e) + by_swing, f.back(by_turn) + cross(moment, e),
                      t + c, tip);
      subtract_wrench({}, f.back(load.by_spin * turn), size + t + c, tip);
    }
  }
  /// load() on the root, with `root` of root().
  void load_root(const SectionLoad& of, RootTangent<Shape>& root) const {
    Eigen::Matrix<double, size, Shape::states> by_state;
    by_state.setZero();
    load(of, kinematics_.root(), by_state);
    add_product(root.lift, product(by_state, root.transfer), root.local);
  }

  /// Results of the transposed product at a segment (TransposedProduct).
  using Rows = Eigen::Matrix<double, Shape::rows, 1>;
  using State = Eigen::Matrix<double, Shape::states, 1>;
  /// Writes (dr/dv)^T mu and (dr/da)^T mu of the unknowns of segment i. These are the
  /// products with their columns of segment() for the weights {0, 1, 0} and {1, 0, 0}.
  /// `velocities`: of
  /// all blocks of points for v = mu, in the components of the start; writes those of the
  /// segment.
  void pull_rates(std::size_t i, const EffectBlocks& effects, const Rows& rows,
                  const State& by_state, Out by_v, Out by_a,
                  std::span<Vec3<Pack>> velocities) const {
    const auto& segment = kinematics_.segments()[i];
    const auto& g = kinematics_.geometry(i);
    const auto& m = kinematics_.motion(i);
    const FrameMotion& from = kinematics_.start(i);
    auto [force, moment] = vectors(rows, 0);
    if (segment.mounted) {
      force = segment.mount.back(force);
      moment = segment.mount.back(moment);
    }
    const auto bent = rate_slopes(g.kernel, m);
    std::array<Pack, dofs> of_v{}, of_a{};
    const Vec3<Pack> omega(from.omega);
    for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
      const auto& block = kinematics_.block_geometry(b);
      Vec3<Pack>& u = velocities[b];
      u = Vec3<Pack>(force) + cross(Vec3<Pack>(moment), block.position);
      for (std::size_t k = 0; k < dofs; ++k) {
        u = u + Pack(rows[size + static_cast<int>(k)]) * block.slope[k];
      }
      const Vec3<Pack> momentum = kinematics_.blocks()[b].mass * u;
      const Vec3<Pack> turned = cross(momentum, omega);  // u . (omega x slope)
      Vec3<Pack> held{Pack(0), Pack(0), Pack(0)};
      if (!effects.velocity.empty()) {
        held = PointMatrix(&effects.velocity[9 * K::first_point(b)], from.frame).back(u);
      }
      for (std::size_t k = 0; k < dofs; ++k) {
        of_a[k] += dot(momentum, block.slope[k]);
        of_v[k] += Pack(2) * (dot(turned, block.slope[k]) +
                              dot(momentum, bent[k].at(block.at))) -
                   dot(held, block.slope[k]);
      }
    }
    const auto [of_velocity, of_spin] = vectors(by_state, size);
    const auto [of_second, of_second_spin] = vectors(by_state, 2 * size);
    const Vec v = g.rotation * of_velocity, spin = g.rotation * of_spin,
              a = g.rotation * of_second, alpha = g.rotation * of_second_spin;
    const Weights only_vel{0, 1, 0};
    for (int k = 0; k < dofs; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const Strain e = K::unit(k);
      const Vec &slope = g.slope[at], &turn = g.turn[at];
      const double mu = rows[size + k];
      by_a[at] = sum(of_a[at]) + dot(slope, a) + dot(turn, alpha);
      by_v[at] = sum(of_v[at]) + mu * dot(e, restoring(segment, only_vel)) +
                 dot(slope, v) + dot(turn, spin) +
                 2.0 * dot(cross(from.omega, slope) + bent[at].at(g.tip), a) +
                 dot(g.kernel.dW(e, m.rate).at(g.tip) + g.kernel.dW(m.rate, e).at(g.tip) +
                         cross(from.omega, turn),
                     alpha);
      if constexpr (Kernel::functions == 2) by_a[at] += mu * dot(e, segment.inertia);
    }
  }

  /// Returns the product of what compute() found for the state of the root with the
  /// change of the root's motion from `here` to `there`, to first order.
  static double change(const State& by_root, const FrameMotion& here,
                       const FrameMotion& there) {
    const auto product = [&by_root](int level, const Vec& translation,
                                    const Vec& rotation) {
      const auto [by_translation, by_rotation] = vectors(by_root, level * size);
      return dot(by_translation, translation) + dot(by_rotation, rotation);
    };
    const Frame& f = here.frame;
    const Vec e0 = f.back(there.frame.e0), e1 = f.back(there.frame.e1),
              e2 = f.back(there.frame.e2);
    return product(0, f.back(there.x - here.x),
                   0.5 * Vec{e1.z - e2.y, e2.x - e0.z, e0.y - e1.x}) +
           product(1, there.v - here.v, there.omega - here.omega) +
           product(2, there.a - here.a, there.alpha - here.alpha);
  }

  /// Returns the translation and the rotation that begin at entry `from`.
  template <class Column>
  static std::pair<Vec, Vec> vectors(const Column& column, int from) {
    double all[2][3] = {};
    for (int k = 0; k < t; ++k) all[0][S::translation[k]] = column[from + k];
    for (int k = 0; k < S::rotations; ++k) all[1][S::rotation[k]] = column[from + t + k];
    return {{all[0][0], all[0][1], all[0][2]}, {all[1][0], all[1][1], all[1][2]}};
  }

 private:
  using K = Kinematics<Kernel, modes>;
  using Strain = typename Kernel::Strain;
  using Frames = SegmentFrames<Shape>;
  using S = Space<modes>;
  static constexpr int dofs = Shape::dofs, t = S::translations, size = S::size;

  template <class Column>
  static void put(const Vec& translation, const Vec& rotation, Column&& column,
                  int level) {
    Frames::put(translation, rotation, &column[level * size]);
  }

  /// Subtracts a wrench from a column.
  static void subtract_wrench(const Vec& force, const Vec& moment, int column,
                              Eigen::Matrix<double, size, Shape::states>& to) {
    double wrench[size];
    Frames::put(force, moment, wrench);
    for (int r = 0; r < size; ++r) to(r, column) -= wrench[r];
  }

  /// Derivatives of the positions in a segment with respect to its unknowns.
  struct Derivatives {
    Derivatives(const Kernel& kernel, const typename K::SegmentMotion& m) {
      if constexpr (Kernel::functions == 2) {
        kernel.derivatives(m.rate, m.acceleration, velocity, acceleration, curvature);
        return;
      }
      for (std::size_t k = 0; k < dofs; ++k) {
        const Strain e = K::unit(static_cast<int>(k));
        velocity[k] = kernel.second(m.rate, e);
        acceleration[k] = kernel.acceleration_slope(m.rate, m.acceleration, e);
        for (std::size_t l = k; l < dofs; ++l) {
          curvature[k][l] = curvature[l][k] =
              kernel.second(e, K::unit(static_cast<int>(l)));
        }
      }
    }
    using Second = decltype(Kernel().second(Strain(), Strain()));
    std::array<Second, dofs> velocity;  // dP'/dq_k
    std::array<decltype(Kernel().acceleration_slope(Strain(), Strain(), Strain())), dofs>
        acceleration;                                      // dP''/dq_k
    std::array<std::array<Second, dofs>, dofs> curvature;  // d2P/dq_k dq_l
  };

  /// Variation of a fixed omega in the components of a frame that turns by `axis`.
  static Vec in_plane(const Vec& omega, const Vec& axis) { return cross(omega, axis); }

  /// Returns dP'/dq_k of all unknowns.
  static auto rate_slopes(const Kernel& kernel, const typename K::SegmentMotion& m) {
    if constexpr (Kernel::functions == 2) {
      return Derivatives(kernel, m).velocity;
    } else {
      std::array<typename Derivatives::Second, dofs> all;
      for (std::size_t k = 0; k < dofs; ++k) {
        all[k] = kernel.second(m.rate, K::unit(static_cast<int>(k)));
      }
      return all;
    }
  }

  void points(std::size_t i, Weights w, const EffectBlocks& effects,
              const Derivatives& derivatives, SegmentTangent<Shape>& tangent) const {
    const auto& segment = kinematics_.segments()[i];
    const auto& m = kinematics_.motion(i);
    const FrameMotion& from = kinematics_.start(i);
    const Vec3<Pack> omega(from.omega), alpha(from.alpha);
    const bool blocks = !effects.velocity.empty();
    const bool directions = !effects.direction.empty();

    for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
      const Pack& mass = kinematics_.blocks()[b].mass;
      const auto& block = kinematics_.block_geometry(b);
      const Vec3<Pack>& p = block.position;
      const Vec3<Pack> velocity = m.moving.at(block.at);
      const Vec3<Pack>& load = dynamics_.load(b);
      const Vec3<Pack>& force = dynamics_.force(b);
      const Vec3<Pack> turning = cross(omega, p);
      PointMatrix by_x, by_v, by_t, by_start;
      Vec3<Pack> u, along;  // velocity and tangent of the point
      if (blocks) {
        by_x = PointMatrix(&effects.position[9 * K::first_point(b)], from.frame);
        by_v = PointMatrix(&effects.velocity[9 * K::first_point(b)], from.frame);
        u = Vec3<Pack>(from.v) + turning + velocity;
        by_start = by_x;
        if constexpr (modes == 1) {
          // Velocity across the plane is not among the states: if the start moves by dx,
          // it is omega x dx.
          by_start.column[0] = by_start.column[0] + omega.z * by_v.column[1];
          by_start.column[2] = by_start.column[2] - omega.x * by_v.column[1];
        }
      }
      if (directions) {
        by_t = PointMatrix(&effects.direction[9 * K::first_point(b)], from.frame);
        along = kinematics_.geometry(i).kernel.rotated(block.at, Helix::tangent);
      }
      const auto add = [&](int column, const Vec3<Pack>& dF) {
        accumulate(block, dF, column, tangent);
      };
      for (int c = 0; c < t; ++c) {
        const Vec3<Pack> e(Frames::axis(S::translation[c]));
        if (blocks) {
          add(c, Pack(-1) * (by_start * e));
          add(size + c, Pack(-1) * (by_v * e));
        }
        add(2 * size + c, mass * e);
      }
      for (int c = 0; c < S::rotations; ++c) {
        const Vec3<Pack> e(Frames::axis(S::rotation[c]));
        const Vec3<Pack> lever = cross(e, p);
        Vec3<Pack> by_phi = cross(e, load);
        Vec3<Pack> by_omega =
            mass * (cross(e, turning + Pack(2) * velocity) + cross(omega, lever));
        if (blocks) {
          by_phi = by_phi - by_start * lever - by_v * cross(e, u);
          by_omega = by_omega - by_v * lever;
        }
        if (directions) by_phi = by_phi - by_t * cross(e, along);
        if constexpr (modes == 1) {
          // omega within the plane is not among the states: it turns with the frame.
          const Vec3<Pack> turned(in_plane(from.omega, Frames::axis(S::rotation[c])));
          by_phi = by_phi + mass * (cross(turned, turning + Pack(2) * velocity) +
                                    cross(omega, cross(turned, p)));
        }
        add(t + c, by_phi);
        add(size + t + c, by_omega);
        add(2 * size + t + c, mass * lever);
      }
      for (int k = 0; k < dofs; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const Vec3<Pack>& slope = block.slope[at];
        const Vec3<Pack> bent = derivatives.velocity[at].at(block.at);
        const Vec3<Pack> carried = cross(omega, slope);
        Vec3<Pack> dF =
            mass *
            (Pack(w.acc) * slope + Pack(2 * w.vel) * (carried + bent) +
             Pack(w.pos) * (cross(alpha, slope) + cross(omega, carried + Pack(2) * bent) +
                            derivatives.acceleration[at].at(block.at)));
        if (blocks) {
          dF = dF - Pack(w.pos) * (by_x * slope) -
               by_v * (Pack(w.vel) * slope + Pack(w.pos) * (carried + bent));
        }
        if (directions) {
          const Vec3<Pack> turn =
              kinematics_.geometry(i).kernel.W(K::unit(k)).at(block.at);
          dF = dF - Pack(w.pos) * (by_t * cross(turn, along));
        }
        add(3 * size + k, dF);
        // Lever arms change under the existing force.
        const Vec3<Pack> lever = cross(slope, force);
        add_moment(Vec{sum(lever.x), sum(lever.y), sum(lever.z)}, w.pos, 3 * size + k,
                   tangent);
        for (int l = k; l < dofs; ++l) {
          const double bend =
              w.pos *
              sum(dot(derivatives.curvature[at][static_cast<std::size_t>(l)].at(block.at),
                      force));
          tangent.local(size + k, 3 * size + l) += bend;
          if (l != k) tangent.local(size + l, 3 * size + k) += bend;
        }
      }
    }
  }

  static void add_moment(const Vec& moment, double factor, int column,
                         SegmentTangent<Shape>& tangent) {
    const double from[3] = {moment.x, moment.y, moment.z};
    for (int r = 0; r < S::rotations; ++r) {
      tangent.local(t + r, column) += factor * from[S::rotation[r]];
    }
  }

  static void accumulate(const typename K::BlockGeometry& block, const Vec3<Pack>& dF,
                         int column, SegmentTangent<Shape>& tangent) {
    const Vec3<Pack> moment = cross(block.position, dF);
    const double force[3] = {sum(dF.x), sum(dF.y), sum(dF.z)};
    for (int r = 0; r < t; ++r) tangent.local(r, column) += force[S::translation[r]];
    add_moment({sum(moment.x), sum(moment.y), sum(moment.z)}, 1, column, tangent);
    for (int k = 0; k < dofs; ++k) {
      tangent.local(size + k, column) +=
          sum(dot(block.slope[static_cast<std::size_t>(k)], dF));
    }
  }

  /// State of the tip, and the effect of the tip's wrench at the start.
  void tip(std::size_t i, Weights w, const Derivatives& derivatives,
           SegmentTangent<Shape>& tangent) const {
    const auto& g = kinematics_.geometry(i);
    const auto& m = kinematics_.motion(i);
    const Frame& f = g.rotation;
    const FrameMotion& from = kinematics_.start(i);
    const Vec omega = from.omega, alpha = from.alpha;
    const Vec tip_omega = omega + m.turning;
    auto& transfer = tangent.transfer;
    const auto back = [&](const Vec& translation, const Vec& rotation, auto&& column,
                          int level) {
      put(f.back(translation), f.back(rotation), column, level);
    };

    for (int c = 0; c < t; ++c) {
      const Vec e = Frames::axis(S::translation[c]);
      for (int level = 0; level < 3; ++level) {
        back(e, {}, column_of(transfer, level * size + c), level);
      }
    }
    for (int c = 0; c < S::rotations; ++c) {
      const Vec e = Frames::axis(S::rotation[c]);
      const Vec lever = cross(e, g.position);
      for (int level = 0; level < 3; ++level) {
        back(lever, e, column_of(transfer, level * size + t + c), level);
      }
      back(cross(e, cross(omega, g.position) + 2.0 * m.velocity) + cross(omega, lever),
           cross(e, m.turning), column_of(transfer, size + t + c), 2);
      if constexpr (modes == 1) {
        const Vec turned = in_plane(omega, e);
        back(cross(turned, cross(omega, g.position) + 2.0 * m.velocity) +
                 cross(omega, cross(turned, g.position)),
             {}, column_of(transfer, t + c), 2);
      }
    }

    const Wrench& held = dynamics_.at_tip(i);
    const Vec force = f * held.force, moment = f * held.moment;
    const auto at = g.tip;
    for (int k = 0; k < dofs; ++k) {
      const auto index = static_cast<std::size_t>(k);
      const Strain e = K::unit(k);
      const Vec &slope = g.slope[index], &turn = g.turn[index];
      const Vec bent = derivatives.velocity[index].at(at);
      const Vec turned = g.kernel.dW(e, m.rate).at(at);  // d(W kappa')/dkappa_k
      const Vec velocity = cross(omega, slope) + bent;
      const Vec acceleration = cross(alpha, slope) +
                               cross(omega, cross(omega, slope) + 2.0 * bent) +
                               derivatives.acceleration[index].at(at);
      const Vec spin = g.kernel.dW(e, m.acceleration).at(at) +
                       g.kernel.d2W(e, m.rate, m.rate).at(at) + cross(omega, turned);
      auto column = column_of(transfer, 3 * size + k);
      back(w.pos * slope, w.pos * turn, column, 0);
      back(w.pos * (velocity + cross(m.tip_v, turn)) + w.vel * slope,
           w.pos * (turned + cross(tip_omega, turn)) + w.vel * turn, column, 1);
      back(w.pos * (acceleration + cross(m.tip_a, turn)) +
               (2 * w.vel) * (cross(omega, slope) + bent) + w.acc * slope,
           w.pos * (spin + cross(m.tip_alpha, turn)) +
               w.vel * (turned + g.kernel.dW(m.rate, e).at(at) + cross(omega, turn)) +
               w.acc * turn,
           column, 2);

      // The tip's wrench turns with the tip and acts on a changing lever.
      const Vec d_force = cross(turn, force), d_moment = cross(turn, moment);
      const Vec at_start = cross(g.position, d_force) + cross(slope, force) + d_moment;
      auto local = column_of(tangent.local, 3 * size + k);
      double wrench[size];
      Frames::put(w.pos * d_force, w.pos * at_start, wrench);
      for (int r = 0; r < size; ++r) local[r] += wrench[r];
      const Strain by_turn = g.kernel.dW_transposed(at, e, moment);
      for (std::size_t l = 0; l < dofs; ++l) {
        const Strain other = K::unit(static_cast<int>(l));
        local[size + static_cast<int>(l)] +=
            w.pos *
            (dot(g.slope[l], d_force) + dot(g.turn[l], d_moment) +
             dot(derivatives.curvature[index][l].at(at), force) + dot(other, by_turn));
      }
    }

    // Wrench columns: a unit force or moment on the tip, in the tip's components.
    for (int c = 0; c < size; ++c) {
      const bool is_force = c < t;
      const int component = is_force ? S::translation[c] : S::rotation[c - t];
      const Vec e = f * Frames::axis(component);
      auto lift = column_of(tangent.lift, c);
      if (is_force) {
        Frames::put(e, cross(g.position, e), lift);
      } else {
        Frames::put({}, e, lift);
      }
      for (int k = 0; k < dofs; ++k) {
        const auto index = static_cast<std::size_t>(k);
        lift[size + k] = dot(is_force ? g.slope[index] : g.turn[index], e);
      }
    }
  }

  /// Derivatives of I (alpha_x, omega_x omega_z, -omega_x omega_y); the rest of m is
  /// zero.
  static void rotor(double inertia, const Vec& omega,
                    Eigen::Matrix<double, size, Shape::states>& m) {
    constexpr int spin = size + t;  // column of the variation of omega_x
    m(t, 2 * size + t) = inertia;
    m(t + 1, spin) = inertia * omega.z;
    m(t + 1, spin + 2) = inertia * omega.x;
    m(t + 2, spin) = -inertia * omega.y;
    m(t + 2, spin + 1) = -inertia * omega.x;
  }

  const Kinematics<Kernel, modes>& kinematics_;
  const InverseDynamics<Kernel, modes>& dynamics_;
};

}  // namespace tress::models
