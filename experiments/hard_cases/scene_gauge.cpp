#include "experiments/hard_cases/scene_gauge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "experiments/hard_cases/gauges.h"

namespace tress::experiments::hard_cases {
namespace {

/// Work of gravity per mass over a metre (J/kg), and the least stiffness of a regularised
/// body (N/m^2); infinite: there is none.
struct Fall {
  double gravity = 0, stiffness = std::numeric_limits<double>::infinity();

  explicit Fall(const Scene& scene) {
    for (const auto& effect : scene.effects) {
      const Parameters& given = effect.parameters;
      if (given.knows("gravity_m_s2")) gravity = norm(given.vec("gravity_m_s2"));
      if (given.knows("friction_law") && given.word("friction_law") == "regularised") {
        stiffness = std::min(stiffness, given.number("stiffness_n_m2"));
      }
    }
  }

  /// Depth at which a strand that falls by its length comes to rest in the body, where
  /// the springs have its energy: m g L = k L d^2 / 2.
  double depth(const Strand& strand) const {
    return std::sqrt(2 * strand.mass() * gravity / stiffness);
  }
};

double allowed_depth(const Scene& scene) {
  const Fall fall(scene);
  double most = 0;
  for (const Strand& strand : scene.strands) {
    most = std::max({most, hard_cases::allowed_depth(strand), fall.depth(strand)});
  }
  return most;
}

}  // namespace

SceneGauge::SceneGauge(const Scene& scene, World& world, const SceneCriteria& criteria)
    : scene_(scene), world_(world) {
  criteria_.push_back(
      {"stretch", "no piece is longer or shorter than at rest by more, over its length",
       criteria.stretch, [this] { return world_.stretch(); },
       [this] { return stretched_place(); }});
  for (const auto& effect : make_effects(scene)) {
    if (effect->penetration(world.time(), {})) bodies_.push_back(effect);
  }
  if (!bodies_.empty()) {
    criteria_.push_back({"depth_m",
                         "no point is deeper in a body than at the start by more",
                         criteria.depth > 0 ? criteria.depth : allowed_depth(scene),
                         [this, start = depth()] { return depth() - start; },
                         [this] { return place(deepest_, "point"); }});
  }
  if (criteria.energy_gain > 0) {
    criteria_.push_back({"energy_gain_j", "no more energy than at the start by more",
                         criteria.energy_gain,
                         [this, start = energy()] { return energy() - start; },
                         [] { return "all strands"; }});
  }
}

/// Comparisons are written so that NaN violates a limit.
const SceneGauge::Criterion* SceneGauge::broken() {
  for (Criterion& criterion : criteria_) {
    const double now = criterion.read();
    if (now <= criterion.largest) continue;
    criterion.largest = now;
    if (!(now <= criterion.limit)) return &criterion;
  }
  return nullptr;
}

const SceneGauge::Criterion& SceneGauge::nearest() const {
  return *std::ranges::max_element(criteria_, {}, [](const Criterion& criterion) {
    return criterion.largest / criterion.limit;
  });
}

double SceneGauge::energy() const {
  const Energies now = world_.energies();
  return std::accumulate(now.effects.begin(), now.effects.end(),
                         now.kinetic + now.elastic);
}

double SceneGauge::depth() {
  const In x = world_.positions();
  double most = 0;
  for (std::size_t i = 0; 3 * i < x.size(); ++i) {
    for (const auto& body : bodies_) {
      const double one = *body->penetration(world_.time(), x.subspan(3 * i, 3));
      if (one <= most) continue;
      most = one;
      deepest_ = i;
    }
  }
  return most;
}

/// By chords: a system reports the strain of the worst segment, not its index.
std::string SceneGauge::stretched_place() const {
  const std::vector<double>& x = world_.positions();
  double most = 0;
  std::size_t worst = 0, i = 0;
  for (const Strand& strand : scene_.strands) {
    ++i;  // the root
    for (const Segment& segment : strand.segments) {
      const auto from = static_cast<std::size_t>(world_.before()[i]);
      const double chord = norm(load3(&x[3 * i]) - load3(&x[3 * from]));
      const double off = std::abs(chord / segment.length - 1);
      if (off > most) {
        most = off;
        worst = i;
      }
      ++i;
    }
  }
  return worst > 0 ? place(worst, "element") : "all strands";
}

/// Element i ends at point i + 1.
std::string SceneGauge::place(std::size_t point, std::string_view what) const {
  std::size_t strand = 0;
  for (const Strand& one : scene_.strands) {
    const std::size_t points = one.segments.size() + 1;
    if (point < points) break;
    point -= points;
    ++strand;
  }
  return fmt::format("strand {}, {} {}", strand, what,
                     what == "element" ? point - 1 : point);
}

}  // namespace tress::experiments::hard_cases
