#include "simulation/head/head_run.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "contract/input_error.h"
#include "models/head/state_hash.h"
#include "simulation/run/timing.h"

namespace tress::simulation {
namespace {

// Of each worker, so that one that is held up does not hold up all; unless that leaves a
// part fewer blocks than it fills lanes with (Head::blocks_at_once()).
constexpr std::size_t parts_of_worker = 32;
constexpr std::size_t hashed_at_once = 4096;

}  // namespace

HeadRun::HeadRun(std::unique_ptr<Head> head, int threads,
                 std::unique_ptr<models::StrandInteraction> interaction)
    : HeadRun(SceneHead{.interaction = std::move(interaction),
                        .head = std::move(head),
                        .guard = {},
                        .guarded = false,
                        .lanes = true,
                        .division = {},
                        .halo = {},
                        .passages = {},
                        .held = {}},
              threads, alone_) {}

HeadRun::HeadRun(SceneHead made, int threads, Ranks& ranks)
    : ranks_(&ranks),
      division_(made.division ? std::move(made.division)
                              : std::make_shared<HeadDivision>(made.head->strands())),
      interaction_(std::move(made.interaction)),
      halo_(std::move(made.halo)),
      head_(std::move(made.head)),
      guard_(std::move(made.guard)),
      guarded_(guard_ && made.guarded),
      passages_(std::move(made.passages)),
      lanes_(made.lanes),
      crew_(threads) {
  all_ = pieces([](std::size_t) { return true; });
  inner_ = all_;
  for (std::size_t w = 0; w < crew_.workers(); ++w) {
    scratch_.push_back(head_->scratch());
  }
  if (!lanes_) look(0, 0);
  if (!guarded_) return;
  each_block([&](std::size_t block, std::size_t first) {
    guard_->start(*head_, block, first, 0);
  });
}

std::vector<HeadRun::Blocks> HeadRun::pieces(
    const std::function<bool(std::size_t)>& wanted) const {
  const std::size_t blocks = head_->blocks(), workers = crew_.workers(),
                    at_once = head_->blocks_at_once();
  const std::size_t parts =
      std::max(std::min(blocks, workers),
               std::min((blocks + at_once - 1) / at_once, parts_of_worker * workers));
  std::vector<Blocks> all;
  for (std::size_t b = 0; b < blocks; ++b) {
    if (!wanted(b)) continue;
    const bool goes_on = !all.empty() && all.back().end == b &&
                         (all.back().end - all.back().begin) * parts < blocks;
    if (!goes_on) all.push_back({b, b});
    ++all.back().end;
  }
  return all;
}

template <class Use>
void HeadRun::share(const std::vector<Blocks>& among, Use use) {
  crew_.run(among.size(),
            [&](std::size_t i, std::size_t worker) { use(among[i], *scratch_[worker]); });
}

template <class Use>
void HeadRun::each_block(Use use) {
  share(all_, [&](const Blocks& blocks, Head::Scratch&) {
    for (std::size_t b = blocks.begin; b < blocks.end; ++b) use(b, first_of(b));
  });
}

/// All blocks but the last are full.
std::size_t HeadRun::first_of(std::size_t block) const {
  return block * head_->strands_of(0);
}

models::Loop HeadRun::loop() {
  return [this](std::size_t count, const std::function<void(std::size_t)>& work) {
    crew_.run(count, work);
  };
}

void HeadRun::own_blocks_of(
    Numbers strands,
    const std::function<void(std::size_t, std::span<const HeadDivision::Listed>)>& use) {
  if (head_->blocks() == 0) return;
  const std::vector<HeadDivision::Listed> own = division_->own_among(strands);
  const std::size_t lanes = head_->strands_of(0);
  std::vector<std::span<const HeadDivision::Listed>> blocks;
  for (std::size_t i = 0, begin = 0; i < own.size(); ++i) {
    const bool last =
        i + 1 == own.size() || own[i + 1].place / lanes != own[i].place / lanes;
    if (!last) continue;
    blocks.push_back(std::span(own).subspan(begin, i + 1 - begin));
    begin = i + 1;
  }
  crew_.run(blocks.size(),
            [&](std::size_t i) { use(blocks[i].front().place / lanes, blocks[i]); });
}

void HeadRun::collect(Numbers strands, std::size_t each, const Read& read,
                      std::vector<double>& all) {
  const std::vector<std::size_t> counts = division_->counts(strands);
  std::vector<double> own(each * counts[static_cast<std::size_t>(ranks_->rank())]);
  own_blocks_of(strands,
                [&](std::size_t block, std::span<const HeadDivision::Listed> some) {
                  std::vector<double> of_block(each * head_->strands_of(block));
                  read(block, of_block);
                  for (const HeadDivision::Listed& one : some) {
                    std::copy_n(&of_block[each * (one.place - first_of(block))], each,
                                &own[each * one.index]);
                  }
                });
  if (ranks_->size() == 1) {
    all = std::move(own);
    return;
  }
  std::vector<std::size_t> sizes(counts);
  for (std::size_t& size : sizes) size *= each;
  std::vector<double> by_ranks(ranks_->first() ? each * strands.size() : 0);
  ranks_->to_first(std::span(own), std::span(by_ranks), sizes);
  all.resize(by_ranks.size());
  if (!ranks_->first()) return;
  std::vector<std::size_t> next(counts.size());
  std::exclusive_scan(sizes.begin(), sizes.end(), next.begin(), std::size_t{0});
  for (std::size_t i = 0; i < strands.size(); ++i) {
    std::size_t& from = next[static_cast<std::size_t>(division_->owner(strands[i]))];
    std::copy_n(&by_ranks[from], each, &all[each * i]);
    from += each;
  }
}

void HeadRun::positions(double t, Numbers strands, std::vector<double>& x) {
  collect(
      strands, head_->numbers(),
      [&](std::size_t block, std::span<double> to) { head_->positions(block, t, to); },
      x);
}

void HeadRun::keep(Numbers strands, std::vector<double>& to) {
  collect(
      strands, kept(), [&](std::size_t block, std::span<double> x) { keep(block, x); },
      to);
}

void HeadRun::keep(std::size_t block, std::span<double> to) const {
  if (!guarded_) return head_->keep(block, to);
  const std::size_t count = head_->strands_of(block), each = kept(),
                    of_head = head_->kept();
  std::vector<double> state(of_head * count);
  head_->keep(block, state);
  for (std::size_t k = 0; k < count; ++k) {
    std::copy_n(&state[of_head * k], of_head, &to[each * k]);
    guard_->keep(first_of(block) + k, to.subspan(each * k + of_head));
  }
}

void HeadRun::recall(std::size_t block, std::span<const double> from) {
  if (!guarded_) return head_->recall(block, from);
  const std::size_t count = head_->strands_of(block), each = kept(),
                    of_head = head_->kept();
  std::vector<double> state(of_head * count);
  for (std::size_t k = 0; k < count; ++k) {
    std::copy_n(&from[each * k], of_head, &state[of_head * k]);
    guard_->recall(first_of(block) + k, from.subspan(each * k + of_head));
  }
  head_->recall(block, state);
}

void HeadRun::recall(Numbers strands, std::vector<double>& kept_of_all) {
  if (passages_) passages_->forget();
  const std::size_t each = kept();
  const std::vector<std::size_t> counts = division_->counts(strands);
  std::vector<double> own(each * counts[static_cast<std::size_t>(ranks_->rank())]),
      by_ranks(kept_of_all.size());
  std::vector<std::size_t> sizes(counts), next(counts.size());
  for (std::size_t& size : sizes) size *= each;
  std::exclusive_scan(sizes.begin(), sizes.end(), next.begin(), std::size_t{0});
  for (std::size_t i = 0; ranks_->first() && i < strands.size(); ++i) {
    std::size_t& to = next[static_cast<std::size_t>(division_->owner(strands[i]))];
    std::copy_n(&kept_of_all[each * i], each, &by_ranks[to]);
    to += each;
  }
  ranks_->from_first(std::span(by_ranks), sizes, std::span(own));
  own_blocks_of(strands,
                [&](std::size_t block, std::span<const HeadDivision::Listed> some) {
                  std::vector<double> of_block(each * head_->strands_of(block));
                  keep(block, of_block);
                  for (const HeadDivision::Listed& one : some) {
                    std::copy_n(&own[each * one.index], each,
                                &of_block[each * (one.place - first_of(block))]);
                  }
                  recall(block, of_block);
                });
}

void HeadRun::by_chunks(std::size_t chunk,
                        const std::function<void(Numbers)>& use) const {
  std::vector<std::size_t> numbers;
  for (std::size_t begin = 0; begin < strands(); begin += chunk) {
    numbers.resize(std::min(chunk, strands() - begin));
    std::iota(numbers.begin(), numbers.end(), begin);
    use(numbers);
  }
}

std::size_t HeadRun::hash() {
  models::StateHash all;
  std::vector<double> kept;
  by_chunks(hashed_at_once, [&](Numbers strands) {
    collect(
        strands, head_->kept(),
        [&](std::size_t block, std::span<double> to) { head_->keep(block, to); }, kept);
    all.add(*head_, kept);
  });
  return all.value();
}

void HeadRun::look(double t, double h) {
  if (!interaction_) return;
  const std::size_t each = head_->numbers();
  x_.resize(each * head_->strands());
  v_.resize(x_.size());
  if (halo_) {
    ahead_.resize(x_.size());
    bulge_.resize(head_->strands());
  }
  const std::span<const std::size_t> order = division_->order();
  each_block([&](std::size_t block, std::size_t first) {
    const std::size_t count = head_->strands_of(block);
    std::vector<double> of_block(each * count), more(of_block.size());
    const auto put = [&](const std::vector<double>& from, std::vector<double>& to) {
      for (std::size_t k = 0; k < count; ++k) {
        std::copy_n(&from[each * k], each, &to[each * order[first + k]]);
      }
    };
    head_->motion(block, t, of_block, more);
    put(of_block, x_);
    put(more, v_);
    if (!halo_) return;
    std::vector<double> bulge(count);
    head_->ahead(block, t, h, of_block, bulge);
    put(of_block, ahead_);
    for (std::size_t k = 0; k < count; ++k) bulge_[order[first + k]] = bulge[k];
  });
  if (halo_) {
    if (halo_->look(t, h, {x_, ahead_, bulge_}, loop())) {
      const std::size_t lanes = head_->strands_of(0);
      std::vector<char> touched(head_->blocks());
      for (const std::size_t i : halo_->touched()) {
        touched[division_->by_number()[i] / lanes] = 1;
      }
      inner_ = pieces([&](std::size_t b) { return touched[b] == 0; });
      outer_ = pieces([&](std::size_t b) { return touched[b] != 0; });
    }
    halo_->send(x_, v_);
  } else if (ranks_->size() > 1) {
    share_motion();
  }
  interaction_->update(x_, v_, loop());
}

void HeadRun::share_motion() {
  const std::size_t each = head_->numbers();
  std::vector<std::size_t> numbers(strands());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  const std::vector<std::size_t> counts = division_->counts(numbers);
  std::vector<std::size_t> sizes(counts), first(counts.size());
  for (std::size_t& size : sizes) size *= each;
  std::exclusive_scan(sizes.begin(), sizes.end(), first.begin(), std::size_t{0});
  for (std::vector<double>* own : {&x_, &v_}) {
    std::vector<double> by_ranks(each * strands()), all(by_ranks.size());
    std::ranges::copy(
        *own, by_ranks.begin() + static_cast<std::ptrdiff_t>(
                                     first[static_cast<std::size_t>(ranks_->rank())]));
    ranks_->share(std::span(by_ranks), sizes);
    std::vector<std::size_t> next(first);
    for (const std::size_t k : numbers) {
      std::size_t& from = next[static_cast<std::size_t>(division_->owner(k))];
      std::copy_n(&by_ranks[from], each, &all[each * k]);
      from += each;
    }
    *own = std::move(all);
  }
}

const std::string& HeadRun::move_to_device() {
  if (const auto no = refused_by_device(*head_)) {
    throw InputError(no->reason, "batch", no->remedy);
  }
  device_ = device_head(*head_);
  return device_->name();
}

void HeadRun::fetch() {
  if (!device_) return;
  lost_ = device_->fetch(loop());
}

void HeadRun::take_steps(const std::vector<Blocks>& of, double t, double h) {
  stepping_s_ += seconds_of([&] {
    share(of, [&](const Blocks& blocks, Head::Scratch& scratch) {
      head_->step(blocks.begin, blocks.end, t, h, scratch);
    });
  });
}

void HeadRun::step(double t, double h) {
  if (device_) {
    lost_.clear();
    device_->step(t, h);
    taken(t, h, [this] { fetch(); });
    return;
  }
  look(t, h);
  const bool searched = passages_ && passages_->due(t, h);
  if (searched && !passages_->knows(t)) positions(t, passages_->x);
  take_steps(inner_, t, h);
  if (halo_) {
    halo_->receive(x_, v_, loop());
    take_steps(outer_, t, h);
  }
  if (searched) find_passages(t + h, h);
  lost_ = head_->losses(losses_);
  losses_ += lost_.size();
  for (models::HeadLoss& loss : lost_) loss.strand = division_->own()[loss.strand];
  taken(t, h, [] {});
}

void HeadRun::find_passages(double t, double h) {
  std::vector<double> now;
  positions(t, now);
  const std::size_t each = head_->numbers();
  std::vector<double> longest(head_->blocks());
  std::vector<std::optional<StrandPassage>> found(head_->blocks());
  each_block([&](std::size_t block, std::size_t first) {
    for (std::size_t k = first; k < first + head_->strands_of(block); ++k) {
      if (head_->lost(k)) continue;
      const auto one =
          passages_->find({t - h, t, std::span(passages_->x).subspan(each * k, each),
                           std::span(now).subspan(each * k, each)});
      longest[block] = std::max(longest[block], one.longest);
      if (one.missed && !found[block]) found[block] = {division_->own()[k], *one.missed};
    }
  });
  std::optional<StrandPassage> any;
  for (const auto& one : found) {
    if (one && (!any || one->strand < any->strand)) any = one;
  }
  passages_->take(t, std::move(now), *std::ranges::max_element(longest), any);
}

std::optional<StrandPassage> HeadRun::passed() const {
  if (passages_) return passages_->first;
  std::optional<StrandPassage> first = guard_ ? guard_->passed() : std::nullopt;
  if (first) first->strand = division_->own()[first->strand];
  return first;
}

template <class Ready>
void HeadRun::taken(double t, double h, Ready ready) {
  ++steps_;
  if (!guarded_ || !guard_->due(t + h, h)) return;
  ready();
  find_failed(t + h, t);
}

void HeadRun::judge(double t) {
  lost_.clear();
  if (guarded_) find_failed(t, t);
}

void HeadRun::find_failed(double t, double start) {
  each_block([&](std::size_t block, std::size_t first) {
    guard_->judge(*head_, block, first, t);
  });
  for (std::size_t k = 0; k < head_->strands(); ++k) {
    const std::string_view reason = guard_->verdict(k);
    if (reason.empty() || head_->lost(k)) continue;
    change().lose(k);
    lost_.push_back({division_->own()[k], steps_, start, reason});
  }
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

void HeadRun::potentials(double t, std::vector<double>& each) {
  each.resize(effects() * head_->strands());
  if (each.empty()) return;
  each_block([&](std::size_t block, std::size_t first) {
    guard_->potentials(
        *head_, block, first, t,
        std::span(each).subspan(effects() * first, effects() * head_->strands_of(block)));
  });
}

Excess HeadRun::excess() {
  Excess most;
  const Excess own = guarded_ ? guard_->excess() : Excess();
  for (const Excess& one : ranks_->of_each(own)) most.take(one);
  return most;
}

std::string HeadRun::no_dissipation() const {
  return guard_ ? guard_->no_dissipation() : "a batch of no scene has no guard";
}

std::optional<MethodDissipation> HeadRun::dissipation() {
  if (!no_dissipation().empty()) return {};
  MethodDissipation sum;
  for (const MethodDissipation& one : ranks_->of_each(guard_->dissipation())) sum += one;
  return sum;
}

double HeadRun::stepping_s() { return std::exchange(stepping_s_, 0); }

HeadWork HeadRun::work() const {
  HeadWork all;
  for (const auto& scratch : scratch_) all += scratch->work;
  return all;
}

}  // namespace tress::simulation
