#include "models/contact/guide_mesh.h"

#include <algorithm>
#include <limits>
#include <map>

namespace tress::models {
namespace {

// Of the square of a distance: a root so near to the sphere is on it, as in a square.
constexpr double on_sphere = 1 + 1e-9;

Vec at(In x, int point) { return load3(&x[3 * static_cast<std::size_t>(point)]); }

/// Links every inner point of one guide to the nearest inner one of the other, with half
/// of the length that it carries: the other guide's points have links too.
void link(int from, int from_pieces, int to, int to_pieces, In x, double width,
          const std::vector<double>& carried,
          std::map<std::pair<int, int>, GuideMesh::Link>& links) {
  for (int i = from + 1; i < from + from_pieces; ++i) {
    int nearest = to + 1;
    double least = std::numeric_limits<double>::infinity();
    for (int j = to + 1; j < to + to_pieces; ++j) {
      const double apart = norm(at(x, i) - at(x, j));
      if (apart >= least) continue;
      least = apart;
      nearest = j;
    }
    if (!(least <= width)) continue;
    const std::pair<int, int> ends = std::minmax(i, nearest);
    const auto made =
        links.try_emplace(ends, GuideMesh::Link{ends.first, ends.second, least, 0});
    made.first->second.carried += carried[static_cast<std::size_t>(i)] / 2;
  }
}

/// Triangles from root to tip: the guide goes on whose next point is the nearer to its
/// root by number, of its number of pieces.
void strip(int number, int a, int a_pieces, int b, int b_pieces,
           std::vector<GuideMesh::Triangle>& triangles) {
  for (int i = 0, j = 0; i < a_pieces || j < b_pieces;) {
    const bool first =
        j == b_pieces || (i < a_pieces && (i + 1) * b_pieces <= (j + 1) * a_pieces);
    if (first) {
      triangles.push_back({number, {a + i, a + i + 1, b + j}, 0});
      ++i;
    } else {
      triangles.push_back({number, {b + j, b + j + 1, a + i}, 0});
      ++j;
    }
  }
}

}  // namespace

std::vector<std::pair<int, int>> neighbouring_roots(const std::vector<Vec>& roots,
                                                    double width) {
  struct Near {
    double square;
    int root;
  };
  const auto count = static_cast<int>(roots.size());
  const auto root = [&](int i) { return roots[static_cast<std::size_t>(i)]; };
  const auto square = [&](int i, int j) {
    const Vec d = root(i) - root(j);
    return dot(d, d);
  };
  std::vector<std::pair<int, int>> pairs;
  std::vector<Near> near;
  for (int i = 0; i < count; ++i) {
    near.clear();
    for (int j = 0; j < count; ++j) {
      if (j != i && square(i, j) <= width * width) near.push_back({square(i, j), j});
    }
    std::ranges::sort(near, [](const Near& a, const Near& b) {
      return std::pair(a.square, a.root) < std::pair(b.square, b.root);
    });
    for (auto j = near.begin(); j != near.end(); ++j) {
      if (j->root < i) continue;
      // What lies in the sphere is nearer to i than j is.
      const bool between = std::any_of(near.begin(), j, [&](const Near& k) {
        const double other = square(k.root, j->root);
        return k.square > 0 && other > 0 && k.square + other <= on_sphere * j->square;
      });
      if (!between) pairs.emplace_back(i, j->root);
    }
  }
  std::ranges::sort(pairs);
  return pairs;
}

GuideMesh::GuideMesh(const std::vector<std::vector<double>>& segments, In x, double width)
    : carried(x.size() / 3) {
  std::vector<Vec> roots;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    first.push_back(static_cast<int>(strand.size()));
    roots.push_back(at(x, first.back()));
    for (std::size_t i = 0; i < segments[k].size(); ++i) {
      carried[strand.size() + i] += segments[k][i] / 2;
      carried[strand.size() + i + 1] += segments[k][i] / 2;
    }
    strand.insert(strand.end(), segments[k].size() + 1, static_cast<int>(k));
  }
  strips = neighbouring_roots(roots, width);
  std::map<std::pair<int, int>, Link> joined;
  for (std::size_t s = 0; s < strips.size(); ++s) {
    const auto a = static_cast<std::size_t>(strips[s].first),
               b = static_cast<std::size_t>(strips[s].second);
    const auto a_pieces = static_cast<int>(segments[a].size()),
               b_pieces = static_cast<int>(segments[b].size());
    link(first[a], a_pieces, first[b], b_pieces, x, width, carried, joined);
    link(first[b], b_pieces, first[a], a_pieces, x, width, carried, joined);
    strip(static_cast<int>(s), first[a], a_pieces, first[b], b_pieces, triangles);
  }
  for (const auto& [ends, one] : joined) links.push_back(one);
  for (Triangle& triangle : triangles) triangle.width = width_of(triangle, x);
}

double width_of(const GuideMesh::Triangle& triangle, In x) {
  const Vec apex = at(x, triangle.corner[2]);
  return (norm(at(x, triangle.corner[0]) - apex) +
          norm(at(x, triangle.corner[1]) - apex)) /
         2;
}

}  // namespace tress::models
