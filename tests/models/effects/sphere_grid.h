#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "models/contact/distance_grid.h"

namespace tress::testing_support {

using namespace models;

/// Distances from a sphere about the origin on n^3 points of the cube [-edge, edge]^3.
inline DistanceGrid::Samples sphere_samples(double radius, double edge, std::size_t n) {
  DistanceGrid::Samples s;
  s.nx = s.ny = s.nz = n;
  s.origin = {-edge, -edge, -edge};
  s.spacing = 2 * edge / static_cast<double>(n - 1);
  const auto at = [&](std::size_t i) {
    return -edge + s.spacing * static_cast<double>(i);
  };
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < n; ++i) {
        const Vec x{at(i), at(j), at(k)};
        s.value.push_back(norm(x) - radius);
      }
    }
  }
  return s;
}

/// Writes text to a file of the test's own; the name of it.
inline std::string write_file(const std::string& name, const std::string& text) {
  const auto folder = std::filesystem::path(TRESS_BINARY_DIR) / "effect_files";
  std::filesystem::create_directories(folder);
  std::string file = (folder / name).string();
  // Tests run side by side: a file is whole as soon as it has its name.
  const std::string draft = file + "." + std::to_string(std::hash<std::string>{}(text)) +
                            "." + std::to_string(::getpid());
  std::ofstream(draft) << text;
  std::filesystem::rename(draft, file);
  return file;
}

inline std::string as_text(const DistanceGrid::Samples& s) {
  std::ostringstream text;
  text.precision(17);
  text << s.nx << ' ' << s.ny << ' ' << s.nz << "\n"
       << s.origin.x << ' ' << s.origin.y << ' ' << s.origin.z << "\n"
       << s.spacing << "\n";
  for (const double value : s.value) text << value << '\n';
  return text.str();
}

}  // namespace tress::testing_support
