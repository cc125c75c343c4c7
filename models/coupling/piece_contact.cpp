#include "models/coupling/piece_contact.h"

namespace tress::models {

PieceContact::PieceContact(const Points& x, const Points& v, double sigma, double at,
                           double length)
    : weight_{1 - sigma, sigma, at - 1, -at}, length_(length) {
  for (std::size_t a = 0; a < 4; ++a) {
    d_ = d_ + weight_[a] * x[a];
    u_ = u_ + weight_[a] * v[a];
  }
  const Vec e = x[3] - x[2];
  d_by_s_ = -1.0 * e;
  u_by_s_ = v[2] - v[3];
  if (at <= 0 || at >= 1) return;
  // s = (y - x_2).e/|e|^2 with y - x_2 = s e + d.
  const double inverse = 1 / dot(e, e);
  s_by_ = {inverse * (1 - sigma) * e, inverse * sigma * e, -inverse * ((1 - at) * e + d_),
           inverse * (d_ - at * e)};
}

Coupling PieceContact::coupling(const ContactLaw& law,
                                const std::array<std::size_t, 4>& points) const {
  constexpr std::array<double, 4> weight_by_s{0, 0, 1, -1};
  const ContactLaw::Slopes slopes = law.slopes(d_, u_);
  const Vec by_gap[3] = {load3(&slopes.by_gap[0]), load3(&slopes.by_gap[3]),
                         load3(&slopes.by_gap[6])};
  const double u_by_s[3] = {u_by_s_.x, u_by_s_.y, u_by_s_.z};
  const Vec axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Vec along = length_ * law.force(d_, u_);
  Coupling all;
  for (std::size_t a = 0; a < 4; ++a) {
    Coupling::End& end = all.ends[a];
    end.point = points[a];
    for (std::size_t r = 0; r < 3; ++r) {
      const double by_s = dot(by_gap[r], d_by_s_) + slopes.by_velocity * u_by_s[r];
      end.onto[r] = weight_[a] * axes[r];
      end.by_place[r] = length_ * (weight_[a] * by_gap[r] + by_s * s_by_[a]);
      end.by_velocity[r] = (length_ * weight_[a] * slopes.by_velocity) * axes[r];
    }
    end.onto[3] = weight_by_s[a] * along;
    end.by_place[3] = s_by_[a];
  }
  return all;
}

}  // namespace tress::models
