#pragma once

#include <cstdint>
#include <vector>

#include "experiments/scenes/export.h"

namespace tress {

/// An animation of simulated strands with hairs drawn between them (GuideHair), after
/// them in every frame; of about 60 of its frames, evenly chosen. What a channel says of
/// a hair is what it says of its own guide.
class FullHair {
 public:
  /// Throws InputError when hairs > 0 and the strands have not all as many points, or the
  /// scene has none. hairs = 0: the animation as it is.
  FullHair(const Animation& guides, std::size_t hairs, std::uint64_t seed);
  Animation animation() const;

 private:
  Animation guides_;
  std::vector<int> lines_;
  std::vector<Frame3d> frames_;
};

}  // namespace tress
