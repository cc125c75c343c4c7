#include "models/effects/piece_contact.h"

namespace tress {

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

PieceContact::Slopes PieceContact::slopes(const ContactLaw& law) const {
  Slopes at{law.slopes(d_, u_), law.force(d_, u_), {}};
  const double* by_gap = at.law.by_gap.data();
  at.by_s = Vec{dot(load3(by_gap), d_by_s_), dot(load3(by_gap + 3), d_by_s_),
                dot(load3(by_gap + 6), d_by_s_)} +
            at.law.by_velocity * u_by_s_;
  return at;
}

void PieceContact::add_block(const Slopes& slopes, std::size_t a, std::size_t c,
                             double pos, double vel, double* block) const {
  constexpr std::array<double, 4> weight_by_s{0, 0, 1, -1};
  // f_a = length W_a F: through d, and through s in d, u and W_a.
  const Vec by_s = weight_[a] * slopes.by_s + weight_by_s[a] * slopes.force;
  const double along[] = {by_s.x, by_s.y, by_s.z};
  const double both = length_ * weight_[a] * weight_[c];
  for (std::size_t row = 0; row < 3; ++row) {
    double* to = block + 3 * row;
    store3(load3(to) + (pos * both) * load3(&slopes.law.by_gap[3 * row]) +
               (pos * length_ * along[row]) * s_by_[c],
           to);
    to[row] += vel * both * slopes.law.by_velocity;
  }
}

}  // namespace tress
