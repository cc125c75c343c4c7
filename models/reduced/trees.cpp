#include "models/reduced/trees.h"

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "contract/parameters.h"
#include "math/helix.h"

namespace tress::models {
namespace {

using std::numbers::pi;

constexpr int root = -1;
constexpr Vec up{0, 0, 1};
const double golden_angle = pi * (3 - std::sqrt(5.0));  // rad, between successive shoots

constexpr double radians(double degrees) { return degrees * pi / 180; }

/// exp([turn]x): turns by |turn| (rad) about its direction.
Frame turned_by(const Vec& turn) {
  const auto f = helix_functions(1.0, dot(turn, turn), 1.0);
  const auto turned = [&](const Vec& e) {
    const Vec across = cross(turn, e);
    return e + f.S * across + f.A * cross(turn, across);
  };
  return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

/// The least turn that takes the tangent e0 to the direction `to` (not opposite to e0).
Frame least_rotation(const Vec& to) {
  const Vec e0{1, 0, 0};
  const Vec axis = cross(e0, to);
  const double sine = norm(axis);
  return sine == 0 ? Frame{} : turned_by(std::atan2(sine, dot(e0, to)) / sine * axis);
}

/// A run of equal elements. Directions are world directions for an upright root.
struct Limb {
  int elements = 1;
  double length = 0;   // m, of all elements together
  Vec heading = {};    // of its start, need not have length 1; 0: straight on
  double tropism = 0;  // 1/m: bends by tropism (t x down) per length; < 0: upwards
  Vec turn = {};       // rad: further bend and twist from its start to its end
  double radius = 0;   // m
};

/// A turtle that keeps the frame at every tip.
class Grower {
 public:
  /// Adds a limb at the tip of `parent` and returns its last element.
  int grow(int parent, const Limb& limb) {
    const double length = limb.length / limb.elements;
    Vec heading = limb.heading;
    for (int k = 0; k < limb.elements; ++k) {
      const Frame from = tip(parent);
      const Frame mount = least_rotation(from.back(heading));
      const Frame start = from * mount;
      const Vec bend = 1 / limb.length * limb.turn + limb.tropism * cross(up, start.e0);
      const Vec natural = start.back(bend);
      segments_.push_back(
          {parent, length, mount, {limb.radius, limb.radius}, natural, natural});
      tips_.push_back(start * turned_by(length * natural));
      parent = static_cast<int>(segments_.size()) - 1;
      heading = {};
    }
    return parent;
  }

  /// The direction at `tilt` from the tangent at the tip of `parent`, turned about it by
  /// `azimuth` from its e1 (rad).
  Vec aside(int parent, double tilt, double azimuth) const {
    const double out = std::sin(tilt);
    return tip(parent) *
           Vec{std::cos(tilt), out * std::cos(azimuth), out * std::sin(azimuth)};
  }

  std::vector<Segment> with_given_radii() && { return std::move(segments_); }

  /// Sets the area of every section to `area` (m^2 per m) times the length grown beyond
  /// it.
  std::vector<Segment> with_pipe_radii(double area) && {
    std::vector<double> beyond(segments_.size(), 0);
    for (std::size_t i = segments_.size(); i-- > 0;) {
      Segment& s = segments_[i];
      beyond[i] += s.length;
      if (s.parent != root) beyond[static_cast<std::size_t>(s.parent)] += beyond[i];
      const double radius = std::sqrt(area * beyond[i] / pi);
      s.section = {radius, radius};
    }
    return std::move(segments_);
  }

 private:
  Frame tip(int i) const {
    return i == root ? upright() : tips_[static_cast<std::size_t>(i)];
  }

  std::vector<Segment> segments_;
  std::vector<Frame> tips_;
};

std::vector<Segment> palm_tree() {
  Grower g;
  const int crown = g.grow(
      root, {.elements = 2, .length = 3, .heading = {-0.1, 0, 1}, .turn = {0, 0.3, 0}});
  for (int frond = 0; frond < 6; ++frond) {
    const double azimuth = frond * pi / 3;
    const double rise = frond % 2 == 0 ? 0.4 : 1.2;
    g.grow(crown, {.length = 1.6,
                   .heading = {std::cos(azimuth), std::sin(azimuth), rise},
                   .tropism = 1.2});
  }
  return std::move(g).with_pipe_radii(3e-4);
}

std::vector<Segment> algae() {
  Grower g;
  const int stalk = g.grow(root, {.length = 0.03});
  for (int stem = 0; stem < 3; ++stem) {
    const double azimuth = stem * 2 * pi / 3;
    const Vec outward{std::cos(azimuth), std::sin(azimuth), 0};
    double swing = stem == 0 ? -1.8 : 1.8;  // rad, to the other side and back
    Vec heading = std::cos(0.4 - swing / 2) * up + std::sin(0.4 - swing / 2) * outward;
    int tip = stalk;
    for (int wave = 0; wave < 3; ++wave, swing = -swing, heading = {}) {
      tip = g.grow(tip, {.length = 0.12 + 0.02 * stem,
                         .heading = heading,
                         .turn = swing * cross(up, outward)});
    }
  }
  return std::move(g).with_pipe_radii(2e-4);
}

std::vector<Segment> complex_tree() {
  Grower g;
  std::array<double, 3> azimuth{};  // of the last shoot of each order
  const auto shoot = [&](std::size_t order, int parent, double tilt, const Limb& limb) {
    azimuth[order] += golden_angle;
    Limb aside = limb;
    aside.heading = g.aside(parent, radians(tilt), azimuth[order]);
    aside.tropism = -0.3;
    return g.grow(parent, aside);
  };
  int trunk = root;
  for (int level = 0; level < 5; ++level) {
    trunk = g.grow(trunk, {.length = level == 0 ? 1.2 : 0.4});
    const int branch =
        shoot(0, trunk, 75 - 12 * level, {.elements = 3, .length = 1.7 - 0.1 * level});
    for (const int node : {branch - 2, branch - 1}) {
      const int twig = shoot(1, node, 50, {.elements = 2, .length = 0.8});
      shoot(2, twig - 1, 50, {.length = 0.4});
    }
  }
  return std::move(g).with_pipe_radii(2e-4);
}

void grow_arm(Grower& g, int chest, double side) {
  const int shoulder =
      g.grow(chest, {.length = 0.19, .heading = {0, side, 0.1}, .radius = 0.04});
  const int elbow =
      g.grow(shoulder,
             {.elements = 2, .length = 0.3, .heading = {0, side, -0.9}, .radius = 0.035});
  const int wrist = g.grow(
      elbow,
      {.elements = 2, .length = 0.26, .heading = {0.2, side, -1.6}, .radius = 0.03});
  const Vec along{0.2, side, -1.6};
  const int hand = g.grow(wrist, {.length = 0.09, .heading = along, .radius = 0.025});
  for (int finger = 0; finger < 5; ++finger) {
    const Vec spread{1.5 - 0.75 * finger, 0, 0};
    g.grow(hand, {.elements = 2,
                  .length = finger == 0 || finger == 4 ? 0.06 : 0.09,
                  .heading = along + spread,
                  .turn = {-0.5 * side, 0, 0},
                  .radius = 0.008});
  }
}

void grow_leg(Grower& g, double side) {
  const int hip =
      g.grow(root, {.length = 0.12, .heading = {0, side, -0.5}, .radius = 0.05});
  const int knee = g.grow(
      hip,
      {.elements = 2, .length = 0.42, .heading = {0.1, 0.1 * side, -1}, .radius = 0.05});
  const int ankle = g.grow(
      knee,
      {.elements = 2, .length = 0.4, .heading = {-0.1, 0.05 * side, -1}, .radius = 0.04});
  g.grow(ankle, {.length = 0.22, .heading = {1, 0.3 * side, 0}, .radius = 0.035});
}

std::vector<Segment> man() {
  Grower g;
  const int chest = g.grow(root, {.elements = 4, .length = 0.5, .radius = 0.055});
  for (const double side : {1.0, -1.0}) grow_arm(g, chest, side);
  for (const double side : {1.0, -1.0}) grow_leg(g, side);
  const int neck = g.grow(chest, {.length = 0.1, .radius = 0.04});
  // the outline of the head: one half of a circle to the crown, one back to the neck
  const Limb face{.length = 0.33, .turn = {pi, 0, 0}, .radius = 0.02};
  Limb first = face;
  first.heading = {0, 1, 0};
  const int crown = g.grow(neck, first);
  g.grow(crown, face);
  for (int hair = 0; hair < 10; ++hair) {
    const double azimuth = hair * golden_angle;
    g.grow(crown, {.elements = 3,
                   .length = 0.3,
                   .heading = {std::cos(azimuth), std::sin(azimuth), 0.3},
                   .tropism = 10,
                   .radius = 0.002});
  }
  return std::move(g).with_given_radii();
}

void grow_twigs(Grower& g, int parent, int count, double& azimuth) {
  for (int twig = 0; twig < count; ++twig) {
    azimuth += golden_angle;
    g.grow(parent, {.elements = 5,
                    .length = 1.8,
                    .heading = g.aside(parent, radians(50), azimuth),
                    .tropism = 2.5});
  }
}

std::vector<Segment> willow() {
  Grower g;
  int trunk = g.grow(root, {.elements = 2, .length = 1.6});
  double azimuth = 0, twig_azimuth = 0;
  for (const int limbs : {2, 2, 3}) {
    for (int i = 0; i < limbs; ++i) {
      azimuth += golden_angle;
      const int limb = g.grow(trunk, {.elements = 4,
                                      .length = 2.2,
                                      .heading = g.aside(trunk, radians(40), azimuth),
                                      .tropism = 0.4});
      grow_twigs(g, limb - 2, 1, twig_azimuth);
      grow_twigs(g, limb - 1, 2, twig_azimuth);
      grow_twigs(g, limb, 3, twig_azimuth);
    }
    if (limbs == 2) trunk = g.grow(trunk, {.length = 0.5});
  }
  return std::move(g).with_pipe_radii(1e-4);
}

Material isotropic(double density, double youngs_modulus, double poisson_ratio,
                   double internal_friction) {
  return {density, youngs_modulus,
          Material::shear_modulus_of(youngs_modulus, poisson_ratio), internal_friction};
}

struct TreeEntry {
  std::string_view name;
  std::vector<Segment> (*segments)();
  Material material;
};

/// Frictions: about EI 10 ms of the thinnest section.
std::span<const TreeEntry> trees() {
  const auto wood = [](double friction) { return isotropic(900, 6e9, 0.3, friction); };
  static const std::array entries = {
      TreeEntry{"palm_tree", palm_tree, wood(1)},
      TreeEntry{"algae", algae, isotropic(1050, 2e7, 0.5, 1e-5)},
      TreeEntry{"complex_tree", complex_tree, wood(3e-2)},
      TreeEntry{"man", man, isotropic(1100, 1e7, 0.5, 1e-6)},
      TreeEntry{"willow", willow, wood(6e-3)},
  };
  return entries;
}

const TreeEntry& find_tree(std::string_view name) {
  std::vector<std::string_view> names;
  for (const TreeEntry& entry : trees()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw InputError("unknown tree '" + std::string(name) + "'", "tree",
                   suggestion(name, names, "use one of " + std::string(tree_choices)));
}

}  // namespace

std::vector<Segment> tree_segments(std::string_view name) {
  return find_tree(name).segments();
}

Material tree_material(std::string_view name) { return find_tree(name).material; }

Frame upright() { return {up, {0, 1, 0}, {-1, 0, 0}}; }

}  // namespace tress::models
