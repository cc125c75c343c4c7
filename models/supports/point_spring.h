#pragma once

#include <vector>

#include "contract/forms/loaded_tangent.h"
#include "contract/forms/material_points.h"
#include "contract/forms/sparse_form.h"
#include "models/supports/support.h"

namespace tress::models {

/// Spring and damper between a material point x of a strand and the path p of a support,
/// in the held directions e of the support (orthonormal):
///
///     f = -sum e e.(k (x - p) + c (x' - p')),   U = k sum (e.(x - p))^2/2.
///
/// Points that are means of coordinates (MaterialPoints::mean) add 3x3 blocks to the
/// matrix. In other models with a full matrix, the derivative is a central difference.
class PointSpring {
 public:
  /// `strand` must outlive it; `matrix` is its S (null: full). Throws InputError naming
  /// `where` if the matrix does not couple the coordinates of the point.
  PointSpring(System& strand, const Support& support, SparseForm* matrix,
              const std::string& where);

  /// r -= J^T f.
  void add_force(double t, In q, In v, InOut r);
  /// s -= w.pos d(J^T f)/dq + w.vel d(J^T f)/dv.
  void add_tangent(double t, In q, In v, Weights w, InOut s);
  /// Returns the force with its derivatives.
  SectionLoad load(double t, In q, In v);
  /// Returns the elastic energy, J.
  double energy(double t, In q);
  /// Returns the rate of the elastic energy, W.
  double energy_rate(double t, In q, In v);
  /// Returns the held directions.
  const std::vector<Vec>& axes() const { return axes_; }
  /// Returns the path of the support.
  const RootMotion& path() const { return path_; }
  /// Returns the index of the material point.
  int point() const { return point_; }
  /// Returns the stiffness, N/m.
  double stiffness() const { return stiffness_; }
  /// Returns the damping, N s/m.
  double damping() const { return damping_; }

 private:
  Vec gap(double t, In q);
  Vec gap_rate(double t, In q, In v);
  Vec held(const Vec& d) const;
  void pull(double t, In q, const Vec& force, InOut b);
  void find_entries(const MaterialPoints::Mean& mean, const Pattern& matrix,
                    const std::string& where);

  MaterialPoints* points_;
  int point_;
  RootMotion path_;
  std::vector<Vec> axes_;
  double stiffness_, damping_;
  Matrix3<double> along_;             // sum of e e^T
  std::vector<std::size_t> entries_;  // of the blocks of means in S, by columns
  std::vector<double> x_, q_typ_, shifted_, change_;
};

}  // namespace tress::models
