#include "models/contact/pieces/piece_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tress::models {
namespace {

// Of the thickness: by so much forces may move a piece before its pairs are gathered
// again.
constexpr double more_room = 1;

// Of the thickness: so much farther apart a pair may still count, since forces of others
// may close it again.
constexpr double stays = 0.5;

/// The bend of a strand that touches itself is a half turn at least.
constexpr double half_turn = 0.5 * std::numbers::pi;

// Of the thickness: pieces that were so much farther apart at the start of a step than
// they were along the normal at its end have come from another side.
constexpr double other_side = 0.1;

// Of the thickness: strands that forces move by less need not be looked at again.
constexpr double still = 1e-3;

// So many pieces at most are gathered again by looking at all others.
constexpr std::size_t most_one_by_one = 100;

constexpr std::size_t group = 256;  // of pairs that one thread takes at a time

constexpr auto pair_of = [](const PieceSearch::Found& found) {
  return std::pair(found.first, found.second);
};

}  // namespace

PieceSearch::PieceSearch(std::span<const Strand> strands, double thickness, bool own)
    : own_(own), thickness_(thickness), widest_(thickness), first_(1) {
  for (std::size_t k = 0; k < strands.size(); ++k) {
    const auto points = static_cast<std::size_t>(strands[k].points);
    radius_.push_back(strands[k].radius);
    first_.push_back(first_.back() + points);
    strand_.insert(strand_.end(), points - 1, k);
    if (!(thickness > 0)) widest_ = std::max(widest_, 2 * strands[k].radius);
  }
  room_ = more_room * widest_;
  motion_.resize(strand_.size());
  roomy_.resize(strand_.size());
  arc_.resize(first_.back());
}

void PieceSearch::begin(In from, In to) {
  from_.assign(from.begin(), from.end());
  to_.assign(to.begin(), to.end());
  now_ = to_;
  looked_.resize(to_.size());  // set by the first find()
  moved_.assign(radius_.size(), 1);
  gathered_.clear();
  for (std::size_t k = 0; k + 1 < first_.size(); ++k) {
    arc_[first_[k]] = 0;
    for (std::size_t i = first_[k] + 1; i < first_[k + 1]; ++i) {
      arc_[i] = arc_[i - 1] + norm(load3(&from_[3 * i]) - load3(&from_[3 * i - 3]));
    }
  }
}

void PieceSearch::place(std::size_t strand, In x) {
  const std::size_t first = 3 * first_[strand];
  std::ranges::copy(x, now_.begin() + static_cast<std::ptrdiff_t>(first));
  const double far = still * widest_;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    const Vec moved = load3(&x[i]) - load3(&looked_[first + i]);
    if (dot(moved, moved) > far * far) moved_[strand] = 1;
  }
  if (gathered_.empty()) return;
  for (std::size_t i = 0; i + 3 < x.size(); i += 3) {
    Gathered& piece = gathered_[first_[strand] - strand + i / 3];
    const Vec one = load3(&x[i]) - piece.ends[0],
              other = load3(&x[i + 3]) - piece.ends[1];
    piece.moved = std::sqrt(std::max(dot(one, one), dot(other, other)));
  }
}

double PieceSearch::thickness(int first, int second) const {
  if (thickness_ > 0) return thickness_;
  return radius_[strand_of(first)] + radius_[strand_of(second)];
}

std::array<std::size_t, 4> PieceSearch::ends(int first, int second) const {
  const std::size_t a = point_of(first), b = point_of(second);
  return {a, a + 1, b, b + 1};
}

double PieceSearch::arc(int piece, double part) const {
  const double* from = &arc_[point_of(piece)];
  return (1 - part) * from[0] + part * from[1];
}

double PieceSearch::gap(const Found& pair, In x) const {
  const std::array<double, 4> weights = pair.at.weights();
  const std::array<std::size_t, 4> points = ends(pair.first, pair.second);
  Vec sum;
  for (std::size_t end = 0; end < 4; ++end) {
    sum = sum + weights[end] * load3(&x[3 * points[end]]);
  }
  return dot(pair.at.normal, sum) - thickness(pair.first, pair.second);
}

double PieceSearch::depth(const Found& pair) const {
  const MovingPieces pieces = moving(pair.first, pair.second);
  const double distance = models::distance(pieces.to);
  const bool passed = gap_now(pair) < 0 && touch(pieces, 0).has_value();
  return thickness(pair.first, pair.second) + (passed ? distance : -distance);
}

MovingPieces PieceSearch::moving(int first, int second) const {
  MovingPieces all;
  const std::array<std::size_t, 4> points = ends(first, second);
  for (std::size_t end = 0; end < 4; ++end) {
    all.from[end] = load3(&from_[3 * points[end]]);
    all.to[end] = load3(&now_[3 * points[end]]);
  }
  return all;
}

/// Takes away pairs that do not touch in the step, wherever forces move both within their
/// room, and those that are not looked for.
void PieceSearch::sift(std::vector<BoxPairs::Pair>& pairs) const {
  std::erase_if(pairs, [this](const BoxPairs::Pair& pair) {
    return strand_of(pair.first) == strand_of(pair.second) &&
           (!own_ || pair.second - pair.first < 2);
  });
  least_approaches(motion_, pairs);
  const double reach = (1 + stays) * widest_ + 2 * room_;
  std::size_t kept = 0;
  for (const BoxPairs::Pair& pair : pairs) {  // without a branch
    pairs[kept] = pair;
    kept += pair.distance <= reach ? 1 : 0;
  }
  pairs.resize(kept);
}

void PieceSearch::gather_piece(std::size_t piece) {
  const std::size_t at = 3 * point_of(static_cast<int>(piece));
  const Vec from0 = load3(&from_[at]), from1 = load3(&from_[at + 3]),
            to0 = load3(&now_[at]), to1 = load3(&now_[at + 3]);
  gathered_[piece] = {{to0, to1}};
  motion_[piece] = {from0, to0, from1, to1};
  Box& box = roomy_[piece];
  box = {from0, from0};
  for (const Vec& x : {from1, to0, to1}) box.include(x);
  box.grow(0.5 * (1 + stays) * widest_ + room_);
}

void PieceSearch::gather(const Loop& loop) {
  gathered_.resize(pieces());
  loop((pieces() + group - 1) / group, [&](std::size_t g) {
    const std::size_t end = std::min(pieces(), (g + 1) * group);
    for (std::size_t i = g * group; i < end; ++i) gather_piece(i);
  });
  near_ = broad_.find(roomy_, loop,
                      [this](std::vector<BoxPairs::Pair>& pairs) { sift(pairs); });
}

/// Gathers pairs of those pieces again that forces have moved beyond their room.
void PieceSearch::gather_moved(const Loop& loop) {
  const auto beyond = [this](int piece) {
    return gathered_[static_cast<std::size_t>(piece)].moved > room_;
  };
  std::vector<int> all;
  for (int i = 0; i < static_cast<int>(pieces()); ++i) {
    if (beyond(i)) all.push_back(i);
  }
  if (all.empty()) return;
  if (all.size() > most_one_by_one) return gather(loop);
  std::erase_if(near_, [&](const BoxPairs::Pair& pair) {
    return beyond(pair.first) || beyond(pair.second);
  });
  for (const int i : all) gather_piece(static_cast<std::size_t>(i));
  std::vector<BoxPairs::Pair> again;
  for (const int i : all) {
    const Box& box = roomy_[static_cast<std::size_t>(i)];
    for (int k = 0; k < static_cast<int>(pieces()); ++k) {
      if (k == i || apart(box, roomy_[static_cast<std::size_t>(k)])) continue;
      // Of two that are gathered again the first one has the pair.
      if (k < i && std::ranges::binary_search(all, k)) continue;
      again.push_back({std::min(i, k), std::max(i, k)});
    }
  }
  sift(again);
  near_.insert(near_.end(), again.begin(), again.end());
}

bool PieceSearch::look(const BoxPairs::Pair& pair,
                       const std::function<bool(int, int)>& wider, Found& found) const {
  const auto [first, second, distance] = pair;
  const double thick = thickness(first, second), far = (1 + stays) * thick;
  const double away = distance - gathered_[static_cast<std::size_t>(first)].moved -
                      gathered_[static_cast<std::size_t>(second)].moved;
  if (!(away <= far) || (!(away <= thick) && !wider(first, second))) return false;
  const MovingPieces pieces = moving(first, second);
  std::optional<PieceTouch> at = touch(pieces, far);
  if (!at) return false;
  found = {first, second, *at};
  if (gap_now(found) >= 0 && !wider(first, second)) {
    at = touch(pieces, thick);
    if (!at) return false;
    found.at = *at;
  }
  // An end may slip around another piece within a step: it is held where it came from.
  const double before = std::min(thick, models::distance(pieces.from));
  if (gap_before(found) + thick < before - other_side * thick) {
    found.at = first_touch(pieces, thick);
  }
  // Along a bend a strand is near itself by its thickness.
  return strand_of(first) != strand_of(second) ||
         arc(second, at->t) - arc(first, at->s) >= half_turn * thick;
}

const std::vector<PieceSearch::Found>& PieceSearch::find(
    const Loop& loop, const std::function<bool(int, int)>& wider) {
  gathered_.empty() ? gather(loop) : gather_moved(loop);
  found_of_.resize((near_.size() + group - 1) / group);
  loop(found_of_.size(), [&](std::size_t g) {
    found_of_[g].clear();
    for (std::size_t i = g * group; i < std::min(near_.size(), (g + 1) * group); ++i) {
      const BoxPairs::Pair& pair = near_[i];
      if (moved_[strand_of(pair.first)] == 0 && moved_[strand_of(pair.second)] == 0) {
        continue;
      }
      Found found{};
      if (look(pair, wider, found)) found_of_[g].push_back(found);
    }
  });
  loop(moved_.size(), [&](std::size_t k) {
    if (std::exchange(moved_[k], 0) == 0) return;
    const auto first = static_cast<std::ptrdiff_t>(3 * first_[k]);
    const auto last = static_cast<std::ptrdiff_t>(3 * first_[k + 1]);
    std::copy(now_.begin() + first, now_.begin() + last, looked_.begin() + first);
  });
  found_.clear();
  for (const std::vector<Found>& some : found_of_) {
    found_.insert(found_.end(), some.begin(), some.end());
  }
  std::ranges::sort(found_, {}, pair_of);
  return found_;
}

}  // namespace tress::models
