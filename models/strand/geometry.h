#pragma once

#include <vector>

#include "models/strand/strand.h"

namespace tress::models {

/// The frame at `s` (m) of a helix of constant Darboux vector (1/m), relative to the
/// frame at 0.
Frame helix_turn(const Vec& darboux, double s);

/// Choice between a strand's two shapes: Segment::natural or Segment::initial.
enum class ShapeOf { natural, initial };

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
