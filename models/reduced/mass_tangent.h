#pragma once

#include "models/reduced/kinematics.h"
#include "models/reduced/point_matrix.h"
#include "models/reduced/tree/tree_tangent.h"

namespace tress::models {

/// Frame operations shared by both kinds of tangents.
template <class Shape>
class SegmentFrames {
  using S = Space<Shape::wrench == 3 ? 1 : 3>;
  using Real = typename Shape::Real;
  using Vec = Vec3<Real>;
  using Frame = FrameOf<Real>;

 public:
  /// Transforms a state of `states` 3-vectors to the mount's frame: columns of transfer
  /// and local, rows of local and lift.
  static void mount(const Frame& mount, SegmentTangent<Shape>& tangent) {
    mount_states(mount, tangent.transfer);
    mount_states(mount, tangent.local);
    mount_wrench(mount, tangent.local);
    mount_wrench(mount, tangent.lift);
  }
  /// Makes the state columns of m act on a state of the parent's tip.
  template <class M>
  static void mount_states(const Frame& mount, M& m) {
    static_assert(S::size == 6);
    for (int k = 0; k < Shape::states; k += 3) {
      for (int i = 0; i < M::RowsAtCompileTime; ++i) {
        turn(mount, m(i, k), m(i, k + 1), m(i, k + 2));
      }
    }
  }
  /// Turns the wrench rows of m into the components of the parent's tip.
  template <class M>
  static void mount_wrench(const Frame& mount, M& m) {
    for (int k = 0; k < Shape::wrench; k += 3) {
      for (int j = 0; j < M::ColsAtCompileTime; ++j) {
        turn(mount, m(k, j), m(k + 1, j), m(k + 2, j));
      }
    }
  }

  /// Writes (translation, rotation) to a column, in the directions of Space.
  template <class Column>
  static void put(const Vec& translation, const Vec& rotation, Column&& column) {
    const Real from[2][3] = {{translation.x, translation.y, translation.z},
                             {rotation.x, rotation.y, rotation.z}};
    for (int i = 0; i < S::translations; ++i) column[i] = from[0][S::translation[i]];
    for (int i = 0; i < S::rotations; ++i) {
      column[S::translations + i] = from[1][S::rotation[i]];
    }
  }
  /// Returns f.back(axis(component)).
  static Vec seen(const Frame& f, int component) {
    if (component == 0) return {f.e0.x, f.e1.x, f.e2.x};
    if (component == 1) return {f.e0.y, f.e1.y, f.e2.y};
    return {f.e0.z, f.e1.z, f.e2.z};
  }
  /// Returns the unit vector of a component, 0 to 2.
  static Vec axis(int component) { return S::axis(component); }

 private:
  static void turn(const Frame& frame, Real& x, Real& y, Real& z) {
    const Vec turned = frame * Vec{x, y, z};
    x = turned.x;
    y = turned.y;
    z = turned.z;
  }
};

/// Returns w.pos K + w.vel C of the unknowns of a segment, by component.
template <class Strain>
Strain restoring(const ReducedSegmentOf<Strain>& segment, Weights w) {
  return w.pos * segment.stiffness + w.vel * segment.friction;
}

/// Adds local += sum J^T B J over the points of a segment, with B the symmetric matrices
/// of the effects.
template <class Kernel, int modes>
void add_effect_tangent(const Kinematics<Kernel, modes>& kinematics, std::size_t i,
                        In matrices,
                        SegmentTangent<MassShapeOf<Kernel, modes>>& tangent) {
  using Real = typename Kernel::Real;
  using K = Kinematics<Kernel, modes>;
  constexpr int dofs = K::dofs;
  using AtPoints = SegmentFrames<MassShape<modes, Pack>>;
  using S = Space<modes>;
  constexpr int t = S::translations, size = S::size, columns = size + dofs;
  const auto& segment = kinematics.segments()[i];
  std::array<Pack, columns*(columns + 1) / 2> total{};  // upper triangle by columns
  for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
    const auto& block = kinematics.block_geometry(b);
    const Vec3<Pack>& p = block.position;
    const PointMatrix matrix(&matrices[9 * K::first_point(b)], kinematics.start(i).frame);
    auto entry = total.begin();
    for (int c = 0; c < columns; ++c) {
      const Vec3<Pack> force =
          c < t      ? matrix.column[S::translation[c]]
          : c < size ? matrix * cross(AtPoints::axis(S::rotation[c - t]), p)
                     : matrix * block.slope[static_cast<std::size_t>(c - size)];
      Pack answer[columns];
      AtPoints::put(force, cross(p, force), answer);
      for (std::size_t k = 0; k < dofs; ++k)
        answer[size + k] = dot(block.slope[k], force);
      for (int r = 0; r <= c; ++r) *entry++ += answer[r];
    }
  }
  auto entry = total.begin();
  for (int c = 0; c < columns; ++c) {
    for (int r = 0; r <= c; ++r) {
      const Real sum = sum_over<Real>(*entry++);
      tangent.local(r, c) += sum;
      if (r != c) tangent.local(c, r) += sum;
    }
  }
}

/// Whether at each point of a segment the matrix of the effects is a number times the
/// unit matrix, which then counts like mass.
template <class Kernel, int modes>
bool like_masses(const Kinematics<Kernel, modes>& kinematics, std::size_t i,
                 In matrices) {
  using K = Kinematics<Kernel, modes>;
  const auto& segment = kinematics.segments()[i];
  for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
    for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
      if (!is_multiple_of_unit(&matrices[9 * (K::first_point(b) + lane)])) return false;
    }
  }
  return true;
}

/// Mass, friction and elastic stiffness of one segment, w.acc M + w.vel C + w.pos K: the
/// tangent of the linearly implicit step. The motion of its points and tip is linear in
/// the acceleration of its start and in its unknowns, J = [I, -[P]x, dP/dq]. The matrix
/// is sum m J^T J over the quadrature points. `of_effects`: w.vel and w.pos times minus
/// the derivatives of the loads, (9) per point, or empty. Expects tip to be zero or the
/// result of an earlier call.
template <class Kernel, int modes>
void mass_tangent(const Kinematics<Kernel, modes>& kinematics, std::size_t i, Weights w,
                  SegmentTangent<MassShapeOf<Kernel, modes>>& tangent,
                  In of_effects = {}) {
  using Real = typename Kernel::Real;
  using K = Kinematics<Kernel, modes>;
  constexpr int dofs = K::dofs;
  using Frames = SegmentFrames<MassShapeOf<Kernel, modes>>;
  using S = Space<modes>;
  constexpr int t = S::translations, size = S::size;
  const auto& segment = kinematics.segments()[i];
  const auto& g = kinematics.geometry(i);
  const bool effects_as_masses =
      !of_effects.empty() && like_masses(kinematics, i, of_effects);

  // m: w.acc times mass, and what counts like it.
  Pack mass(0);
  Vec3<Pack> first;                             // sum m P
  Pack second[3][3];                            // sum m P P^T, upper
  std::array<Vec3<Pack>, dofs> momentum, spin;  // sum m dP, sum m P x dP
  Pack inner[dofs][dofs];                       // sum m dP . dP, upper
  for (auto& row : second) std::fill(std::begin(row), std::end(row), Pack(0));
  for (auto& row : inner) std::fill(std::begin(row), std::end(row), Pack(0));
  for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
    Pack m = Pack(w.acc) * kinematics.blocks()[b].mass;
    if (effects_as_masses) {
      m += first_entries(&of_effects[9 * K::first_point(b)]);
    }
    const auto& block = kinematics.block_geometry(b);
    const Vec3<Pack>& p = block.position;
    const Vec3<Pack> mp = m * p;
    mass += m;
    first = first + mp;
    second[0][0] += mp.x * p.x;
    second[0][2] += mp.x * p.z;
    second[2][2] += mp.z * p.z;
    if constexpr (modes > 1) {
      second[0][1] += mp.x * p.y;
      second[1][1] += mp.y * p.y;
      second[1][2] += mp.y * p.z;
    }
    for (std::size_t k = 0; k < dofs; ++k) {
      const Vec3<Pack> md = m * block.slope[k];
      momentum[k] = momentum[k] + md;
      spin[k] = spin[k] + cross(p, md);
      for (std::size_t l = k; l < dofs; ++l) inner[k][l] += dot(md, block.slope[l]);
    }
  }

  auto& local = tangent.local;
  const Real acc(w.acc), total = sum_over<Real>(mass);
  const Vec3<Real> p = sum_over<Real>(first);
  Real pp[3][3];
  for (int r = 0; r < 3; ++r) {
    for (int c = r; c < 3; ++c) pp[r][c] = pp[c][r] = sum_over<Real>(second[r][c]);
  }
  const Real trace = pp[0][0] + pp[1][1] + pp[2][2];
  for (int c = 0; c < t; ++c) {
    for (int r = 0; r < t; ++r) local(r, c) = r == c ? total : Real(0);
  }
  for (int c = 0; c < S::rotations; ++c) {
    const int axis = S::rotation[c];
    const Vec3<Real> turned = cross(Frames::axis(axis), p);  // sum m e x P
    const Real column[3] = {turned.x, turned.y, turned.z};
    for (int r = 0; r < t; ++r) {
      local(r, t + c) = local(t + c, r) = column[S::translation[r]];
    }
    for (int r = 0; r < S::rotations; ++r) {
      local(t + r, t + c) = (r == c ? trace : Real(0)) - pp[S::rotation[r]][axis];
    }
  }
  for (std::size_t k = 0; k < dofs; ++k) {
    const auto column = size + static_cast<int>(k);
    Frames::put(sum_over<Real>(momentum[k]), sum_over<Real>(spin[k]),
                column_of(local, column));
    for (int r = 0; r < size; ++r) local(column, r) = local(r, column);
    for (std::size_t l = k; l < dofs; ++l) {
      local(column, size + static_cast<int>(l)) =
          local(size + static_cast<int>(l), column) = sum_over<Real>(inner[k][l]);
    }
    tangent.stiffness[static_cast<int>(k)] =
        dot(K::unit(static_cast<int>(k)), restoring(segment, w));
    local(column, column) += tangent.stiffness[static_cast<int>(k)];
    if constexpr (Kernel::functions == 2) {
      local(column, column) += acc * dot(K::unit(static_cast<int>(k)), segment.inertia);
    }
  }

  if (!of_effects.empty() && !effects_as_masses) {
    add_effect_tangent(kinematics, i, of_effects, tangent);
  }

  auto& transfer = tangent.transfer;
  const auto& f = g.rotation;
  for (int c = 0; c < t; ++c) {
    Frames::put(Frames::seen(f, S::translation[c]), {}, column_of(transfer, c));
  }
  for (int c = 0; c < S::rotations; ++c) {
    const Vec3<Real> e = Frames::axis(S::rotation[c]);
    Frames::put(f.back(cross(e, g.position)), Frames::seen(f, S::rotation[c]),
                column_of(transfer, t + c));
  }
  for (std::size_t k = 0; k < dofs; ++k) {
    Frames::put(f.back(g.slope[k]), f.back(g.turn[k]),
                column_of(transfer, size + static_cast<int>(k)));
  }
  if constexpr (modes > 1) {
    tangent.tip(t, t) = acc * segment.rotor;
    if (segment.mounted) Frames::mount(segment.mount, tangent);
  }
  copy(part(transfer).transpose(), tangent.lift);
}

/// Writes mass_tangent() of a free root, which has a rotor only. Does nothing in the
/// plane.
template <class Kernel, int modes>
void mass_root_tangent(const Kinematics<Kernel, modes>& kinematics, Weights w,
                       RootTangent<MassShapeOf<Kernel, modes>>& root) {
  if constexpr (modes > 1) {
    const FreeRootFrame& free = kinematics.free_root();
    using Frames = SegmentFrames<MassShapeOf<Kernel, modes>>;
    for (int c = 0; c < 3; ++c) {
      const Vec e = Frames::axis(c);
      Frames::put(free.frame().back(e), Vec{}, column_of(root.transfer, c));
      Frames::put(Vec{}, free.joint().W_transposed(free.at(), e),
                  column_of(root.transfer, 3 + c));
    }
    copy(part(root.transfer).transpose(), root.lift);
    // The rotor at the root resists rotation about its e0.
    for (int c = 0; c < 6; ++c) {
      for (int r = 0; r < 6; ++r) {
        root.local(r, c) =
            (w.acc * kinematics.root_rotor()) * root.transfer(3, r) * root.transfer(3, c);
      }
    }
  }
}

}  // namespace tress::models
