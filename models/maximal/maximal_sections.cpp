// Sections at the ends of a strand of redundant coordinates.
#include <algorithm>
#include <cmath>

#include "math/quaternion.h"
#include "models/maximal/edge_reference.h"
#include "models/maximal/maximal_system.h"

namespace tress::models {
namespace {

/// omega and alpha of an edge that turns with its direction e and an angle.
void move_edge(const EdgeTurn& turn, const Vec& de, const Vec& dde, double rate,
               double second, SectionMotion& m) {
  const double l = turn.length;
  const Vec dt = (1 / l) * (de - dot(turn.t, de) * turn.t);
  const double along = rate + dot(turn.c, de);
  m.omega = turn.spin(de, rate);
  m.alpha =
      (1 / l) * cross(turn.t, dde) - (2 * dot(turn.t, de) / (l * l)) * cross(turn.t, de) +
      (second + dot(turn.c, dde) + dot(rate_of_c(turn, de), de)) * turn.t + along * dt;
}

/// Any frame with this tangent, for strands without a frame.
Frame frame_along(const Vec& t) {
  const Vec least = std::abs(t.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  const Vec e1 = cross(least, t);
  const Vec unit = (1 / norm(e1)) * e1;
  return {t, unit, cross(t, unit)};
}

Quaternion conjugate(const Quaternion& q) { return {q.w, -1.0 * q.v}; }

}  // namespace

/// Constraints prescribe the frame at a root that is clamped by them.
std::optional<EndTurn> MaximalSystem::end_turn(int point) const {
  const bool tip = point + 1 == static_cast<int>(strand_.shown.size());
  const bool root = point == 0 && !strand_.clamped;
  if (strand_.nodes < 2 || (!tip && !root)) return {};
  return strand_.elasticity->end_turn(tip);
}

Sections::Kind MaximalSystem::section_kind(int point) const {
  const std::optional<EndTurn> turn = end_turn(point);
  if (!turn) return {};
  const bool whole = turn->angle >= 0 || turn->quaternion >= 0;
  return {whole ? Turning::frame : Turning::tangent, !strand_.edges.empty(), whole};
}

std::vector<int> MaximalSystem::section_coordinates(int point) const {
  const EndTurn turn = end_turn(point).value();
  std::vector<int> all;
  const auto append = [&](int first, int count) {
    for (int k = 0; k < count; ++k) {
      const int coordinate = first + k - static_cast<int>(held());
      if (coordinate >= 0) all.push_back(coordinate);
    }
  };
  if (turn.quaternion >= 0) {
    append(turn.quaternion, 4);
    return all;
  }
  append(static_cast<int>(first_of_end(point)), 6);
  if (turn.angle >= 0) append(turn.angle, 1);
  return all;
}

/// At the coordinates of place().
Frame MaximalSystem::frame_of(int point, const EndTurn& turn) const {
  const Frame& to_section = point == 0 ? strand_.to_root : strand_.to_tip;
  if (turn.quaternion >= 0) {
    const Quaternion p = load_quaternion(&z_[static_cast<std::size_t>(turn.quaternion)]);
    return axes((1 / std::sqrt(dot(p, p))) * p) * to_section;
  }
  const std::size_t first = first_of_end(point);
  const Vec e = load3(&z_[first + 3]) - load3(&z_[first]);
  // Without a frame the rest shape of the half edge has no direction.
  if (turn.angle < 0) return edge_frame(frame_along((1 / norm(e)) * e), e, 0.0);
  return edge_frame(turn.reference, e, z_[static_cast<std::size_t>(turn.angle)]) *
         to_section;
}

Frame MaximalSystem::section_frame(double t, In q, int point) {
  place(t, q);
  return frame_of(point, end_turn(point).value());
}

SectionMotion MaximalSystem::section(double t, In q, In v, In a, int point) {
  place(t, q, v);
  std::ranges::copy(a, force_.begin() + static_cast<std::ptrdiff_t>(held()));
  if (strand_.clamped) store3(pose_.a, force_.data());
  const EndTurn turn = end_turn(point).value();
  SectionMotion m;
  m.frame = frame_of(point, turn);
  if (turn.quaternion >= 0) {
    const auto at = [&](In x) {
      return load_quaternion(&x[static_cast<std::size_t>(turn.quaternion)]);
    };
    const Quaternion p = at(z_), rate = at(rate_);
    const double square = dot(p, p);
    m.omega = (2 / square) * (rate * conjugate(p)).v;
    m.alpha = (2 / square) * (at(force_) * conjugate(p)).v -
              (2 * dot(p, rate) / square) * m.omega;
  } else {
    const std::size_t first = first_of_end(point);
    const auto along = [&](In x) { return load3(&x[first + 3]) - load3(&x[first]); };
    const auto angle = [&](In x) {
      return turn.angle < 0 ? 0 : x[static_cast<std::size_t>(turn.angle)];
    };
    const Vec e = along(z_);
    const Vec tangent = turn.angle < 0 ? (1 / norm(e)) * e : turn.reference.e0;
    move_edge(EdgeTurn(tangent, e), along(rate_), along(force_), angle(rate_),
              angle(force_), m);
  }
  return m;
}

void MaximalSystem::add_moment(double t, In q, int point, const Vec& moment, InOut b) {
  place(t, q);
  const EndTurn turn = end_turn(point).value();
  const auto add = [&](std::size_t coordinate, double value) {
    if (coordinate >= held()) b[coordinate - held()] += value;
  };
  if (turn.quaternion >= 0) {
    const auto first = static_cast<std::size_t>(turn.quaternion);
    const Quaternion p = load_quaternion(&z_[first]);
    for (int k = 0; k < 4; ++k) {
      const Vec w = (2 / dot(p, p)) * (unit_quaternion(k) * conjugate(p)).v;
      add(first + static_cast<std::size_t>(k), dot(moment, w));
    }
    return;
  }
  const std::size_t first = first_of_end(point);
  const Vec e = load3(&z_[first + 3]) - load3(&z_[first]);
  const EdgeTurn edge(turn.angle < 0 ? (1 / norm(e)) * e : turn.reference.e0, e);
  // Without an angle nothing turns the section about its tangent.
  const double along = turn.angle < 0 ? 0 : dot(moment, edge.t);
  const Vec force = edge.force(moment - (dot(moment, edge.t) - along) * edge.t);
  const double components[3] = {force.x, force.y, force.z};
  for (std::size_t k = 0; k < 3; ++k) {
    add(first + k, -components[k]);
    add(first + 3 + k, components[k]);
  }
  if (turn.angle >= 0) add(static_cast<std::size_t>(turn.angle), along);
}

}  // namespace tress::models
