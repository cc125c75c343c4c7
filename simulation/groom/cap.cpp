#include "simulation/groom/cap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "simulation/groom/frames.h"

namespace tress::simulation {
namespace {

/// Position, in cells, where ascending sums reach a share of the last one.
double found(std::span<const double> sums, double share) {
  const double wanted = share * sums.back();
  const auto after = std::ranges::upper_bound(sums, wanted) - sums.begin();
  const auto j =
      std::clamp<std::size_t>(static_cast<std::size_t>(after), 1, sums.size() - 1);
  const double width = sums[j] - sums[j - 1];
  const double part = width > 0 ? (wanted - sums[j - 1]) / width : 0;
  return static_cast<double>(j - 1) + std::clamp(part, 0.0, 1.0);
}

}  // namespace

Cap::Cap(Vec centre, Vec half_axes, Vec axis, double angle)
    : centre_(centre), half_(half_axes), axis_(axis), angle_(angle), below_{0} {
  const bool steep = std::abs(axis.z) > 0.5;
  first_ = across(axis, steep ? Vec{1, 0, 0} : Vec{0, 0, 1});
  second_ = cross(axis, first_);
  const double ring = angle / cells, turn = 2 * std::numbers::pi / cells;
  for (int i = 0; i < cells; ++i) {
    const double polar = ring * (i + 0.5);
    // The exact area of the ring on the unit sphere, by cells.
    const double cell = turn * (std::cos(ring * i) - std::cos(ring * (i + 1)));
    double sum = 0;
    before_.push_back(0);
    for (int j = 0; j < cells; ++j) {
      sum += cell * stretch(unit(polar, turn * (j + 0.5)));
      before_.push_back(sum);
    }
    area_ += sum;
    below_.push_back(area_);
  }
}

Vec Cap::unit(double polar, double azimuth) const {
  const double s = std::sin(polar);
  return std::cos(polar) * axis_ + s * std::cos(azimuth) * first_ +
         s * std::sin(azimuth) * second_;
}

double Cap::stretch(const Vec& u) const {
  // |d1 x d2| of the images of two orthogonal unit tangents: det(D) |D^-1 u|.
  return std::hypot(half_.y * half_.z * u.x, half_.z * half_.x * u.y,
                    half_.x * half_.y * u.z);
}

Cap::Place Cap::place(double along, double around) const {
  const double ring = found(below_, along);
  const auto row = std::min<std::size_t>(static_cast<std::size_t>(ring), cells - 1);
  const std::span sums(before_.data() + row * (cells + 1), cells + 1);
  const double turned = found(sums, around) / cells;
  // Within a ring, area is proportional to the change of the cosine of the polar angle.
  const double inner = std::cos(angle_ / cells * static_cast<double>(row));
  const double outer = std::cos(angle_ / cells * static_cast<double>(row + 1));
  const double cosine = std::lerp(inner, outer, ring - static_cast<double>(row));
  const Vec u =
      unit(std::acos(std::clamp(cosine, -1.0, 1.0)), 2 * std::numbers::pi * turned);
  const Vec normal{u.x / half_.x, u.y / half_.y, u.z / half_.z};
  return {centre_ + Vec{half_.x * u.x, half_.y * u.y, half_.z * u.z},
          1 / std::hypot(normal.x, normal.y, normal.z) * normal};
}

}  // namespace tress::simulation
