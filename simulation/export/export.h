#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulation/export/smooth_lines.h"

namespace tress::simulation {

/// The strand that a line belongs to, and its thickness.
struct DrawnLine {
  int strand;     // from 0; hairs drawn between strands follow them
  double radius;  // m, of a circle of the root's area
};

/// Returns the drawn lines as in Readout; empty if the scene has no strands.
std::vector<DrawnLine> drawn_lines(const Scene& scene, const World& world,
                                   std::span<const int> lines);

/// An animation of strands for other programs: frames of the lines' own points, written
/// with intermediate points that make them curves.
struct Animation {
  const Scene& scene;                    // scene that was run
  const std::vector<Reading>& series;    // columns of the time series
  const std::vector<Reading>& channels;  // numbers at every point
  std::span<const DrawnLine> lines;      // empty: not known
  std::span<const Frame3d> frames;       // frames in order of time
  const SmoothLines& curves;             // of the same lines
  std::size_t guides = 0;                // lines that were simulated; 0: all
};

/// Returns the text of <scene>.json for the report page: positions in 16 bits of their
/// box, colours in 8 bits (experiments/report/README.md has the format). Frames are
/// thinned evenly to about `most_bytes`, but not below 24 frames.
std::string page_json(const Animation& animation, std::size_t most_bytes = 500'000);

/// Returns the files for ParaView. Each frame is one .vtp (PolyData, appended raw,
/// float32) with every channel, radius and strand as point data and the time as field
/// data. The .pvd lists them with their times [VTK file formats, XML].
std::string vtp(const Animation& animation, const Frame3d& frame);
/// Returns the list of the files of all frames.
std::string pvd(const Animation& animation, const std::string& stem);
/// Returns the name of a frame's .vtp.
std::string vtp_name(const std::string& stem, std::size_t frame);

/// Returns USD text with one animated BasisCurves, for Blender and Houdini [OpenUSD,
/// UsdGeom]. Time codes count the scene's frames, and primvars:strand is the strand of
/// each curve. The extent of each frame is that of the points and half the largest width.
std::string usda(const Animation& animation);

/// Returns a file for renderers: one .hair per frame [Yuksel], with the time and the
/// unit in its comment; thickness is the diameter. Throws InputError on a line of more
/// than 65536 points.
std::string hair(const Animation& animation, const Frame3d& frame);
/// Returns the name of a frame's .hair.
std::string hair_name(const std::string& stem, std::size_t frame);

/// Returns binary glTF 2.0 [Khronos] of one mesh of lines, for viewers, engines and
/// Blender. The attribute _STRAND of its points distinguishes the strands: a primitive
/// for each would need accessors for each strand of each frame. Every frame but the first
/// is a morph target, of places and channels, and the animation blends them at their
/// times. The attribute _RADIUS is the radius. The mesh's extras contain the names and
/// units of channels. Throws InputError on data that such a file cannot hold.
std::string glb(const Animation& animation);

}  // namespace tress::simulation
