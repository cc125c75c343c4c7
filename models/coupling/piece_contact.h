#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "math/closest.h"
#include "models/contact/contact_law.h"
#include "models/coupling/coupling.h"

namespace tress::models {

/// Contact of a sample of one straight piece, (1 - sigma) x_0 + sigma x_1, with the
/// nearest point of another, (1 - s) x_2 + s x_3. The force is the law's force per length
/// times `length`. With the weights W = (1 - sigma, sigma, s - 1, -s), which sum to zero,
///
///     d = sum_a W_a x_a,    u = sum_a W_a v_a,    f_a = length W_a F(d, u),
///
/// so the forces on the four points sum to zero (action equals reaction).
class PieceContact {
 public:
  /// Positions or velocities of the four points.
  using Points = std::array<Vec, 4>;

  /// `at` is s, the point of piece x_2, x_3 nearest to the sample.
  PieceContact(const Points& x, const Points& v, double sigma, double at, double length);

  /// Returns d, m.
  const Vec& gap() const { return d_; }
  /// Returns the length of strand that the sample stands for, m.
  double length() const { return length_; }
  /// Returns the weight W of a point.
  double weight(std::size_t a) const { return weight_[a]; }

  /// length F, distributed by W.
  Vec force(const ContactLaw& law) const { return length_ * law.force(d_, u_); }
  /// Power (W) that is not in the law's potential: d' and u differ along the second piece
  /// only, where the repulsion does no work.
  double power(const ContactLaw& law) const {
    return length_ * dot(law.force(d_, u_) - law.force(d_, {}), u_);
  }
  /// Returns the potential of the sample, J.
  double potential(const ContactLaw& law) const { return length_ * law.potential(d_); }

  /// Derivatives of all f_a for the given point indices: y_0 to y_2 are dF, through d, u
  /// and s; y_3 is ds, which moves F along the second piece.
  Coupling coupling(const ContactLaw& law,
                    const std::array<std::size_t, 4>& points) const;

 private:
  std::array<double, 4> weight_;
  double length_;
  Vec d_, u_;
  Vec d_by_s_, u_by_s_;
  // ds/dx_c, 0 at the ends of the piece, where dW_a/ds is not needed.
  std::array<Vec, 4> s_by_;
};

}  // namespace tress::models
