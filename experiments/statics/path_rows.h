#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/statics/path_point.h"
#include "simulation/files/row.h"

namespace tress::experiments::statics {

/// Columns of a table of paths.
std::span<const simulation::Column> path_columns();

/// Place whose displacement is read off a path, and the force that moves it.
struct Gauge {
  std::size_t point = 0;                    // end of an element before the place
  double part = 0;                          // of the way to the next one
  Vec direction{};                          // of length 1; 0: distances count
  double force = 0;                         // of a point force, for 1 of the parameter, N
  std::optional<std::size_t> support = {};  // support that moves
  models::RootMotion path;                  // its path
  std::string place;                        // name of the place

  /// Returns the displacement of the place since the first point of a path, m.
  double displacement(const PathPoint& first, const PathPoint& at) const;
  /// Returns the force along the direction, N; NaN: none is known.
  double force_at(const PathPoint& at) const;
};

/// Returns the gauge of a path: of the place of a point force, of the support that moves
/// farthest, or of the tip.
Gauge gauge(StaticStrand& strand);

/// Returns a row for each point of a path, with the columns of `identity`.
std::vector<simulation::Row> path_rows(const std::vector<PathPoint>& path,
                                       const Gauge& gauge, const Varied& varied,
                                       const simulation::Row& identity);

/// Returns the places of all points of a path as CSV.
std::string shapes_csv(const std::vector<PathPoint>& path);

}  // namespace tress::experiments::statics
