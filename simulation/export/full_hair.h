#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/export/export.h"
#include "simulation/export/guide_hair.h"

namespace tress::simulation {

/// Rotation of a head from where it is at rest.
Frame rotation_from_rest(const RootMotion& head, double t);

/// The hair of a groom that follows its guides, each with its own shape: all as they are
/// at t = 0, all cut into equally many elements. Seed: the scene's.
GuideHair hair_that_follows(std::span<const Strand> guides,
                            std::span<const Strand> followers, const RootMotion& head,
                            std::uint64_t seed);

/// Hairs drawn between simulated strands (GuideHair), after them in every frame; in about
/// 60 evenly chosen frames of a recording. A hair takes the channel values of its own
/// guide. Where grooms have guides, the strands that follow these, with their own shapes.
class FullHair {
 public:
  /// Prepares the hair. `guides`: points of each simulated line. hairs = 0: draws the
  /// followers only. With hairs > 0, throws InputError unless the lines are at least
  /// three strands with equal numbers of points and without followers, for which one
  /// guide is enough.
  FullHair(const Scene& scene, std::span<const int> guides, std::size_t hairs);

  /// Returns the number of hairs between guides.
  std::size_t hairs() const { return hair_ ? hair_->hairs() : 0; }
  /// Returns the numbers of points of all lines, given those of the guides.
  std::vector<int> lines(std::span<const int> guides) const;
  /// Returns all lines that are drawn, given the guides.
  std::vector<DrawnLine> drawn(std::vector<DrawnLine> guides) const;
  /// Returns frames with all hairs, given those of the guides.
  std::vector<Frame3d> frames(std::span<const Frame3d> guides) const;

 private:
  Frame3d grown(const Frame3d& guides) const;

  const RootMotion& head_;
  std::size_t points_ = 0;  // of each line
  std::optional<GuideHair> hair_;
};

}  // namespace tress::simulation
