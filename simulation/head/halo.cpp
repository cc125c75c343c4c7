#include "simulation/head/halo.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "simulation/run/timing.h"

namespace tress::simulation {
namespace {

using models::Box;
using models::Loop;

// Steps for which a point has room if it goes on as in the first, seen from the head, and
// what it has at least, over the reach. Strands that may touch ghosts look for all their
// neighbours anew when claims are made, which takes as long as to step some 24 times
// (StrandPartners), against few ghosts more.
constexpr double steps_of_room = 16, least_room = 0.25;
// Of places, in 32 bits, over the size of the head.
constexpr double place_rounding = 2e-6;
constexpr double farthest = 1e100;  // m: what is beyond it is near to nothing

Vec in_head(const models::RootPose& pose, const double* x) {
  return pose.frame.back(load3(x) - pose.x);
}
/// NaN is none.
bool is_place(const Vec& x) { return norm(x) < farthest; }

void each_strand(std::size_t count, const Loop& loop,
                 const std::function<void(std::size_t)>& use) {
  constexpr std::size_t part = 64;
  loop((count + part - 1) / part, [&](std::size_t p) {
    for (std::size_t i = p * part; i < std::min(count, (p + 1) * part); ++i) use(i);
  });
}

}  // namespace

Halo::Halo(Ranks& ranks, std::shared_ptr<const HeadDivision> division,
           models::RootMotion motion, const models::StrandInteraction& interaction,
           std::vector<std::shared_ptr<ChosenEffect>> effects, std::size_t points)
    : ranks_(ranks),
      division_(std::move(division)),
      motion_(std::move(motion)),
      interaction_(interaction),
      effects_(std::move(effects)),
      points_(points),
      at_(points * own()),
      room_(points * own()),
      boxes_(own()) {
  motion_.frame = {};
}

bool Halo::look(double t, double h, const Places& places, const Loop& loop) {
  ++work_.steps;
  const models::RootPose pose = motion_.at(t);
  bool left = true, anew = false;
  work_.claim_s += seconds_of([&] { left = !claimed_ || left_room(places, pose, loop); });
  work_.exchange_s += seconds_of([&] { anew = ranks_.largest(left ? 1 : 0) > 0; });
  if (!anew) return false;
  work_.claim_s += seconds_of([&] {
    claimed_ = true;
    ++work_.claims;
    claim(places, pose, motion_.at(t + h), loop);
    find_neighbours(loop);
    find_met(loop);
  });
  return true;
}

/// A point of an element between two tips is within its bulge of where the same share of
/// the line between them is.
bool Halo::left_room(const Places& places, const models::RootPose& pose,
                     const Loop& loop) const {
  std::atomic<bool> left = false;
  each_strand(own(), loop, [&](std::size_t k) {
    for (std::size_t i = points_ * k; i < points_ * (k + 1); ++i) {
      const auto within = [&](const double* x, double room) {
        const Vec now = in_head(pose, x);
        return !is_place(now) || norm(now - at_[i]) <= room;
      };
      if (!within(&places.x[3 * i], room_[i]) ||
          !within(&places.ahead[3 * i], room_[i] - places.bulge[k])) {
        left = true;
      }
    }
  });
  return left;
}

void Halo::claim(const Places& places, const models::RootPose& now,
                 const models::RootPose& next, const Loop& loop) {
  const double reach = interaction_.reach();
  each_strand(own(), loop, [&](std::size_t k) {
    boxes_[k] = Box::none();
    for (std::size_t i = points_ * k; i < points_ * (k + 1); ++i) {
      at_[i] = in_head(now, &places.x[3 * i]);
      // In the step it meets others where they are now, later where they are with it.
      const Vec in_step = in_head(now, &places.ahead[3 * i]),
                later = in_head(next, &places.ahead[3 * i]);
      const bool known = is_place(in_step) && is_place(later) && is_place(at_[i]);
      room_[i] =
          least_room * reach + places.bulge[k] +
          (known ? norm(in_step - at_[i]) + steps_of_room * norm(later - at_[i]) : 0);
      if (!is_place(at_[i])) continue;
      Box box{at_[i], at_[i]};
      box.grow(room_[i]);
      boxes_[k].include(box);
    }
  });
  claims_ = Box::none();
  for (const Box& box : boxes_) claims_.include(box);
  // The same cells on all ranks, not many for a claim.
  const double rooms = std::accumulate(room_.begin(), room_.end(), 0.0) /
                       static_cast<double>(room_.size());
  const auto least = [&](double x) { return -ranks_.largest(-x); };
  corner_ = {least(claims_.least.x), least(claims_.least.y), least(claims_.least.z)};
  const double side = std::max({ranks_.largest(claims_.most.x) - corner_.x,
                                ranks_.largest(claims_.most.y) - corner_.y,
                                ranks_.largest(claims_.most.z) - corner_.z});
  rounding_ = place_rounding * side;
  size_ = std::max({reach, 0.5 * ranks_.largest(rooms), side / CellSet::most_cells});
}

template <class Use>
void Halo::each_piece(std::size_t strand, Use use) const {
  for (std::size_t i = points_ * strand; i + 1 < points_ * (strand + 1); ++i) {
    const Vec &a = at_[i], &b = at_[i + 1];
    if (!is_place(a) || !is_place(b)) continue;
    const double length = norm(b - a),
                 room = std::max(room_[i], room_[i + 1]) + rounding_;
    const double count = std::clamp(std::ceil(length / std::max(size_, room)), 1.0,
                                    2 * CellSet::most_cells);
    for (double k = 0; k < count; ++k) {
      Box box{a + (k / count) * (b - a), a + (k / count) * (b - a)};
      box.include(a + ((k + 1) / count) * (b - a));
      use(box, room);
    }
  }
}

/// Own strands whose claims come within reach of these cells.
std::vector<std::size_t> Halo::near(const CellSet& cells, const Loop& loop) const {
  std::vector<char> is_near(own());
  each_strand(own(), loop, [&](std::size_t i) {
    Box all = boxes_[i];
    all.grow(interaction_.reach() + rounding_);
    if (all.empty() || apart(all, cells.all())) return;
    each_piece(i, [&](Box box, double room) {
      if (is_near[i] != 0) return;
      box.grow(room + interaction_.reach());
      if (cells.holds_some(box)) is_near[i] = 1;
    });
  });
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < own(); ++i) {
    if (is_near[i] != 0) found.push_back(i);
  }
  return found;
}

void Halo::find_neighbours(const Loop& loop) {
  CellSet own_cells(corner_, size_, claims_);
  each_strand(own(), loop, [&](std::size_t i) {
    each_piece(i, [&](Box box, double room) {
      box.grow(room);
      own_cells.mark(box);
    });
  });
  const auto size = static_cast<std::size_t>(ranks_.size()),
             rank = static_cast<std::size_t>(ranks_.rank());
  const std::vector<Box> boxes = ranks_.of_each(claims_);
  std::vector<CellSet> sets;
  std::vector<std::size_t> counts;
  std::size_t all = 0;
  for (const Box& box : boxes) {
    sets.emplace_back(corner_, size_, box);
    counts.push_back(sets.back().marks().size());
    all += counts.back();
  }
  std::vector<char> marks(all);
  std::size_t first = 0;
  for (std::size_t r = 0; r < rank; ++r) first += counts[r];
  std::ranges::copy(own_cells.marks(),
                    marks.begin() + static_cast<std::ptrdiff_t>(first));
  ranks_.share(std::span(marks), counts);
  std::vector<std::size_t> sent(size);
  neighbours_.clear();
  first = 0;
  for (std::size_t r = 0; r < size; first += counts[r++]) {
    if (r == rank) continue;
    std::copy_n(marks.begin() + static_cast<std::ptrdiff_t>(first), counts[r],
                sets[r].marks().begin());
    Neighbour neighbour{static_cast<int>(r), near(sets[r], loop), {}, {}, {}};
    sent[r] = neighbour.sent.size();
    if (sent[r] > 0) neighbours_.push_back(std::move(neighbour));
  }
  // Strands that may touch are found by both of their ranks.
  const std::vector<std::size_t> ghosts = ranks_.swapped(sent);
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<Ranks::Message> to, from;
  for (std::size_t r = 0; r < size; ++r) {
    if (ghosts[r] > 0 && sent[r] == 0)
      neighbours_.push_back({static_cast<int>(r), {}, {}, {}, {}});
  }
  for (Neighbour& one : neighbours_) {
    const std::size_t each = 6 * points_;
    one.ghosts.resize(ghosts[static_cast<std::size_t>(one.rank)]);
    one.out.resize(each * one.sent.size());
    one.in.resize(each * one.ghosts.size());
    std::vector<std::size_t>& own_numbers = numbers.emplace_back();
    for (const std::size_t i : one.sent) own_numbers.push_back(division_->number(i));
  }
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    Neighbour& one = neighbours_[k];
    to.push_back({one.rank, Ranks::bytes_of(std::span(numbers[k]))});
    from.push_back({one.rank, Ranks::bytes_of(std::span(one.ghosts))});
  }
  ranks_.begin(to, from);
  ranks_.finish();
}

void Halo::find_met(const Loop& loop) {
  for (const std::size_t i : touched_) {
    effects_[division_->by_number()[i]]->choose(nullptr);
  }
  touched_.clear();
  for (const Neighbour& one : neighbours_) {
    touched_.insert(touched_.end(), one.sent.begin(), one.sent.end());
  }
  std::ranges::sort(touched_);
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());

  CellSet cells(corner_, size_, claims_);
  for (const std::size_t i : touched_) {
    each_piece(i, [&](Box box, double room) {
      box.grow(room);
      cells.mark(box);
    });
  }
  met_.clear();
  for (const std::size_t i : near(cells, loop)) {
    met_.push_back({division_->number(i), nullptr, i});
  }
  for (const Neighbour& one : neighbours_) {
    for (std::size_t k = 0; k < one.ghosts.size(); ++k) {
      met_.push_back({one.ghosts[k], &one, k});
    }
  }
  std::ranges::sort(met_, {}, &Met::number);
  x_.resize(3 * points_ * met_.size());
  v_.resize(x_.size());
  between_.reset();
  if (met_.empty()) return;
  between_ = std::make_unique<models::StrandInteraction>(
      interaction_.law(), std::vector<int>(met_.size(), static_cast<int>(points_)));
  auto next = touched_.begin();
  for (std::size_t k = 0; k < met_.size() && next != touched_.end(); ++k) {
    if (met_[k].from != nullptr || met_[k].index != *next) continue;
    effects_[division_->by_number()[*next++]]->choose(between_->effect(k));
  }
}

void Halo::send(In x, In v) {
  work_.exchange_s += seconds_of([&] {
    const std::size_t each = 3 * points_;
    std::vector<Ranks::Message> to, from;
    for (Neighbour& one : neighbours_) {
      double* out = one.out.data();
      for (const std::size_t i : one.sent) {
        out = std::copy_n(&x[each * i], each, out);
        out = std::copy_n(&v[each * i], each, out);
      }
      work_.sent += static_cast<double>(one.sent.size());
      work_.ghosts += static_cast<double>(one.ghosts.size());
      if (!one.out.empty()) to.push_back({one.rank, Ranks::bytes_of(std::span(one.out))});
      if (!one.in.empty()) from.push_back({one.rank, Ranks::bytes_of(std::span(one.in))});
    }
    ranks_.begin(to, from);
  });
}

void Halo::receive(In x, In v, const Loop& loop) {
  work_.exchange_s += seconds_of([&] {
    ranks_.finish();
    const std::size_t each = 3 * points_;
    each_strand(met_.size(), loop, [&](std::size_t k) {
      const Met& met = met_[k];
      const bool is_own = met.from == nullptr;
      const double* const at =
          is_own ? &x[each * met.index] : &met.from->in[2 * each * met.index];
      std::copy_n(at, each, &x_[each * k]);
      std::copy_n(is_own ? &v[each * met.index] : at + each, each, &v_[each * k]);
    });
  });
  if (!between_) return;
  work_.meet_s += seconds_of([&] { between_->update(x_, v_, loop); });
}

}  // namespace tress::simulation
