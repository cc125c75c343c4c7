#pragma once

#include <cstring>
#include <map>
#include <sstream>
#include <string>

#include "models/mesh/closed_surface.h"

namespace tress::testing_support {

using namespace models;

/// A cube of half edge a about a place.
inline TriangleMesh cube(double a, const Vec& about = {}) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i) {
    m.corner.push_back(about + Vec{i & 1 ? a : -a, i & 2 ? a : -a, i & 4 ? a : -a});
  }
  m.triangle = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return m;
}

/// An octahedron whose triangles are halved `times` times, corners on a sphere.
inline TriangleMesh ball(double radius, int times) {
  TriangleMesh m;
  m.corner = {{radius, 0, 0},  {-radius, 0, 0}, {0, radius, 0},
              {0, -radius, 0}, {0, 0, radius},  {0, 0, -radius}};
  m.triangle = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (; times > 0; --times) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
    const auto middle = [&](std::size_t a, std::size_t b) {
      const auto [at, fresh] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, m.corner.size());
      if (fresh) {
        const Vec x = m.corner[a] + m.corner[b];
        m.corner.push_back((radius / norm(x)) * x);
      }
      return at->second;
    };
    std::vector<std::array<std::size_t, 3>> finer;
    for (const auto& [a, b, c] : m.triangle) {
      const std::size_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {std::array{a, ab, ca}, std::array{ab, b, bc},
                            std::array{ca, bc, c}, std::array{ab, bc, ca}}) {
        finer.push_back(t);
      }
    }
    m.triangle = std::move(finer);
  }
  return m;
}

inline std::string as_obj(const TriangleMesh& m) {
  std::ostringstream to;
  to.precision(9);
  for (const Vec& x : m.corner) to << "v " << x.x << ' ' << x.y << ' ' << x.z << '\n';
  for (const auto& t : m.triangle) {
    to << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  return to.str();
}

inline std::string as_ply(const TriangleMesh& m) {
  std::ostringstream to;
  to.precision(9);
  to << "ply\nformat ascii 1.0\nelement vertex " << m.corner.size()
     << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
     << m.triangle.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec& x : m.corner) to << x.x << ' ' << x.y << ' ' << x.z << '\n';
  for (const auto& t : m.triangle) {
    to << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  }
  return to.str();
}

/// Binary: every triangle has corners of its own.
inline std::string as_stl(const TriangleMesh& m) {
  std::string to(80, ' ');
  const auto add = [&to](const auto& x) {
    char bytes[sizeof x];
    std::memcpy(bytes, &x, sizeof x);
    to.append(bytes, sizeof x);
  };
  add(static_cast<std::uint32_t>(m.triangle.size()));
  for (const auto& t : m.triangle) {
    for (int i = 0; i < 3; ++i) add(0.0F);
    for (const std::size_t i : t) {
      const Vec& x = m.corner[i];
      for (const double at : {x.x, x.y, x.z}) add(static_cast<float>(at));
    }
    add(std::uint16_t{0});
  }
  return to;
}

}  // namespace tress::testing_support
