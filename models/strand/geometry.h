#pragma once

#include <vector>

#include "models/strand/strand.h"

namespace tress::models {

/// Returns the inverse of a rotation.
inline Frame inverse(const Frame& f) {
  return {f.back({1, 0, 0}), f.back({0, 1, 0}), f.back({0, 0, 1})};
}

/// The frame at `s` (m) of a helix of constant Darboux vector (1/m), relative to the
/// frame at 0.
Frame helix_turn(const Vec& darboux, double s);

/// Choice between a strand's two shapes: Segment::natural or Segment::initial.
enum class ShapeOf { natural, initial };

/// Returns the place of the root at t = 0.
StrandPlace root_place(const Strand& strand);

/// Returns the section at an end of a segment, seen from that of its middle. `tip`: the
/// end that is nearer to the tip of the strand.
Frame half_turn(const Segment& segment, ShapeOf shape, bool tip);
/// Returns the section at an end of a segment in its initial shape, seen from the one
/// that it has if the half there takes its natural shape.
Frame strain_of_half(const Segment& segment, bool tip);
/// Returns a frame whose e0 is the chord of a segment, seen from the section at an end
/// and turned from it by the shortest way.
Frame chord_at_end(const Segment& segment, ShapeOf shape, bool tip);

/// The n + 1 sections at the root (located at `root`) and at the tips of all segments of
/// an unbranched strand, computed from helix to helix.
std::vector<StrandPlace> joints(const Strand& strand, ShapeOf shape,
                                const StrandPlace& root);
/// The n sections at the middles of its segments.
std::vector<StrandPlace> middles(const Strand& strand, ShapeOf shape,
                                 const StrandPlace& root);

/// Throws InputError naming `model` unless the strand is a chain: segment i starts at the
/// tip of segment i - 1, in its direction.
void check_unbranched(const Strand& strand, const std::string& model);

}  // namespace tress::models
