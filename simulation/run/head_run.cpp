#include "simulation/run/head_run.h"

#include <algorithm>
#include <span>
#include <utility>

namespace tress::simulation {
namespace {

// Of each worker, so that one that is held up does not hold up all; of so many blocks at
// least that lanes without strands at the end of a part cost a few per cent.
constexpr std::size_t parts_of_worker = 32, blocks_of_part = 12;

}  // namespace

HeadRun::HeadRun(std::unique_ptr<Head> head, int threads)
    : head_(std::move(head)), crew_(threads) {
  const std::size_t blocks = head_->blocks(), workers = static_cast<std::size_t>(threads);
  const std::size_t parts = std::max(
      std::min(blocks, workers), std::min((blocks + blocks_of_part - 1) / blocks_of_part,
                                          parts_of_worker * workers));
  scratch_.reserve(parts);
  for (std::size_t p = 0; p < parts; ++p) scratch_.push_back(head_->scratch());
}

template <class Use>
void HeadRun::share(Use use) {
  const std::size_t blocks = head_->blocks(), parts = scratch_.size();
  crew_.run(parts, [&](std::size_t p) {
    const std::size_t end = blocks * (p + 1) / parts;
    use(blocks * p / parts, end, *scratch_[p]);
  });
}

void HeadRun::step(double t, double h) {
  share([&](std::size_t first, std::size_t last, Head::Scratch& scratch) {
    head_->step(first, last, t, h, scratch);
  });
}

void HeadRun::positions(double t, std::vector<double>& x) {
  const std::size_t each = head_->numbers();
  x.resize(each * head_->strands());
  share([&](std::size_t begin, std::size_t end, Head::Scratch&) {
    for (std::size_t block = begin; block < end; ++block) {
      // All blocks before are full.
      const std::size_t first = block * head_->strands_of(0);
      head_->positions(
          block, t, std::span(x).subspan(each * first, each * head_->strands_of(block)));
    }
  });
}

HeadWork HeadRun::work() const {
  HeadWork all;
  for (const auto& scratch : scratch_) all += scratch->work;
  return all;
}

}  // namespace tress::simulation
