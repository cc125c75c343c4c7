#include "models/contact/pieces/piece_touch.h"

#include <cmath>

namespace tress::models {
namespace {

// Pieces that pass each other's ends by this part of their lengths still meet: joints of
// a polyline have no holes.
constexpr double beyond_end = 1e-6;

Vec between(const Vec& from, const Vec& to, double part) {
  return (1 - part) * from + part * to;
}

struct Pieces {
  StraightPiece first, second;
};
Pieces at(const MovingPieces& p, double part) {
  std::array<Vec, 4> x;
  for (std::size_t a = 0; a < 4; ++a) x[a] = between(p.from[a], p.to[a], part);
  return {{x[0], x[1]}, {x[2], x[3]}};
}

/// Six times the volume that the four ends span: 0 where they are coplanar.
double volume(const Pieces& p) {
  return dot(cross(p.first.edge, p.second.edge), p.second.start - p.first.start);
}

/// Calls found(part) at every root in (0, 1] of the cubic with the values y at parts 0,
/// 1/3, 2/3 and 1, in ascending order, until it returns true.
template <class F>
void each_root(const std::array<double, 4>& y, F found) {
  // c0 + c1 x + c2 x^2 + c3 x^3
  const double c0 = y[0], c1 = 0.5 * (-11 * y[0] + 18 * y[1] - 9 * y[2] + 2 * y[3]),
               c2 = 4.5 * (2 * y[0] - 5 * y[1] + 4 * y[2] - y[3]),
               c3 = 4.5 * (-y[0] + 3 * y[1] - 3 * y[2] + y[3]);
  const auto value = [&](double x) { return c0 + x * (c1 + x * (c2 + x * c3)); };
  // It is monotonous between the roots of its derivative.
  std::array<double, 4> ends{0, 1, 1, 1};
  std::size_t count = 1;
  const double half = c2, square = half * half - 3 * c1 * c3;
  if (square > 0) {
    const double q = -(half + std::copysign(std::sqrt(square), half));
    const double one = q / (3 * c3), other = q == 0 ? 0 : c1 / q;
    for (const double x : {std::fmin(one, other), std::fmax(one, other)}) {
      if (x > 0 && x < 1) ends[count++] = x;
    }
  }
  ends[count] = 1;
  for (std::size_t i = 0; i < count; ++i) {
    double from = ends[i], to = ends[i + 1];
    const bool rises = value(from) < 0;
    if (rises == (value(to) < 0)) continue;
    for (int k = 0; k < 60 && to - from > 1e-15; ++k) {
      const double middle = 0.5 * (from + to);
      ((value(middle) < 0) == rises ? from : to) = middle;
    }
    if (found(to)) return;
  }
}

/// The place of a crossing at a root; empty if the lines meet outside the pieces.
std::optional<PieceTouch> crossing(const MovingPieces& p, double part) {
  const Pieces there = at(p, part);
  const NearestPoints near = nearest(there.first, there.second);
  const Vec gap = there.first.at(near.of_first) - there.second.at(near.of_second);
  const double size = std::fmax(dot(there.first.edge, there.first.edge),
                                dot(there.second.edge, there.second.edge));
  if (dot(gap, gap) > beyond_end * beyond_end * size) return {};
  const Pieces start = at(p, 0);
  const Vec side = start.first.at(near.of_first) - start.second.at(near.of_second);
  Vec normal = cross(there.first.edge, there.second.edge);
  // Pieces that meet along one line have no common normal but the side they come from.
  const double sine = norm(normal);
  if (sine * sine < 1e-12 * dot(there.first.edge, there.first.edge) *
                        dot(there.second.edge, there.second.edge)) {
    normal = side;
  }
  const double length = norm(normal);
  if (!(length > 0)) return {};
  normal = (std::copysign(1.0, dot(normal, side)) / length) * normal;
  return PieceTouch{near.of_first, near.of_second, normal};
}

// Of the reach: where pieces are as near as it, and the steps at most until then.
constexpr double as_near = 1e-3;
constexpr int most_advances = 60;

}  // namespace

double distance(const std::array<Vec, 4>& ends) {
  const StraightPiece first(ends[0], ends[1]), second(ends[2], ends[3]);
  const NearestPoints near = nearest(first, second);
  return norm(first.at(near.of_first) - second.at(near.of_second));
}

PieceTouch first_touch(const MovingPieces& p, double reach) {
  // No two points approach each other by more: their motion is bilinear in places.
  double most = 0;
  for (const std::size_t i : {0u, 1u}) {
    for (const std::size_t j : {2u, 3u}) {
      most = std::fmax(most, norm(p.to[i] - p.from[i] - (p.to[j] - p.from[j])));
    }
  }
  PieceTouch found{};
  double part = 0;
  for (int k = 0; k < most_advances; ++k) {
    const Pieces there = at(p, part);
    const NearestPoints near = nearest(there.first, there.second);
    const Vec gap = there.first.at(near.of_first) - there.second.at(near.of_second);
    const double distance = norm(gap);
    if (distance == 0) break;
    found = {near.of_first, near.of_second, (1 / distance) * gap};
    if (part == 1 || distance <= (1 + as_near) * reach) break;
    part = std::fmin(1, part + (distance - reach) / most);
  }
  return found;
}

std::optional<PieceTouch> touch(const MovingPieces& p, double reach) {
  const std::array<double, 4> y{volume(at(p, 0)), volume(at(p, 1.0 / 3)),
                                volume(at(p, 2.0 / 3)), volume(at(p, 1))};
  std::optional<PieceTouch> found;
  each_root(y, [&](double part) { return (found = crossing(p, part)).has_value(); });
  if (found) return found;
  const Pieces end = at(p, 1);
  const NearestPoints near = nearest(end.first, end.second);
  const Vec gap = end.first.at(near.of_first) - end.second.at(near.of_second);
  const double distance = norm(gap);
  if (!(distance < reach) || distance == 0) return {};
  return PieceTouch{near.of_first, near.of_second, (1 / distance) * gap};
}

}  // namespace tress::models
