#include "models/mesh/mesh_grid.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "models/mesh/grid_cache.h"
#include "models/mesh/read_mesh.h"

namespace tress::models {
namespace {

constexpr double most_points = 2e7;
constexpr double margin = 4;  // spacings around the surface, beside the offset

struct Extent {
  Vec least, most;
  double largest() const {
    return std::max({most.x - least.x, most.y - least.y, most.z - least.z});
  }
  double smallest() const {
    return std::min({most.x - least.x, most.y - least.y, most.z - least.z});
  }
};

Extent extent(const std::vector<Vec>& corners) {
  Extent e{corners.front(), corners.front()};
  for (const Vec& x : corners) {
    e.least = {std::min(e.least.x, x.x), std::min(e.least.y, x.y),
               std::min(e.least.z, x.z)};
    e.most = {std::max(e.most.x, x.x), std::max(e.most.y, x.y), std::max(e.most.z, x.z)};
  }
  return e;
}

/// The points of the grid, without their values.
DistanceGrid::Samples places(const Extent& e, const MeshGridOptions& options,
                             const std::string& where) {
  DistanceGrid::Samples s;
  s.spacing = options.spacing > 0 ? options.spacing : e.largest() / 64;
  // A thinner body may fall between the points.
  constexpr double fewest = 4;
  if (!(fewest * s.spacing <= e.smallest())) {
    std::ostringstream problem, remedy;
    problem.precision(3), remedy.precision(3);
    problem << "the mesh is " << e.smallest() / s.spacing
            << " spacings of its grid across, which is too few";
    remedy << "take mesh_spacing_m of " << e.smallest() / fewest << " or less";
    throw InputError(problem.str(), where, remedy.str());
  }
  const double around = options.offset + margin * s.spacing;
  s.origin = e.least - Vec{around, around, around};
  const auto points = [&](double from, double to) {
    return std::ceil((to + around - from) / s.spacing) + 1;
  };
  const double nx = points(s.origin.x, e.most.x), ny = points(s.origin.y, e.most.y),
               nz = points(s.origin.z, e.most.z);
  if (!(nx * ny * nz <= most_points)) {
    std::ostringstream problem, remedy;
    problem.precision(3), remedy.precision(3);
    problem << "the grid of the mesh would have " << nx * ny * nz << " points";
    remedy << "take mesh_spacing_m above "
           << s.spacing * std::cbrt(nx * ny * nz / most_points)
           << ", or check the unit of the file (mesh_scale)";
    throw InputError(problem.str(), where, remedy.str());
  }
  s.nx = static_cast<std::size_t>(nx);
  s.ny = static_cast<std::size_t>(ny);
  s.nz = static_cast<std::size_t>(nz);
  return s;
}

Vec place(const DistanceGrid::Samples& s, std::size_t i, std::size_t j, std::size_t k) {
  return s.origin + s.spacing * Vec{static_cast<double>(i), static_cast<double>(j),
                                    static_cast<double>(k)};
}

/// Refuses values that are no signed distance: it changes by no more than the way.
void check_slopes(const DistanceGrid::Samples& s, const std::string& where) {
  const double most = s.spacing * (1 + 1e-9);
  const std::size_t step[3] = {1, s.nx, s.nx * s.ny};
  for (std::size_t k = 0; k < s.nz; ++k) {
    for (std::size_t j = 0; j < s.ny; ++j) {
      for (std::size_t i = 0; i < s.nx; ++i) {
        const std::size_t at = i + s.nx * (j + s.ny * k);
        const bool inner[3] = {i + 1 < s.nx, j + 1 < s.ny, k + 1 < s.nz};
        for (int d = 0; d < 3; ++d) {
          if (!inner[d] || std::abs(s.value[at + step[d]] - s.value[at]) <= most)
            continue;
          const Vec x = place(s, i, j, k);
          std::ostringstream problem;
          problem.precision(3);
          problem << "the mesh intersects itself, near (" << x.x << ", " << x.y << ", "
                  << x.z << ") m";
          throw InputError(problem.str(), where,
                           "unite its parts in the program that wrote it");
        }
      }
    }
  }
}

/// The largest distance of the grid's surface over corners, middles and centres.
double error_of(const DistanceGrid& grid, const ClosedSurface& surface) {
  double most = 0;
  const auto see = [&](const Vec& x) {
    most = std::max(most, std::abs(grid.distance(x).value));
  };
  const std::vector<Vec>& x = surface.mesh().corner;
  for (const auto& t : surface.mesh().triangle) {
    const Vec &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    for (const Vec& corner : {a, b, c}) see(corner);
    for (const Vec& middle : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) see(middle);
    see((1.0 / 3) * (a + b + c));
  }
  return most;
}

}  // namespace

MeshGrid mesh_grid(const ClosedSurface& surface, const MeshGridOptions& options,
                   const std::string& where) {
  DistanceGrid::Samples s = places(extent(surface.mesh().corner), options, where);
  s.value.reserve(s.nx * s.ny * s.nz);
  std::size_t near = 0;
  for (std::size_t k = 0; k < s.nz; ++k) {
    for (std::size_t j = 0; j < s.ny; ++j) {
      for (std::size_t i = 0; i < s.nx; ++i) {
        s.value.push_back(surface.distance(place(s, i, j, k), near));
      }
    }
  }
  check_slopes(s, where);
  DistanceGrid grid(std::move(s), where);
  const double error = error_of(grid, surface);
  return {std::move(grid), surface.mesh().triangle.size(), error};
}

MeshGrid read_mesh_grid(const std::string& file, const MeshGridOptions& options) {
  const GridCache cache(file, options);
  if (std::optional<MeshGrid> kept = cache.find()) return *std::move(kept);
  MeshGrid made =
      mesh_grid(ClosedSurface(read_mesh(file, options.scale), file), options, file);
  cache.keep(made);
  return made;
}

}  // namespace tress::models
