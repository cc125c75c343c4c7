#pragma once

#include "models/strand/strand.h"

namespace tress::models {

/// A strand that no elements are known of yet.
struct UncutStrand {
  double length;         // m
  double weight;         // N/m
  double stiffness;      // N m^2, of bending, the smaller one
  Vec tangent;           // at the root; gravity is along -z
  const Shape& natural;  // natural shape
};

/// Returns the number of elements of constant curvature for which the shape of a strand
/// that hangs at rest is within `tolerance` (m). The number is the least of 2, 3, 4, 6,
/// 8, 12, 16 ... up to `most`.
///
/// The curvature k(s) is replaced by its mean over elements of length h. The error of the
/// tangent is then k' ((s - s_c)^2 - h^2/4)/2 within an element and 0 at its ends. All
/// that follows an element is therefore moved by k' h^3/12. Summed over the strand,
///
///     e = h^2/12 |int k' n ds| <= h^2/12 K,    n = L sqrt(K/(12 e)),
///
/// with K the least of the variation int |k'| ds and, by parts, 2 max |k| + int k^2 ds.
/// Three parts are added:
///     natural   of the natural shape
///     sag       a clamped strand under its weight w bends most at the root. The
///               curvature is at most w L^2/(2 EI) if the strand is stiff, and
///               2 sqrt(w L/EI) sin(a/2) if its tension pulls it down, with a the angle
///               of the root, or of the axis of its coil, from the vertical. In axes that
///               wind with the shape by its mean |k|, the bend, w L^3/(6 EI) or a in
///               total, turns round and varies by |k| times that total
///     coil      the weight that hangs from a turn of a coil of radius r bends it
///               w L r/(2 EI) more on one side than on the other, on average, and not
///               more than straight: four times that for each turn
/// Elements also wind by 1.5 rad at most. This estimates the error of space at rest, from
/// above for nearly all strands (tests/simulation/test_detail.cpp). A load that sets in
/// at once in a frame with acceleration a bends 2 (1 + a/g) times as far, and the error
/// grows by as much.
int elements_for(const UncutStrand& strand, double tolerance, int most);

}  // namespace tress::models
