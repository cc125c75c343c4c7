#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "math/vec3.h"

namespace tress::simulation {

/// Natural cubic splines of the three coordinates over the length u of a polyline, and
/// the arc length s of the curve: a curve through points, straight at its two ends. For
/// one thread at a time.
class SpaceCurve {
 public:
  /// Points nearer to each other than this are refused, m.
  static constexpr double least_step = 1e-9;

  /// Arc length by Simpson's rule in `fine` parts between two points. Throws InputError
  /// naming `where` on two points of a row that are nearer than least_step.
  SpaceCurve(std::span<const Vec> points, int fine, const std::string& where);
  ~SpaceCurve();
  SpaceCurve(SpaceCurve&&) noexcept;

  /// u of each point (m), and the arc length there.
  std::span<const double> knots() const { return knots_; }
  double arc_of_point(std::size_t i) const {
    return arc_[i * static_cast<std::size_t>(fine_)];
  }
  double length() const { return arc_.back(); }
  /// u where the arc length is s; linear within a part.
  double parameter(double s) const;

  Vec position(double u) const;
  Vec rate(double u) const;     // dx/du
  Vec tangent(double u) const;  // of length 1

  /// u and s at the ends of all parts.
  std::span<const double> parameters() const { return u_; }
  std::span<const double> arcs() const { return arc_; }

 private:
  struct Splines;
  int fine_;
  std::vector<double> knots_, u_, arc_;
  std::unique_ptr<Splines> splines_;
};

}  // namespace tress::simulation
