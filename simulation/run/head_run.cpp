#include "simulation/run/head_run.h"

#include <algorithm>
#include <span>
#include <utility>

#include "contract/input_error.h"

namespace tress::simulation {
namespace {

// Of each worker, so that one that is held up does not hold up all; of so many blocks at
// least that lanes without strands at the end of a part cost a few per cent.
constexpr std::size_t parts_of_worker = 32, blocks_of_part = 12;

}  // namespace

HeadRun::HeadRun(std::unique_ptr<Head> head, int threads,
                 std::unique_ptr<models::StrandInteraction> interaction)
    : interaction_(std::move(interaction)), head_(std::move(head)), crew_(threads) {
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

template <class Use>
void HeadRun::each_block(Use use) {
  share([&](std::size_t begin, std::size_t end, Head::Scratch&) {
    // All blocks before are full.
    for (std::size_t b = begin; b < end; ++b) use(b, b * head_->strands_of(0));
  });
}

void HeadRun::exchange(double t) {
  if (!interaction_) return;
  const std::size_t each = head_->numbers();
  x_.resize(each * head_->strands());
  v_.resize(x_.size());
  each_block([&](std::size_t block, std::size_t first) {
    const std::size_t size = each * head_->strands_of(block);
    head_->motion(block, t, std::span(x_).subspan(each * first, size),
                  std::span(v_).subspan(each * first, size));
  });
  interaction_->update(
      x_, v_, [this](std::size_t count, const std::function<void(std::size_t)>& work) {
        crew_.run(count, work);
      });
}

const std::string& HeadRun::move_to_device() {
  if (const auto no = refused_by_device(*head_)) {
    throw InputError(no->reason, "head of hair", no->remedy);
  }
  device_ = device_head(*head_);
  return device_->name();
}

void HeadRun::fetch() {
  if (!device_) return;
  lost_ = device_->fetch(
      [this](std::size_t count, const std::function<void(std::size_t)>& work) {
        crew_.run(count, work);
      });
}

void HeadRun::step(double t, double h) {
  if (device_) {
    lost_.clear();
    return device_->step(t, h);
  }
  exchange(t);
  share([&](std::size_t first, std::size_t last, Head::Scratch& scratch) {
    head_->step(first, last, t, h, scratch);
  });
  lost_ = head_->losses(losses_);
  losses_ += lost_.size();
}

void HeadRun::positions(double t, std::vector<double>& x) {
  const std::size_t each = head_->numbers();
  x.resize(each * head_->strands());
  each_block([&](std::size_t block, std::size_t first) {
    head_->positions(block, t,
                     std::span(x).subspan(each * first, each * head_->strands_of(block)));
  });
}

void HeadRun::energies(double t, std::vector<models::HeadEnergy>& each) {
  each.resize(head_->strands());
  each_block([&](std::size_t block, std::size_t first) {
    head_->energies(block, t, std::span(each).subspan(first, head_->strands_of(block)));
  });
}

HeadWork HeadRun::work() const {
  HeadWork all;
  for (const auto& scratch : scratch_) all += scratch->work;
  return all;
}

}  // namespace tress::simulation
