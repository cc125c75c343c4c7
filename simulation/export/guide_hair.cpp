#include "simulation/export/guide_hair.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "contract/input_error.h"
#include "simulation/groom/random.h"

namespace tress::simulation {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Smooth step from 0 to 1 with flat ends, for y from 0 to 1.
double smooth(double y) {
  y = std::clamp(y, 0.0, 1.0);
  return y * y * (3 - 2 * y);
}

/// (1/d_k - 1/R)^2 over their sum; R: distance of the first guide without weight. A guide
/// at the hair's own root has all the weight; guides all at distance R have equal
/// weights.
void set_weights(GuideHair::Neighbours& neighbours, const std::array<double, 3>& distance,
                 double limit) {
  if (distance[0] == 0) {
    neighbours.weight = {1, 0, 0};
    return;
  }
  // In units of the nearest distance, so that no square overflows.
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double near = distance[0] / distance[k] - distance[0] / limit;
    sum += neighbours.weight[k] = near * near;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (sum > 0) {
      neighbours.weight[k] /= sum;
    } else {
      neighbours.weight[k] = 1.0 / 3;
    }
  }
}

/// The n guides with the nearest roots, the nearest first; ties go to the earlier one.
/// Missing ones are the first again, infinitely far.
template <std::size_t n>
struct Nearest {
  std::array<std::size_t, n> guide{};
  std::array<double, n> distance;

  Nearest(std::span<const Vec> guide_roots, const Vec& root) {
    distance.fill(infinity);
    for (std::size_t g = 0; g < guide_roots.size(); ++g) {
      const double d = norm(root - guide_roots[g]);
      if (!(d < distance[n - 1])) continue;
      std::size_t k = n - 1;
      for (; k > 0 && d < distance[k - 1]; --k) {
        distance[k] = distance[k - 1];
        guide[k] = guide[k - 1];
      }
      distance[k] = d;
      guide[k] = g;
    }
    for (std::size_t k = guide_roots.size(); k < n; ++k) guide[k] = guide[0];
  }
};

/// Moves weights as GuideHairOptions::linear says.
void make_linear(GuideHair::Neighbours& near, std::span<const Vec> guide_roots,
                 const Vec& root) {
  constexpr double stay = 1e-3;
  const auto& [guide, weight] = near;
  const Vec a = guide_roots[guide[1]] - guide_roots[guide[0]],
            b = guide_roots[guide[2]] - guide_roots[guide[0]],
            away = guide_roots[guide[0]] - root + weight[1] * a + weight[2] * b;
  // Changes x of the second and y of the third weight, -(x + y) of the first.
  const double least = stay * std::max(dot(a, a), dot(b, b));
  const double aa = dot(a, a) + 2 * least, bb = dot(b, b) + 2 * least,
               ab = dot(a, b) + least, determinant = aa * bb - ab * ab;
  if (!(determinant > 0)) return;
  const double x = (ab * dot(b, away) - bb * dot(a, away)) / determinant,
               y = (ab * dot(a, away) - aa * dot(b, away)) / determinant;
  near.weight = {weight[0] - x - y, weight[1] + x, weight[2] + y};
}

GuideHair::Neighbours neighbours_of(std::span<const Vec> guide_roots, const Vec& root,
                                    bool linear) {
  const Nearest<4> near(guide_roots, root);
  GuideHair::Neighbours neighbours{
      .guide = {near.guide[0], near.guide[1], near.guide[2]}};
  set_weights(neighbours, {near.distance[0], near.distance[1], near.distance[2]},
              near.distance[3]);
  if (linear) make_linear(neighbours, guide_roots, root);
  return neighbours;
}

/// The smallest rotation that maps the unit vector a to b, applied to `frame`. Where a
/// strand folds straight back it is not unique: the cross-section is kept.
Frame turned(const Frame& frame, const Vec& a, const Vec& b) {
  const double cosine = dot(a, b);
  if (cosine < -1 + 1e-12) return frame;
  const Vec axis = cross(a, b);
  const auto turn = [&](const Vec& e) {
    const Vec w = cross(axis, e);
    return e + w + (1 / (1 + cosine)) * cross(axis, w);
  };
  return {turn(frame.e0), turn(frame.e1), turn(frame.e2)};
}

/// T(s) H at every point of one guide. Tangents: central differences, one-sided at the
/// ends; for coincident points the previous tangent.
void carry(std::span<const Vec> guide, const Frame& head, std::span<Frame> carried) {
  const std::size_t n = guide.size();
  Vec before;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec along = guide[std::min(i + 1, n - 1)] - guide[i > 0 ? i - 1 : 0];
    const double size = norm(along);
    carried[i] = i > 0 ? carried[i - 1] : head;
    if (!(size > 0)) continue;
    const Vec tangent = (1 / size) * along;
    if (dot(before, before) > 0) carried[i] = turned(carried[i], before, tangent);
    before = tangent;
  }
}

void check(const std::vector<Vec>& guide_roots, const std::vector<Vec>& hair_roots,
           std::size_t points, const GuideHairOptions& options) {
  const auto need = [](bool holds, const std::string& problem, const char* where,
                       const char* remedy) {
    if (!holds) throw InputError(problem, where, remedy);
  };
  need(!guide_roots.empty(), "no guide to grow hair from", "guide hair",
       "simulate at least one strand");
  need(points >= 2, fmt::format("guides of {} points", points), "guide hair",
       "give every guide at least 2 points");
  need(std::ranges::all_of(guide_roots, [](const Vec& x) { return is_finite(x); }) &&
           std::ranges::all_of(hair_roots, [](const Vec& x) { return is_finite(x); }),
       "a root that is not finite", "guide hair", "give roots in m");
  const auto is_share = [](double x) { return x >= 0 && x <= 1; };
  need(is_share(options.clumpiness),
       fmt::format("clumpiness {} out of range", options.clumpiness), "clumpiness",
       "give a number from 0 (interpolated) to 1 (locks)");
  need(options.tip_limit > 0, fmt::format("tip limit {} m", options.tip_limit),
       "tip_limit", "give a positive length in m");
  need(is_share(options.tip_width),
       fmt::format("tip width {} out of range", options.tip_width), "tip_width",
       "give a number from 0 to 1");
}

}  // namespace

std::vector<Vec> scatter_roots(std::span<const Vec> guide_roots, std::size_t count,
                               std::uint64_t seed) {
  if (guide_roots.empty()) return {};
  // Two different guides of the nearest four, or of all others if there are fewer.
  const std::size_t others = std::min<std::size_t>(guide_roots.size() - 1, 4);
  Random random(seed, 1);
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
  };
  std::vector<Vec> roots;
  roots.reserve(count);
  for (std::size_t h = 0; h < count; ++h) {
    const Vec& corner = guide_roots[h % guide_roots.size()];
    const Nearest<5> near(guide_roots, corner);  // the first is the corner itself
    const std::size_t first = below(others);
    const std::size_t second =
        others < 2 ? first : (first + 1 + below(others - 1)) % others;
    const auto edge = [&](std::size_t k) {
      return guide_roots[near.guide[others == 0 ? 0 : 1 + k]] - corner;
    };
    const Vec a = edge(first), b = edge(second);
    // Two numbers folded into half of the unit square: uniform over the triangle (Turk
    // 1990).
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    roots.push_back(corner + u * a + v * b);
  }
  return roots;
}

GuideHair::GuideHair(std::vector<Vec> guide_roots, std::vector<Vec> hair_roots,
                     std::size_t points, const GuideHairOptions& options)
    : guide_roots_(std::move(guide_roots)),
      hair_roots_(std::move(hair_roots)),
      points_(points),
      options_(options) {
  check(guide_roots_, hair_roots_, points_, options_);
  neighbours_.reserve(hair_roots_.size());
  clumpiness_.reserve(hair_roots_.size());
  Random random(options.seed, 0);
  const double c = options.clumpiness;
  for (const Vec& root : hair_roots_) {
    neighbours_.push_back(neighbours_of(guide_roots_, root, options.linear));
    clumpiness_.push_back(c + 0.4 * c * (1 - c) * (2 * random.uniform() - 1));
  }
}

void GuideHair::grow(std::span<const Vec> guides, const Frame& head,
                     std::span<Vec> hairs) const {
  const std::size_t n = points_;
  if (guides.size() != guide_roots_.size() * n ||
      hairs.size() != hair_roots_.size() * n) {
    throw InputError(fmt::format("{} guide points and room for {} hair points",
                                 guides.size(), hairs.size()),
                     "guide hair",
                     fmt::format("{} guides and {} hairs have {} points each",
                                 guide_roots_.size(), hair_roots_.size(), n));
  }
  std::vector<Frame> carried(guides.size());
  for (std::size_t g = 0; g < guide_roots_.size(); ++g) {
    carry(guides.subspan(g * n, n), head, std::span(carried).subspan(g * n, n));
  }
  for (std::size_t h = 0; h < hair_roots_.size(); ++h) {
    const Neighbours& near = neighbours_[h];
    const std::size_t own = near.guide[0] * n;
    const Vec offset = hair_roots_[h] - guide_roots_[near.guide[0]];
    const Vec root = guides[own] + head * offset;

    std::array<double, 3> weight{};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double apart = norm(guides[near.guide[k] * n + n - 1] - guides[own + n - 1]);
      sum += weight[k] =
          near.weight[k] * (1 - smooth(2 * apart / options_.tip_limit - 1));
    }
    if (options_.linear) {
      weight[0] = 1 - weight[1] - weight[2];
      sum = 1;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(n - 1);
      Vec mean = root;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t first = near.guide[k] * n;
        mean = mean + (weight[k] / sum) * (guides[first + i] - guides[first]);
      }
      const double width = 1 - options_.clumpiness * s * (1 - options_.tip_width);
      const Vec lock = guides[own + i] + width * (carried[own + i] * offset);
      const double m = smooth(2 * (s - 1 + 1.5 * clumpiness_[h]));
      Vec& hair = hairs[h * n + i];
      hair = (1 - m) * mean + m * lock;
      if (!own_shapes_.empty()) {
        hair = hair + carried[own + i] * own_shapes_[h * n + i];
      }
    }
  }
}

void GuideHair::keep_shapes(std::span<const Vec> guides, const Frame& head,
                            std::span<const Vec> hairs) {
  own_shapes_.clear();
  std::vector<Vec> shapes(hairs.size());
  grow(guides, head, shapes);
  std::vector<Frame> carried(guides.size());
  for (std::size_t g = 0; g < guide_roots_.size(); ++g) {
    const std::size_t first = g * points_;
    carry(guides.subspan(first, points_), head,
          std::span(carried).subspan(first, points_));
  }
  for (std::size_t h = 0; h < hair_roots_.size(); ++h) {
    const std::size_t own = neighbours_[h].guide[0] * points_;
    for (std::size_t i = 0; i < points_; ++i) {
      Vec& shape = shapes[h * points_ + i];
      shape = carried[own + i].back(hairs[h * points_ + i] - shape);
    }
  }
  own_shapes_ = std::move(shapes);
}

}  // namespace tress::simulation
