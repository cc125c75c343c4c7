#include "models/constrained/tinkertoys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "contract/input_error.h"
#include "contract/system.h"
#include "models/constrained/angles.h"
#include "models/constrained/joints.h"
#include "models/effects/gravity.h"

namespace tress::models {
namespace {

constexpr std::string_view structure_names[] = {"chain", "ring", "net", "tree", "truss"};
constexpr int least_size[] = {1, 3, 1, 1, 1};
constexpr int largest_size[] = {100'000, 100'000, 300, 16, 10'000};

constexpr Parameter declared_of_tinkertoys[] = {
    {.name = "structure",
     .help = "assembly of links and particles",
     .choices = "chain|ring|net|tree|truss"},
    {.name = "size",
     .help = "links, side particles, levels or bays",
     .number = 4,
     .min = 1,
     .max = 100'000,
     .whole = true},
    {.name = "mass_kg",
     .help = "mass of all particles together (kg)",
     .number = 1,
     .min = 1e-12,
     .max = 1e6},
    {.name = "length_m",
     .help = "length of the structure (m)",
     .number = 1,
     .min = 1e-6,
     .max = 1e6},
    gravity_parameter,
    hanging_drag_parameter,
    hanging_spin_parameter,
};

/// Adds a structure to a scene whose particles are all identical.
struct Builder {
  ParticleScene scene;
  double mass;    // kg per particle
  double length;  // m of strand per particle

  Node particle(Vec x) { return scene.add_particle(mass, x, {}, length); }

  Vec place(Node node) const {
    const auto i = static_cast<std::size_t>(node.index);
    return node.kind == Node::Kind::anchor ? scene.anchors[i].x : scene.particles[i].x;
  }
  double gap(Node a, Node b) const {
    const Vec d = place(a) - place(b);
    return norm(d);
  }
  void bar(Node a, Node b) { scene.constraints.push_back(distance(a, b, gap(a, b))); }
};

/// s x s particles in the horizontal plane, hanging from s anchors along the x axis.
void build_net(Builder& b, int size, double side) {
  const double cell = side / size;
  std::vector<Node> above;
  above.reserve(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) above.push_back(b.scene.add_anchor(Vec{i * cell, 0, 0}));
  for (int row = 1; row <= size; ++row) {
    std::vector<Node> here;
    for (int i = 0; i < size; ++i) {
      here.push_back(b.particle({i * cell, row * cell, 0}));
      b.bar(above[static_cast<std::size_t>(i)], here.back());
      if (i > 0) b.bar(here[static_cast<std::size_t>(i) - 1], here.back());
    }
    above = here;
  }
}

/// Binary tree growing along x: each branch halves the spread, so no two ends meet.
void build_tree(Builder& b, int levels, double height) {
  const double step = height / levels;
  constexpr double half_fork = std::numbers::pi / 6;  // rad, of the lowest fork
  struct Tip {
    Node node;
    double heading;
  };
  const Node root = b.scene.add_anchor(Vec{});
  std::vector<Tip> tips{{b.particle({step, 0, 0}), 0}};
  b.bar(root, tips.front().node);
  double spread = half_fork;
  for (int level = 1; level < levels; ++level, spread /= 2) {
    std::vector<Tip> next;
    for (const Tip& tip : tips) {
      for (const double turn : {-spread, spread}) {
        const double heading = tip.heading + turn;
        const Vec along{step * std::cos(heading), 0, step * std::sin(heading)};
        next.push_back({b.particle(b.place(tip.node) + along), heading});
        b.bar(tip.node, next.back().node);
      }
      const std::size_t last = next.size() - 1;
      b.scene.constraints.push_back(
          angle(next[last - 1].node, tip.node, next[last].node, 2 * spread));
    }
    tips = next;
  }
}

/// A triangular prism of s bays along x, every bar of every bay: 3 along, 6 across, 3
/// round.
void build_truss(Builder& b, int bays, double length) {
  const double bay = length / bays;
  const auto triangle = [&b, bay](double x) {
    const double rise = bay * std::numbers::sqrt3 / 2;
    return std::array{b.particle({x, 0, 0}), b.particle({x, bay / 2, rise}),
                      b.particle({x, -bay / 2, rise})};
  };
  std::array<Node, 3> from = triangle(0);
  b.scene.constraints.push_back(fixed_point(from[0], b.scene.add_anchor(Vec{})));
  b.scene.constraints.push_back(rigid_triangle(
      from[0], from[1], from[2],
      {b.gap(from[0], from[1]), b.gap(from[1], from[2]), b.gap(from[2], from[0])}));
  for (int i = 1; i <= bays; ++i) {
    const std::array<Node, 3> to = triangle(i * bay);
    for (const Node& near : from) {
      for (const Node& far : to) b.bar(near, far);
    }
    for (std::size_t k = 0; k < 3; ++k) b.bar(to[k], to[(k + 1) % 3]);
    from = to;
  }
}

int particle_count(Structure structure, int size) {
  switch (structure) {
    case Structure::net:
      return size * size;
    case Structure::tree:
      return (1 << size) - 1;
    case Structure::truss:
      return 3 * (size + 1);
    default:
      return size;
  }
}

}  // namespace

ParticleScene tinkertoys(const ToyShape& shape) {
  const auto kind = static_cast<std::size_t>(shape.structure);
  if (shape.size < least_size[kind] || shape.size > largest_size[kind]) {
    throw InputError("size = " + std::to_string(shape.size) + " does not make a " +
                         std::string(structure_names[kind]),
                     "tinkertoys",
                     "give a size between " + std::to_string(least_size[kind]) + " and " +
                         std::to_string(largest_size[kind]));
  }
  if (shape.structure == Structure::chain || shape.structure == Structure::ring) {
    return inextensible_chain({shape, shape.size, shape.structure == Structure::ring});
  }
  if (shape.structure == Structure::net && shape.spin != 0) {
    throw InputError("a net on a row of anchors cannot spin", "tinkertoys",
                     "give spin_rad_s = 0 or another structure");
  }
  const int count = particle_count(shape.structure, shape.size);
  Builder b{{}, shape.mass / count, shape.length / count};
  if (shape.structure == Structure::net) build_net(b, shape.size, shape.length);
  if (shape.structure == Structure::tree) build_tree(b, shape.size, shape.length);
  if (shape.structure == Structure::truss) build_truss(b, shape.size, shape.length);
  spin_about_z(b.scene, shape.spin);
  add_gravity_and_drag(b.scene, shape.gravity, shape.drag, shape.length);
  return std::move(b.scene);
}

std::span<const Parameter> tinkertoys_parameters() { return declared_of_tinkertoys; }

std::unique_ptr<System> make_tinkertoys(const Parameters& parameters) {
  const auto name = std::find(std::begin(structure_names), std::end(structure_names),
                              parameters.word("structure"));
  const ToyShape shape{hanging_shape(parameters),
                       static_cast<Structure>(name - std::begin(structure_names)),
                       parameters.whole("size")};
  return std::make_unique<ParticleSystem>(tinkertoys(shape));
}

}  // namespace tress::models
