#include "models/mesh/triangle_tree.h"

#include <limits>
#include <unsupported/Eigen/BVH>

namespace tress::models {
namespace {

Eigen::Vector3d eigen(const Vec& a) { return {a.x, a.y, a.z}; }

/// The nearest place of one triangle, by the corners, edges and the face that it lies on
/// [Ericson 2005, Real-Time Collision Detection, section 5.1.5].
NearestOnMesh nearest_of(const Vec& a, const Vec& b, const Vec& c, const Vec& x) {
  const Vec ab = b - a, ac = c - a;
  const double d1 = dot(ab, x - a), d2 = dot(ac, x - a);
  if (d1 <= 0 && d2 <= 0) return {.at = a, .corner = 0};
  const double d3 = dot(ab, x - b), d4 = dot(ac, x - b);
  if (d3 >= 0 && d4 <= d3) return {.at = b, .corner = 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {.at = a + (d1 / (d1 - d3)) * ab, .edge = 0};
  const double d5 = dot(ab, x - c), d6 = dot(ac, x - c);
  if (d6 >= 0 && d5 <= d6) return {.at = c, .corner = 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {.at = a + (d2 / (d2 - d6)) * ac, .edge = 2};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    return {.at = b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b), .edge = 1};
  }
  const double all = va + vb + vc;
  return {.at = a + (vb / all) * ab + (vc / all) * ac};
}

}  // namespace

struct TriangleTree::Parts {
  TriangleMesh mesh;
  Eigen::KdBVH<double, 3, std::size_t> tree{};

  const Vec& at(std::size_t t, std::size_t k) const {
    return mesh.corner[mesh.triangle[t][k]];
  }
};

namespace {

/// The search for the nearest triangle, as Eigen's tree asks for it.
template <class Parts>
struct NearestSearch {
  using Scalar = double;

  const Parts& parts;
  Vec x;
  Eigen::Vector3d place = eigen(x);
  double best = std::numeric_limits<double>::infinity();  // squared distance, m^2
  NearestOnMesh on{};

  double minimumOnVolume(const Eigen::AlignedBox3d& box) const {
    const double d = box.squaredExteriorDistance(place);
    return d < best ? d : std::numeric_limits<double>::max();
  }
  double minimumOnObject(std::size_t t) {
    NearestOnMesh one = nearest_of(parts.at(t, 0), parts.at(t, 1), parts.at(t, 2), x);
    const double d = dot(one.at - x, one.at - x);
    if (d < best) {
      best = d;
      one.triangle = t;
      on = one;
    }
    return d;
  }
};

}  // namespace

TriangleTree::TriangleTree(TriangleMesh mesh) {
  auto parts = std::make_unique<Parts>(Parts{std::move(mesh)});
  std::vector<std::size_t> all(parts->mesh.triangle.size());
  std::vector<Eigen::AlignedBox3d> boxes(all.size());
  for (std::size_t t = 0; t < all.size(); ++t) {
    all[t] = t;
    for (std::size_t k = 0; k < 3; ++k) boxes[t].extend(eigen(parts->at(t, k)));
  }
  parts->tree.init(all.begin(), all.end(), boxes.begin(), boxes.end());
  parts_ = std::move(parts);
}
TriangleTree::~TriangleTree() = default;
TriangleTree::TriangleTree(TriangleTree&&) noexcept = default;

NearestOnMesh TriangleTree::nearest(const Vec& x, std::size_t from) const {
  NearestSearch<Parts> search{.parts = *parts_, .x = x};
  static_cast<void>(search.minimumOnObject(from));
  Eigen::BVMinimize(parts_->tree, search);
  return search.on;
}
const TriangleMesh& TriangleTree::mesh() const { return parts_->mesh; }

}  // namespace tress::models
