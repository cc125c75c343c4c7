#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulation/groom/byte_stream.h"
#include "simulation/groom/polylines.h"

namespace tress::simulation {

/// An axis of a file's coordinates.
struct FileAxis {
  int axis;   // 0, 1, 2
  bool back;  // its negative direction
};

/// Treatment of strands that cannot be simulated: `refuse` the file, or `drop` them.
enum class BadStrands { refuse, drop };

/// Settings for reading a file.
struct GroomReading {
  int strand_points = 0;                // of every strand of a .ply; 0: the file's own
  BadStrands bad = BadStrands::refuse;  // of curves whose count does not suit their basis
  bool hidden = false;                  // take the curves that USD does not render
  bool widths = false;                  // read widths
};

/// Strands as they are in a file, in its units and axes.
struct GroomFile {
  Polylines lines;               // strands in the order of the file
  std::optional<double> metres;  // per unit, where the file says
  std::optional<FileAxis> up;    // where it says
  // What the format takes where a file does not say; none: nothing.
  std::optional<double> format_metres;  // metres per unit of the format
  std::optional<FileAxis> format_up;    // axis that points up in the format
  bool text = false;                    // Polylines::places are lines, not bytes
  std::vector<std::string> notes;       // for the user, one sentence each
};

/// Reads a file in the format of its ending:
///
///     .hair   [Yuksel], 128 bytes of header, then arrays by bits; or without header:
///             u32 strands, u32 points, u16 points of each strand, three f32 of each
///             point
///     .data   i32 strands; of each strand i32 points, then three f32 of each
///     .bin    the same with seven f32
///     .ply    vertices, and how many of each strand: element strand with nsegs, or edges
///             in order, or `strand_points` of each; ascii and both binary forms
///     .usda   BasisCurves, linear or cubic, evaluated on the curve and placed by the
///             transforms above them [OpenUSD]
///     .vtp    lines of PolyData; ascii, binary and appended, not compressed [VTK]
///
/// Widths, the diameters at points, are read from a .hair and a .usda if the settings say
/// so. Strands may have any number of points of any value: place_groom() judges them.
/// Throws InputError, naming byte or line, where sizes or syntax are wrong, where data
/// follow the last strand, and where memory does not suffice. O(bytes), through a buffer;
/// memory is that of the points, whatever sizes the file claims.
GroomFile read_groom(const std::string& file, const GroomReading& reading = {});

// One format each.
/// Reads Yuksel's .hair.
GroomFile read_hair(ByteStream& from, const GroomReading& reading);
/// Reads counted strands of `floats` numbers a point: .data, .bin.
GroomFile read_counted(ByteStream& from, int floats);
/// Reads .ply, with `strand_points` points a strand unless the file has curves.
GroomFile read_ply(ByteStream& from, int strand_points);
/// Reads the BasisCurves of a .usda.
GroomFile read_usda(ByteStream& from, const GroomReading& reading);
/// Reads the lines of a .vtp.
GroomFile read_vtp(ByteStream& from);

}  // namespace tress::simulation
