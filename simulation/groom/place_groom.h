#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/groom/read_groom.h"

namespace tress::simulation {

/// Units that files have.
struct FileUnit {
  std::string_view name;  // name in scenes
  double metres;          // metres per unit
};
/// All units, by name.
inline constexpr FileUnit file_units[] = {
    {"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"inch", 0.0254}};

/// Settings that place a file's strands in a scene.
struct GroomPlacing {
  std::optional<double> metres;         // per unit; none: as the file says, or a guess
  std::optional<FileAxis> up;           // likewise
  Vec position;                         // of the file's origin, m
  BadStrands bad = BadStrands::refuse;  // treatment of strands that cannot be simulated
  std::size_t every = 1;                // take every n-th strand
  bool widths = false;                  // take the widths of the file
};

/// In m, z up, thinned; with what a user should know of guesses and strands left out, one
/// sentence each.
struct PlacedGroom {
  std::string file;                // name of the file
  Polylines lines;                 // strands, in m
  std::vector<std::string> notes;  // remarks for the user, one sentence each
};

/// Places a groom in the axes and units of tress. The axis that points up becomes z by a
/// cyclic exchange of the axes (x, y, z) -> (y, z, x) or (z, x, y). A turn by pi about x
/// follows where its negative direction points up. A groom that faces z in a file with y
/// up, as in Houdini, then faces x, as a head does here.
///
/// Without a unit from the scene, the file or its format, it is guessed as m, cm or mm,
/// whichever brings the median length nearest to 15 cm, by ratio. An axis is guessed as
/// the one along which strands run most, from roots to tips, and towards which they bend
/// on their way, as hanging hair does. Straight hair, and hair that stands, could be
/// either way round: InputError asks for the axis. The notes contain guesses, fallbacks
/// and notes_on_lengths().
///
/// A strand is bad if it has fewer than two points or a point that is not finite. It is
/// also bad if a point is farther than 1 km from the origin or repeats the one before
/// (within 1 nm). If widths are taken, a width must be above 0. If bad strands are
/// refused, an InputError names the first with its number, from 0, and its place in the
/// file. If they are dropped, they are counted, and of repeated points only the
/// repetition is left out. Throws InputError if widths are to be taken from a file
/// without any.
PlacedGroom place_groom(GroomFile read, const std::string& file,
                        const GroomPlacing& placing);

}  // namespace tress::simulation
