#pragma once

#include <optional>
#include <string>

#include "simulation/groom/byte_stream.h"
#include "simulation/groom/polylines.h"

namespace tress::simulation {

/// An axis of a file's coordinates.
struct FileAxis {
  int axis;   // 0, 1, 2
  bool back;  // its negative direction
};

/// Strands as they are in a file, in its units and axes.
struct GroomFile {
  Polylines lines;
  std::optional<double> metres;  // per unit, where the file says
  std::optional<FileAxis> up;    // where it says
  bool text = false;             // Polylines::places are lines, not bytes
  std::string note;              // what a user should know; empty: nothing
};

/// By the ending of the file:
///
///     .hair   [Yuksel], 128 bytes of header, then arrays by bits
///     .data   i32 strands; of each strand i32 points, then three f32 of each
///     .bin    the same with seven f32
///     .ply    vertices, and how many of each strand: element strand with nsegs, or edges
///             in order, or `strand_points` of each; ascii and both binary forms
///     .usda   BasisCurves, linear or cubic, evaluated on the curve [OpenUSD]
///     .vtp    lines of PolyData; ascii, binary and appended, not compressed [VTK]
///
/// Strands may have any number of points of any value: place_groom() judges them. Throws
/// InputError, naming byte or line, where sizes or syntax are wrong. O(bytes), through a
/// buffer; memory is that of the points.
GroomFile read_groom(const std::string& file, int strand_points = 0);

// One format each.
GroomFile read_hair(ByteStream& from);
GroomFile read_counted(ByteStream& from, int floats);
GroomFile read_ply(ByteStream& from, int strand_points);
GroomFile read_usda(ByteStream& from);
GroomFile read_vtp(ByteStream& from);

}  // namespace tress::simulation
