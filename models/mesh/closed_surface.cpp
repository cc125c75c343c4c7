#include "models/mesh/closed_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <tuple>

#include "contract/input_error.h"

namespace tress::models {
namespace {

using MeshCorners = std::array<std::size_t, 3>;

/// Corners at one place become one; triangles with two equal corners are left out.
TriangleMesh joined(const TriangleMesh& mesh) {
  TriangleMesh made;
  std::map<std::tuple<double, double, double>, std::size_t> known;
  std::vector<std::size_t> now(mesh.corner.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vec& x = mesh.corner[i];
    const auto [at, fresh] = known.try_emplace({x.x, x.y, x.z}, made.corner.size());
    if (fresh) made.corner.push_back(x);
    now[i] = at->second;
  }
  for (const MeshCorners& of : mesh.triangle) {
    const MeshCorners t{now[of[0]], now[of[1]], now[of[2]]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) made.triangle.push_back(t);
  }
  return made;
}

std::string place_in_words(const Vec& x) {
  std::ostringstream to;
  to.precision(4);
  to << '(' << x.x << ", " << x.y << ", " << x.z << ") m";
  return to.str();
}

using MeshEdges = std::map<std::pair<std::size_t, std::size_t>, std::size_t>;

/// The triangle of each directed edge. Throws unless its reverse has one, too.
MeshEdges checked_edges(const TriangleMesh& mesh, const std::string& where) {
  MeshEdges edges;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::pair edge{mesh.triangle[t][k], mesh.triangle[t][(k + 1) % 3]};
      refuse_if(!edges.try_emplace(edge, t).second,
                "two triangles run along one edge in the same direction, at " +
                    place_in_words(mesh.corner[edge.first]),
                where,
                "let all triangles face outwards, with two at each edge, and write the "
                "mesh again");
    }
  }
  std::size_t open = 0;
  const Vec* at = nullptr;
  for (const auto& [edge, t] : edges) {
    if (edges.contains({edge.second, edge.first})) continue;
    ++open;
    at = &mesh.corner[edge.first];
  }
  if (open == 0) return edges;
  throw InputError("the mesh has holes: " + std::to_string(open) +
                       " edges belong to one triangle only, one at " +
                       place_in_words(*at),
                   where, "close it in the program that wrote it");
}

double volume_of(const TriangleMesh& mesh) {
  double sum = 0;
  const Vec& o = mesh.corner[0];
  for (const MeshCorners& t : mesh.triangle) {
    sum +=
        dot(mesh.corner[t[0]] - o, cross(mesh.corner[t[1]] - o, mesh.corner[t[2]] - o)) /
        6;
  }
  return sum;
}

/// The mesh with corners joined and triangles that face outwards.
TriangleMesh outwards(const TriangleMesh& given, const std::string& where) {
  refuse_if(!std::ranges::all_of(given.corner, [](const Vec& x) { return is_finite(x); }),
            "a corner of the mesh is not finite", where, "write the mesh again");
  TriangleMesh mesh = joined(given);
  refuse_if(mesh.triangle.size() < 4, "fewer than four triangles", where,
            "name a mesh of a closed surface");
  if (volume_of(mesh) < 0) {
    for (MeshCorners& t : mesh.triangle) std::swap(t[1], t[2]);
  }
  return mesh;
}

}  // namespace

ClosedSurface::ClosedSurface(const TriangleMesh& given, const std::string& where)
    : tree_(outwards(given, where)), volume_(volume_of(mesh())) {
  const auto& [corners, triangles] = mesh();
  const MeshEdges edges = checked_edges(mesh(), where);
  refuse_if(!std::isfinite(volume_) || volume_ == 0, "the mesh encloses no volume", where,
            "name a mesh of a closed surface");
  corner_.resize(corners.size());
  edge_.resize(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    const Vec area = cross(corners[b] - corners[a], corners[c] - corners[a]);
    const double twice = norm(area);
    face_.push_back(twice > 0 ? (1 / twice) * area : Vec{});
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t here = triangles[t][k], next = triangles[t][(k + 1) % 3],
                        last = triangles[t][(k + 2) % 3];
      const Vec one = corners[next] - corners[here], two = corners[last] - corners[here];
      const double angle = std::atan2(norm(cross(one, two)), dot(one, two));
      corner_[here] = corner_[here] + angle * face_[t];
      edge_[t][k] = face_[t] + face_[edges.at({next, here})];
    }
  }
}

const Vec& ClosedSurface::normal(const NearestOnMesh& on) const {
  if (on.corner >= 0) {
    return corner_[mesh().triangle[on.triangle][static_cast<std::size_t>(on.corner)]];
  }
  return on.edge >= 0 ? edge_[on.triangle][static_cast<std::size_t>(on.edge)]
                      : face_[on.triangle];
}

double ClosedSurface::distance(const Vec& x) const {
  std::size_t from = 0;
  return distance(x, from);
}

double ClosedSurface::distance(const Vec& x, std::size_t& from) const {
  const NearestOnMesh on = tree_.nearest(x, from);
  from = on.triangle;
  const Vec out = x - on.at;
  return dot(normal(on), out) < 0 ? -norm(out) : norm(out);
}

}  // namespace tress::models
