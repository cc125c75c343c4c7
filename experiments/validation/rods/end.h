#pragma once

#include <Eigen/Core>
#include <vector>

#include "contract/forms/material_points.h"
#include "contract/system.h"
#include "math/frame.h"

namespace tress::experiments::validation {

/// Loads and supports of the free end of a strand in a test.
struct End {
  /// The constrained part of the tip section: nothing, its tangent, or its whole frame.
  enum class Section { free, tangent, frame };

  Vec force{};               // dead, N, times the load
  std::vector<Vec> along{};  // unit vectors along which the tip is held ...
  Vec place{};               // ... at this position, m
  Section section = Section::free;
  Frame frame{};  // to which the section is held
  /// Spring in place of the last half edge, between the edge and the support, for models
  /// in which that half edge neither bends nor twists. Compliance (rad/(N m)) to a
  /// moment, and rotation (rad) at rest, about the axes of the section.
  Vec compliance{}, rest{};

  /// Rows of the section: 0, 2 (about e1, e2) or 3 (about e0, e1, e2).
  int section_rows() const;
};

/// Conditions c = 0 that hold an end, as functions of q. They are along_i . (x - place),
/// then the rotation vector from `frame` to the section, about the axes of `frame`. With
/// a half edge it is that from `frame` to the edge, plus `rest` and compliance times the
/// moment. Gradients of the position are exact, from the velocities of the tip; those of
/// the section are by differences of order 4.
class EndConditions {
 public:
  /// Throws std::runtime_error when the section is held and the model has no end_frame.
  EndConditions(System& system, const End& end);

  int rows() const { return places_ + sections_; }
  int places() const { return places_; }
  Eigen::VectorXd value(double t, In q);
  /// Computes the gradient of the conditions, (n x rows).
  Eigen::MatrixXd gradient(double t, In q);
  /// d(gradient of the section . moment)/dq, (n x n), by differences, relative error
  /// 1e-8.
  Eigen::MatrixXd curvature(double t, In q, const Eigen::VectorXd& moment);
  /// Diagonal of the compliance, (rows); 0: rigid.
  Eigen::VectorXd compliance() const;

 private:
  Eigen::VectorXd section(double t, In q);
  /// Coordinates that rotate the section.
  /// Computes the gradient of the section rows, (n, sections).
  Eigen::MatrixXd section_gradient(double t, In q);
  std::vector<std::size_t> turning(double t, In q);

  System& system_;
  MaterialPoints& points_;
  const End& end_;
  int places_, sections_;
  std::vector<double> q_typ_;
};

}  // namespace tress::experiments::validation
