#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "math/helix.h"
#include "models/reduced/trees.h"

namespace tress {

using namespace models;

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Position and frame at s along a segment, from its start.
struct Pose {
  Vec x;
  Frame frame;
};

inline Pose along(const Segment& segment, double s) {
  const Vec& k = segment.natural;
  const auto f = helix_functions(s, dot(k, k), s);
  const auto combined = [&k](double a, double b, double c, const Vec& e) {
    return a * e + b * cross(k, e) + c * cross(k, cross(k, e));
  };
  return {combined(s, f.A, f.B, {1, 0, 0}),
          {combined(1, f.S, f.A, {1, 0, 0}), combined(1, f.S, f.A, {0, 1, 0}),
           combined(1, f.S, f.A, {0, 0, 1})}};
}

/// Where a tree is at rest.
struct Tree {
  explicit Tree(std::string_view name)
      : segments(tree_segments(name)), material(tree_material(name)) {
    for (const Segment& s : segments) {
      const Pose from = s.parent < 0 ? Pose{{}, upright()} : tips[at(s.parent)];
      const Pose start{from.x, from.frame * s.mount};
      const auto at_share = [&](double share) {
        const Pose p = along(s, share * s.length);
        return Pose{start.x + start.frame * p.x, start.frame * p.frame};
      };
      starts.push_back(start);
      mids.push_back(at_share(0.5));
      tips.push_back(at_share(1));
      top = std::max(top, tips.back().x.z);
    }
  }

  double mass(std::size_t i) const {
    return material.density * segments[i].section.area() * segments[i].length;
  }
  std::vector<int> children(int i) const {
    std::vector<int> all;
    for (std::size_t k = 0; k < segments.size(); ++k) {
      if (segments[k].parent == i) all.push_back(static_cast<int>(k));
    }
    return all;
  }
  std::vector<int> free_ends() const {
    std::vector<int> all;
    for (std::size_t k = 0; k < segments.size(); ++k) {
      if (children(static_cast<int>(k)).empty()) all.push_back(static_cast<int>(k));
    }
    return all;
  }
  /// From a segment to the root.
  std::vector<int> way_down(int i) const {
    std::vector<int> all;
    for (; i >= 0; i = segments[at(i)].parent) all.push_back(i);
    return all;
  }

  std::vector<Segment> segments;
  Material material;
  std::vector<Pose> starts, mids, tips;
  double top = 0;  // m
};

}  // namespace tress
