#include "simulation/groom/usd_transform.h"

#include <array>
#include <cmath>
#include <numbers>

#include "math/quaternion.h"

namespace tress::simulation {
namespace {

Mat3 matrix_of(const Frame& f) {
  return {{f.e0.x, f.e1.x, f.e2.x}, {f.e0.y, f.e1.y, f.e2.y}, {f.e0.z, f.e1.z, f.e2.z}};
}

Vec axis_of(char letter) {
  return {letter == 'X' ? 1.0 : 0, letter == 'Y' ? 1.0 : 0, letter == 'Z' ? 1.0 : 0};
}
bool is_axis(char c) { return c >= 'X' && c <= 'Z'; }

Mat3 rotated(char axis, double degrees) {
  return matrix_of(rotation(axis_of(axis), degrees * std::numbers::pi / 180));
}

/// Rotations about the axes of `letters`, the first one first, by the angle of each.
std::optional<Affine> rotations(std::string_view letters, std::span<const double> x) {
  if (letters.size() == 1 && x.size() == 1) return Affine{rotated(letters[0], x[0]), {}};
  if (letters.size() != 3 || x.size() != 3) return std::nullopt;
  Affine all;
  for (const char c : letters) {
    all.linear = rotated(c, x[static_cast<std::size_t>(c - 'X')]) * all.linear;
  }
  return all;
}

std::optional<Affine> orientation(std::span<const double> x) {
  if (x.size() != 4) return std::nullopt;
  const Quaternion q{x[0], {x[1], x[2], x[3]}};
  const double square = dot(q, q);
  if (!(square > 0)) return std::nullopt;
  return Affine{1 / square * matrix_of(axes(q)), {}};
}

std::optional<Affine> matrix(std::span<const double> x) {
  if (x.size() != 16 || x[3] != 0 || x[7] != 0 || x[11] != 0 || x[15] != 1) {
    return std::nullopt;
  }
  return Affine{{{x[0], x[4], x[8]}, {x[1], x[5], x[9]}, {x[2], x[6], x[10]}},
                {x[12], x[13], x[14]}};
}

}  // namespace

std::optional<Affine> inverse(const Affine& a) {
  const auto& [r0, r1, r2] = a.linear;
  const Vec c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  const double determinant = dot(r0, c0);
  if (!std::isnormal(determinant)) return std::nullopt;
  const Mat3 back = 1 / determinant * matrix_of(Frame{c0, c1, c2});
  return Affine{back, -1.0 * (back * a.shift)};
}

std::optional<Affine> usd_operation(std::string_view name, std::span<const double> x) {
  constexpr std::string_view prefix = "xformOp:";
  if (!name.starts_with(prefix)) return std::nullopt;
  name.remove_prefix(prefix.size());
  const std::string_view kind = name.substr(0, name.find(':'));
  if (kind == "transform") return matrix(x);
  if (kind == "orient") return orientation(x);
  const auto after = [kind](std::string_view verb) { return kind.substr(verb.size()); };
  if (kind.starts_with("rotate")) {
    const std::string_view letters = after("rotate");
    constexpr std::array<std::string_view, 9> known{"X",   "Y",   "Z",   "XYZ", "XZY",
                                                    "YXZ", "YZX", "ZXY", "ZYX"};
    for (const std::string_view one : known) {
      if (letters == one) return rotations(letters, x);
    }
    return std::nullopt;
  }
  const bool moves = kind.starts_with("translate");
  if (!moves && !kind.starts_with("scale")) return std::nullopt;
  const std::string_view letter = after(moves ? "translate" : "scale");
  Vec by;
  if (letter.empty() && x.size() == 3) {
    by = load3(x.data());
  } else if (letter.size() == 1 && is_axis(letter[0]) && x.size() == 1) {
    const Vec along = axis_of(letter[0]);
    by = moves ? x[0] * along : Vec{1, 1, 1} + (x[0] - 1) * along;
  } else {
    return std::nullopt;
  }
  return moves ? Affine{identity(), by} : Affine{diagonal(by), {}};
}

}  // namespace tress::simulation
