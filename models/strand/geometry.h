#pragma once

#include <vector>

#include "models/strand/strand.h"

namespace tress::models {

/// The frame at `s` (m) of a helix of constant Darboux vector (1/m), in the components of
/// the one at 0.
Frame helix_turn(const Vec& darboux, double s);

/// Which of a strand's two shapes: Segment::natural or Segment::initial.
enum class ShapeOf { natural, initial };

/// Where the root and the tips of all segments of an unbranched strand are, n + 1 places,
/// from helix to helix; the root stands at `root`.
std::vector<StrandPlace> joints(const Strand& strand, ShapeOf shape,
                                const StrandPlace& root);
/// Where the middles of its segments are, n places.
std::vector<StrandPlace> middles(const Strand& strand, ShapeOf shape,
                                 const StrandPlace& root);

/// Throws InputError naming `model` unless the strand is a chain: segment i hangs on the
/// tip of segment i - 1, in its direction.
void check_unbranched(const Strand& strand, const std::string& model);

}  // namespace tress::models
