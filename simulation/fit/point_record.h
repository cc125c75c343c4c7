#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// One measured coordinate of a point of a strand.
struct Observation {
  std::size_t strand = 0;                 // index of the strand in the scene
  std::optional<std::size_t> point = {};  // from the root; empty: the tip
  double t = 0;                           // s
  std::size_t component = 0;              // x, y, z
  double value = 0;                       // m
  std::size_t row = 0;                    // of the file, from 0
};

/// Place of a row in its file, counted from 1: its line, and the columns where cells
/// start. Absent cells have the column of the time.
struct RowPlace {
  int line = 1;                         // line of the file
  int time = 1, strand = 1, point = 1;  // columns of these cells
};

/// Points of strands over time, from t = 0 of the scene's run.
struct PointRecord {
  std::string file = {};                       // name of the CSV file
  std::string hash = {};                       // of the text, 16 hexadecimal digits
  std::vector<Observation> observations = {};  // coordinates in the order of rows
  std::vector<double> sigma = {};              // m, of each observation; empty: not known
  std::vector<RowPlace> places = {};           // place of each row

  /// Returns the place of a cell of an observation's row: file:line:column.
  std::string place(const Observation& one, int RowPlace::*cell) const;
};

/// Whether the header of a table names a coordinate (x_m, y_m or z_m).
bool has_points(const std::vector<std::string>& header);

/// Reads a CSV with the columns time_s and some of x_m, y_m and z_m. Optional columns are
/// strand (0 where absent), point (the tip where absent, empty or "tip") and sigma_m, the
/// standard error of every coordinate of the row. An empty coordinate was not measured.
/// Throws InputError with file:line:column on other columns, numbers that are not finite,
/// negative times, sigma_m that is not positive, and fewer than 3 coordinates.
PointRecord parse_point_record(std::string_view text, const std::string& file);
/// Reads a CSV file as parse_point_record() does.
PointRecord read_point_record(const std::string& file);

}  // namespace tress::simulation
