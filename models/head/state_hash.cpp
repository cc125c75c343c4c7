#include "models/head/state_hash.h"

#include <vector>

namespace tress::models {

void StateHash::add(const Head& head, std::span<const double> kept) {
  for (std::size_t strand = 0; strand < kept.size(); strand += head.kept()) {
    for (const double entry : kept.subspan(strand, head.kept_of_state())) {
      all_ = (all_ ^ std::bit_cast<std::uint64_t>(entry)) * 1099511628211U;
    }
  }
}

std::size_t Head::hash() const {
  StateHash all;
  std::vector<double> kept_of_block;
  for (std::size_t block = 0; block < blocks(); ++block) {
    kept_of_block.resize(kept() * strands_of(block));
    keep(block, kept_of_block);
    all.add(*this, kept_of_block);
  }
  return all.value();
}

}  // namespace tress::models
