#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contract/layers.h"
#include "math/frame.h"

namespace tress::simulation {

/// Returns `count` roots between those of the guides. Root h lies in the triangle of
/// guide h mod guides and two of its four nearest, drawn at random, uniformly over its
/// area. In a round scalp of radius R it lies up to e^2/(6R) deep, e the longest edge. A
/// root does not depend on how many come after it. O(count guides).
std::vector<Vec> scatter_roots(std::span<const Vec> guide_roots, std::size_t count,
                               std::uint64_t seed);

/// Options of the interpolation.
struct GuideHairOptions {
  /// 0: every hair is interpolated to its tip; 1: disjoint locks from the root on.
  double clumpiness = 0.5;
  /// Guides whose tips are this far apart (m, > 0) or farther share no hair.
  double tip_limit = 0.04;
  /// Width of a lock at its tip over that at its root, at clumpiness 1; in [0, 1].
  double tip_width = 0.1;
  std::uint64_t seed = 1;  // for the point where each hair leaves its neighbours
  /// Weights by which what varies linearly over the roots is interpolated exactly, or
  /// nearly: see below. They may be negative.
  bool linear = false;
};

/// Hair between simulated guides, for pictures and export. The scheme is the
/// semi-interpolating one of Bertails et al. 2006 (Super-Helices, section 4.1 and figure
/// 4): interpolation near the scalp, extrapolation from one guide near the tip. The paper
/// states the idea; the formulas here are ours. A guide has n points at s = 0..1 (equal
/// steps). Those of guide k are p_k(s), and its root is r_k. The root of hair h is x_h,
/// and H is the head's frame:
///
///     hair(s)     = (1 - m) mean(s) + m lock(s)
///     mean(s)     = p_o(0) + H (x_h - r_o) + sum_k w_k (p_k(s) - p_k(0))
///     lock(s)     = p_o(s) + (1 - c s (1 - tip_width)) T_o(s) H (x_h - r_o)
///     m(s)        = S(2 (s - 1 + 3 c_h/2)),   S(y) = 3 y^2 - 2 y^3 kept to [0, 1]
///
/// c is the clumpiness and c_h that of this hair, drawn within c +- 0.4 c (1 - c). The
/// guide with the nearest root is o. T_o(s) carries the root's cross-section along guide
/// o without twist (Bishop 1975: smallest rotations from tangent to tangent).
///
/// The weights are those of the three guides with the nearest roots, at distances d_k,
/// with R the distance of the fourth: (1/d_k - 1/R)^2 (Franke & Nielson 1980). They
/// vanish where a guide enters or leaves the set, so they are continuous over the scalp.
/// A guide across a parting has no weight. Each weight is multiplied by 1 - S(2
/// D_k/tip_limit - 1), with D_k the present distance of its tip from the own guide's, so
/// that hair leaves a guide gradually. All are then divided by their sum.
///
/// `linear` moves these weights as little as is needed for sum_k w_k r_k = x_h. They
/// minimise |sum_k w_k r_k - x_h|^2 + e l^2 |w - w(above)|^2 under sum_k w_k = 1. The
/// distance of the farthest of the three is l, and e = 1e-3. Where the three lie on a
/// line, only the component along it is exact. The own guide receives the weight that a
/// guide loses at a parting. A hair that keeps its shape (keep_shapes) then errs in
/// second order of the guides' distance where motions vary smoothly, and in first order
/// without.
///
/// A hair rooted at a guide's root is that guide. Where the guides' directions differ
/// their mean, and so the hair, is shorter than they are.
class GuideHair {
 public:
  /// Roots in m in the head's own frame; all guides have `points` points. Throws
  /// InputError if there is no guide, fewer than two points, a number that is not finite
  /// or an option out of range. O(hairs guides).
  GuideHair(std::vector<Vec> guide_roots, std::vector<Vec> hair_roots, std::size_t points,
            const GuideHairOptions& options);

  /// Weights at rest, before the distance of tips is considered. With fewer than three
  /// guides the last weights are 0.
  struct Neighbours {
    std::array<std::size_t, 3> guide{};  // the own guide first
    std::array<double, 3> weight{};      // sum 1
  };
  /// Returns the guides and weights of a hair.
  const Neighbours& neighbours(std::size_t hair) const { return neighbours_[hair]; }
  /// Returns the number of hairs.
  std::size_t hairs() const { return hair_roots_.size(); }

  /// Lets every hair keep its own shape from now on. Its present difference from the
  /// formula above is carried along by T_o(s) H of its own guide. Arguments as for
  /// grow(); `hairs` are the positions that belong to the positions `guides`.
  void keep_shapes(std::span<const Vec> guides, const Frame& head,
                   std::span<const Vec> hairs);

  /// Computes one frame, in the world. `guides` has the points guide after guide, from
  /// root to tip. `head` maps components in the head's frame to world components. `hairs`
  /// receives the hairs in the order of their roots. Throws InputError if a length is not
  /// guides x points or hairs x points. O((guides + 3 hairs) points).
  void grow(std::span<const Vec> guides, const Frame& head, std::span<Vec> hairs) const;

 private:
  std::vector<Vec> guide_roots_, hair_roots_;
  std::size_t points_;
  GuideHairOptions options_;
  std::vector<Neighbours> neighbours_;
  std::vector<double> clumpiness_;  // of each hair
  std::vector<Vec> own_shapes_;     // of each hair, in its guide's cross-sections
};

}  // namespace tress::simulation
