// Compiled without errno, so that the roots of all lanes are one instruction.
#include "models/contact/pieces/piece_approach.h"

#include <algorithm>

#include "math/lane_choice.h"
#include "math/lanes.h"

namespace tress::models {
namespace {

constexpr auto four = static_cast<std::size_t>(Pack::lanes);

/// Of four pieces.
struct Motions {
  Vec3<Pack> middle, half, moved;
  Pack turned;
};

Motions motions(const PieceMotion* const (&of)[four]) {
  const auto each = [&](auto number) {
    return Pack(number(*of[0]), number(*of[1]), number(*of[2]), number(*of[3]));
  };
  const auto vectors = [&](Vec PieceMotion::*member) {
    return Vec3<Pack>{each([=](const PieceMotion& m) { return (m.*member).x; }),
                      each([=](const PieceMotion& m) { return (m.*member).y; }),
                      each([=](const PieceMotion& m) { return (m.*member).z; })};
  };
  return {vectors(&PieceMotion::middle), vectors(&PieceMotion::half),
          vectors(&PieceMotion::moved),
          each([](const PieceMotion& m) { return m.turned; })};
}

Pack length(const Vec3<Pack>& x) { return square_root(dot(x, x)); }

/// 0 of what is not positive.
Pack inverse_of(const Pack& x) { return where_less(Pack(0), x, Pack(1) / x, Pack(0)); }

Pack within_piece(const Pack& s) { return larger(smaller(s, Pack(1)), Pack(-1)); }

/// Returns the least distance of each pair. The nearest points are middle + s half of the
/// first and middle + t half of the second piece. They are those of the lines, and where
/// these are beyond an end the ones nearest to it. On parallel lines any points across
/// from each other serve.
Pack least_approach(const Motions& first, const Motions& second) {
  constexpr double parallel = 1e-9;  // squared sine of an angle
  const Vec3<Pack> between = second.middle - first.middle;
  const Pack a = dot(first.half, first.half), e = dot(second.half, second.half),
             b = dot(first.half, second.half), c = dot(first.half, between),
             f = dot(second.half, between);
  const Pack by_a = inverse_of(a), by_e = inverse_of(e), determinant = a * e - b * b;
  const Pack of_lines =
      where_less(parallel * a * e, determinant, (c * e - b * f) / determinant, c * by_a);
  Pack s = within_piece(of_lines);
  const Pack t = within_piece((b * s - f) * by_e);
  s = within_piece((b * t + c) * by_a);
  const Vec3<Pack> gap = between + t * second.half - s * first.half;
  return length(gap) -
         Pack(0.5) * (length(first.moved - second.moved) + first.turned + second.turned);
}

}  // namespace

PieceMotion::PieceMotion(const Vec& from0, const Vec& to0, const Vec& from1,
                         const Vec& to1)
    : middle(0.25 * (from0 + to0 + from1 + to1)),
      half(0.25 * (from1 + to1 - from0 - to0)),
      moved(0.5 * (to0 - from0 + to1 - from1)),
      turned(0.5 * norm(to1 - from1 - (to0 - from0))) {}

void least_approaches(std::span<const PieceMotion> motion,
                      std::span<BoxPairs::Pair> pairs) {
  for (std::size_t at = 0; at < pairs.size(); at += four) {
    const std::size_t count = std::min(four, pairs.size() - at);
    const PieceMotion *first[four], *second[four];
    for (std::size_t lane = 0; lane < four; ++lane) {
      // Lanes beyond the last pair repeat it.
      const BoxPairs::Pair& pair = pairs[at + std::min(lane, count - 1)];
      first[lane] = &motion[static_cast<std::size_t>(pair.first)];
      second[lane] = &motion[static_cast<std::size_t>(pair.second)];
    }
    const Pack least = least_approach(motions(first), motions(second));
    for (std::size_t lane = 0; lane < count; ++lane) {
      pairs[at + lane].distance = least[static_cast<int>(lane)];
    }
  }
}

}  // namespace tress::models
