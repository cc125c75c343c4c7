#pragma once

#include <numbers>
#include <span>
#include <string_view>

#include "math/vec3.h"

namespace tress::experiments::other_simulators {

/// Dry friction in other simulators, in mm, mg and s as in `swing`.

/// A block at rest on a plane z = 0 under gravity that is tilted by atan(tangent)
/// towards +x.
struct Slope {
  double tangent, friction;

  static constexpr double mass = 10;                      // mg
  static constexpr Vec half{5, 2, 1};                     // mm
  static constexpr double settling = 0.2, watched = 0.5;  // s
  Vec gravity() const;                                    // mm/s^2
  static Vec moments();                                   // mg mm^2
};

/// Chain of straight links with ball joints about half of a fixed cylinder along y, its
/// middles touching. Both ends are pulled down, the second by `ratio` times the force on
/// the first. No gravity. It slides if that exceeds the product over all links of (1 + mu
/// tan(d/2))/(1
/// - mu tan(d/2)), d = pi/links, which is near e^(mu pi).
struct Capstan {
  int links;
  double ratio, friction;

  static constexpr double radius = 10, link_radius = 0.5;  // mm
  static constexpr double mass = 1;                        // mg, of a link
  static constexpr double pull = 2e3;                      // mg mm/s^2
  static constexpr double watched = 2;                     // s
  double turn() const { return std::numbers::pi / links; }
  double link_length() const;
  double moment() const;  // of a link about its centre, any axis, mg mm^2
  /// Returns the centre of link i. The next two: the angle by which its axis is turned
  /// about y from x towards -z, and the place of the joint before it (i = links: of the
  /// end).
  Vec centre(int i) const;
  double angle(int i) const;
  Vec joint(int i) const;
  double slides_at() const;  // ratio
};

/// One way of an engine to solve contact.
struct RubbingMethod {
  std::string_view name;
  /// Way of the block along x (mm) while it is watched, after it has settled.
  double (*slope)(const Slope& slope, double dt);
  /// Way of the first link's middle (mm); null: not built.
  double (*capstan)(const Capstan& capstan, double dt);
};

std::span<const RubbingMethod> simbody_rubbing();
std::span<const RubbingMethod> bullet_rubbing();
std::span<const RubbingMethod> mujoco_rubbing();
std::span<const RubbingMethod> ode_rubbing();

}  // namespace tress::experiments::other_simulators
