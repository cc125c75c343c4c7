#include "simulation/run/head_run.h"

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

#include "contract/input_error.h"
#include "simulation/run/timing.h"

namespace tress::simulation {
namespace {

// Of each worker, so that one that is held up does not hold up all; of so many blocks at
// least that lanes without strands at the end of a part cost a few per cent.
constexpr std::size_t parts_of_worker = 32, blocks_of_part = 12;

}  // namespace

HeadRun::HeadRun(std::unique_ptr<Head> head, int threads,
                 std::unique_ptr<models::StrandInteraction> interaction)
    : interaction_(std::move(interaction)),
      head_(std::move(head)),
      ranks_(nullptr),
      begins_{0, head_->blocks()},
      crew_(threads) {
  ready_scratch();
}

HeadRun::HeadRun(std::unique_ptr<Head> head, int threads,
                 std::unique_ptr<models::StrandInteraction> interaction, Ranks& ranks)
    : HeadRun(std::move(head), threads, std::move(interaction)) {
  if (ranks.size() == 1) return;
  ranks_ = &ranks;
  rank_ = static_cast<std::size_t>(ranks.rank());
  const auto size = static_cast<std::size_t>(ranks.size());
  begins_.resize(size + 1);
  for (std::size_t r = 0; r <= size; ++r) begins_[r] = head_->blocks() * r / size;
}

void HeadRun::ready_scratch() {
  const std::size_t blocks = head_->blocks(), workers = crew_.workers();
  const std::size_t parts = std::max(
      std::min(blocks, workers), std::min((blocks + blocks_of_part - 1) / blocks_of_part,
                                          parts_of_worker * workers));
  scratch_.reserve(parts);
  for (std::size_t p = 0; p < parts; ++p) scratch_.push_back(head_->scratch());
}

template <class Use>
void HeadRun::share(Use use) {
  const std::size_t blocks = end() - begin(), parts = scratch_.size();
  crew_.run(parts, [&](std::size_t p) {
    use(begin() + blocks * p / parts, begin() + blocks * (p + 1) / parts, *scratch_[p]);
  });
}

template <class Use>
void HeadRun::each_block(Use use) {
  share([&](std::size_t first, std::size_t last, Head::Scratch&) {
    for (std::size_t b = first; b < last; ++b) use(b, strands_before(b));
  });
}

/// All blocks but the last are full.
std::size_t HeadRun::strands_before(std::size_t block) const {
  return std::min(block * head_->strands_of(0), head_->strands());
}

void HeadRun::share_numbers(std::span<double> x, std::size_t each) {
  if (ranks_ == nullptr) return;
  std::vector<std::size_t> sizes(begins_.size() - 1);
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    sizes[r] = each * (strands_before(begins_[r + 1]) - strands_before(begins_[r]));
  }
  ranks_->share(x, sizes);
}

void HeadRun::gather() {
  if (ranks_ == nullptr) return;
  const std::size_t each = head_->kept();
  std::vector<double> kept(each * head_->strands());
  each_block([&](std::size_t block, std::size_t first) {
    head_->keep(block,
                std::span(kept).subspan(each * first, each * head_->strands_of(block)));
  });
  share_numbers(kept, each);
  recall(kept);
  balance();
}

void HeadRun::follow_first() {
  if (ranks_ == nullptr) return;
  const std::size_t each = head_->kept();
  std::vector<double> kept(each * head_->strands());
  for (std::size_t b = 0; b < head_->blocks(); ++b) {
    head_->keep(b, std::span(kept).subspan(each * strands_before(b),
                                           each * head_->strands_of(b)));
  }
  std::vector<std::size_t> sizes(begins_.size() - 1, 0);
  sizes.front() = kept.size();
  ranks_->share(kept, sizes);
  recall(kept);
}

void HeadRun::recall(std::span<const double> kept) {
  const std::size_t each = head_->kept();
  for (std::size_t b = 0; b < head_->blocks(); ++b) {
    head_->recall(b, kept.subspan(each * strands_before(b), each * head_->strands_of(b)));
  }
}

void HeadRun::balance() {
  const std::size_t size = begins_.size() - 1;
  std::vector<double> seconds(size);
  seconds[rank_] = stepping_s_;
  ranks_->share(seconds, std::vector<std::size_t>(size, 1));
  stepping_s_ = 0;
  double all = 0;
  for (const double one : seconds) all += one;
  if (std::ranges::any_of(seconds, [](double s) { return !(s > 0); })) return;
  // Blocks of a range cost the same.
  const std::vector<std::size_t> before = begins_;
  double passed = 0;
  std::size_t r = 0;
  for (std::size_t next = 1; next < size; ++next) {
    const double wanted = all * static_cast<double>(next) / static_cast<double>(size);
    while (r + 1 < size && passed + seconds[r] < wanted) passed += seconds[r++];
    const double share_of_range = std::clamp((wanted - passed) / seconds[r], 0.0, 1.0);
    begins_[next] =
        before[r] + static_cast<std::size_t>(
                        share_of_range * static_cast<double>(before[r + 1] - before[r]));
  }
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
  share_numbers(x_, each);
  share_numbers(v_, each);
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
  stepping_s_ += seconds_of([&] {
    share([&](std::size_t first, std::size_t last, Head::Scratch& scratch) {
      head_->step(first, last, t, h, scratch);
    });
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
  share_numbers(x, each);
}

void HeadRun::energies(double t, std::vector<models::HeadEnergy>& each) {
  each.resize(head_->strands());
  each_block([&](std::size_t block, std::size_t first) {
    head_->energies(block, t, std::span(each).subspan(first, head_->strands_of(block)));
  });
  constexpr std::size_t numbers = sizeof(models::HeadEnergy) / sizeof(double);
  static_assert(std::is_trivially_copyable_v<models::HeadEnergy> &&
                sizeof(models::HeadEnergy) % sizeof(double) == 0);
  share_numbers({reinterpret_cast<double*>(each.data()), numbers * each.size()}, numbers);
}

HeadWork HeadRun::work() const {
  HeadWork all;
  for (const auto& scratch : scratch_) all += scratch->work;
  return all;
}

}  // namespace tress::simulation
