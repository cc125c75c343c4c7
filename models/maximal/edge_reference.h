#pragma once

#include <cmath>
#include <cstddef>

#include "models/maximal/rod_edge.h"
#include "models/motion/teleport.h"

namespace tress::models {

/// The earlier reference of an edge whose reference renew_reference() has replaced.
struct Replaced {
  std::size_t edge;  // index of the edge
  Frame reference;   // its earlier reference
};

/// dc/dt of EdgeTurn's c for an edge vector that changes at the rate de.
inline Vec rate_of_c(const EdgeTurn& turn, const Vec& de) {
  const double along = 1 + dot(turn.a, turn.t), stretching = dot(turn.t, de);
  const Vec turning = (1 / turn.length) * (de - stretching * turn.t);
  const double rate = stretching * along + turn.length * dot(turn.a, turning);
  return (1 / (turn.length * along)) * (cross(turning, turn.a) - rate * turn.c);
}

/// Carries the reference of an edge's angle, and the rate of the angle, at a teleport.
/// `e`: the edge's vector after it.
inline void displace(const Displacement& by, const Vec& e, Frame& reference,
                     double& theta_rate) {
  reference = by.turn * reference;
  const EdgeTurn turn(reference.e0, e);
  const Vec spin = by.spin();
  theta_rate += dot(spin, turn.t) - dot(turn.c, cross(spin, e));
}

/// Replaces the reference of an edge's angle along a motion. The angle theta and its
/// derivatives become those relative to `to`, with the same frame, spin and rate of the
/// spin. The edge's vector and its derivatives are e, de and dde. On return theta is
/// within half a turn of 0.
inline void refer(const Frame& from, const Frame& to, const Vec& e, const Vec& de,
                  const Vec& dde, double& theta, double& theta_rate,
                  double& theta_second) {
  const EdgeTurn old(from.e0, e), now(to.e0, e);
  const Frame frame = edge_frame(from, e, theta), zero = edge_frame(to, e, 0.0);
  theta = std::atan2(dot(zero.e2, frame.e1), dot(zero.e1, frame.e1));
  const Vec less = old.c - now.c;
  theta_rate += dot(less, de);
  theta_second += dot(less, dde) + dot(rate_of_c(old, de) - rate_of_c(now, de), de);
}

}  // namespace tress::models
