#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "math/closest.h"
#include "models/effects/contact_law.h"
#include "models/effects/coupling.h"

namespace tress::models {

/// A sample of one straight piece, (1 - sigma) x_0 + sigma x_1, against the nearest point
/// of another, (1 - s) x_2 + s x_3, by the law's force per length times `length`. With
/// the weights W = (1 - sigma, sigma, s - 1, -s), which sum to zero,
///
///     d = sum_a W_a x_a,    u = sum_a W_a v_a,    f_a = length W_a F(d, u),
///
/// so what the four points get sums to zero: action is reaction.
class PieceContact {
 public:
  using Points = std::array<Vec, 4>;

  /// s is `at` of piece x_2, x_3: the point of it nearest to the sample.
  PieceContact(const Points& x, const Points& v, double sigma, double at, double length);

  const Vec& gap() const { return d_; }
  double length() const { return length_; }
  double weight(std::size_t a) const { return weight_[a]; }

  /// length F, which W distributes.
  Vec force(const ContactLaw& law) const { return length_ * law.force(d_, u_); }
  /// W, of what the law's potential does not account for: d' and u differ along the
  /// second piece only, where the repulsion does no work.
  double power(const ContactLaw& law) const {
    return length_ * dot(law.force(d_, u_) - law.force(d_, {}), u_);
  }
  double potential(const ContactLaw& law) const { return length_ * law.potential(d_); }

  /// Derivatives of all f_a, whose points have these numbers: y_0 to y_2 are dF, which
  /// comes through d, u and s, and y_3 is ds, which moves F along the second piece.
  Coupling coupling(const ContactLaw& law,
                    const std::array<std::size_t, 4>& points) const;

 private:
  std::array<double, 4> weight_;
  double length_;
  Vec d_, u_;
  Vec d_by_s_, u_by_s_;
  // Of s by x_c, 0 at the ends of the piece; dW_a/ds there is of no use.
  std::array<Vec, 4> s_by_;
};

}  // namespace tress::models
