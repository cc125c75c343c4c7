#include "simulation/run/head_run.h"

#include <algorithm>
#include <span>
#include <utility>

namespace tress::simulation {
namespace {

// Of each worker, so that one that is held up does not hold up all.
constexpr std::size_t parts_of_worker = 32;
constexpr std::size_t most_lanes = 16;

}  // namespace

HeadRun::HeadRun(std::unique_ptr<Head> head, int threads)
    : head_(std::move(head)), crew_(threads) {
  const std::size_t parts =
      std::min(head_->blocks(), parts_of_worker * static_cast<std::size_t>(threads));
  scratch_.reserve(parts);
  for (std::size_t p = 0; p < parts; ++p) scratch_.push_back(head_->scratch());
  lost_of_.resize(parts);
}

template <class Use>
void HeadRun::share(Use use) {
  const std::size_t blocks = head_->blocks(), parts = scratch_.size();
  crew_.run(parts, [&](std::size_t p) {
    const std::size_t end = blocks * (p + 1) / parts;
    // All blocks before are full.
    for (std::size_t b = blocks * p / parts; b < end; ++b) {
      use(b, b * head_->strands_of(0), p);
    }
  });
}

void HeadRun::step(double t, double h) {
  share([&](std::size_t block, std::size_t first, std::size_t part) {
    bool was[most_lanes] = {};
    const std::size_t count = head_->strands_of(block);
    for (std::size_t k = 0; k < count; ++k) was[k] = head_->lost(first + k);
    head_->step(block, t, h, *scratch_[part]);
    for (std::size_t k = 0; k < count; ++k) {
      if (!was[k] && head_->lost(first + k)) lost_of_[part].push_back(first + k);
    }
  });
  lost_.clear();
  for (std::vector<std::size_t>& part : lost_of_) {
    lost_.insert(lost_.end(), part.begin(), part.end());
    part.clear();
  }
}

void HeadRun::positions(double t, std::vector<double>& x) {
  const std::size_t each = head_->numbers();
  x.resize(each * head_->strands());
  share([&](std::size_t block, std::size_t first, std::size_t) {
    head_->positions(block, t,
                     std::span(x).subspan(each * first, each * head_->strands_of(block)));
  });
}

void HeadRun::energies(double t, std::vector<models::HeadEnergy>& each) {
  each.resize(head_->strands());
  share([&](std::size_t block, std::size_t first, std::size_t) {
    head_->energies(block, t, std::span(each).subspan(first, head_->strands_of(block)));
  });
}

}  // namespace tress::simulation
