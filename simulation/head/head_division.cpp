#include "simulation/head/head_division.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "models/contact/box_pairs.h"

namespace tress::simulation {
namespace {

// Of a rank's strands: those that fill the lanes of a block, so that what is near to one
// strand is near in memory when the next one asks for it.
constexpr std::size_t most_of_group = 16;

using Strands = std::span<std::size_t>;

class Bisection {
 public:
  using Take = std::function<void(Strands, std::size_t part)>;

  /// take(some, part) for the parts of about equal sums of the cost.
  Bisection(std::span<const Vec> roots, std::span<const double> cost, Take take)
      : roots_(roots), cost_(cost), take_(std::move(take)) {}

  void divide(Strands some, std::size_t parts, std::size_t first = 0) const {
    if (parts == 1) return take_(some, first);
    const double Vec::*const axis = longer_side(some);
    std::ranges::sort(some, {},
                      [&](std::size_t k) { return std::pair(roots_[k].*axis, k); });
    const std::size_t left = parts / 2;
    double all = 0, sum = 0;
    for (const std::size_t k : some) all += cost_[k];
    const double wanted = all * static_cast<double>(left) / static_cast<double>(parts);
    std::size_t count = left;
    for (std::size_t i = 0; i < some.size() - (parts - left); ++i) {
      sum += cost_[some[i]];
      if (sum <= wanted) count = std::max(count, i + 1);
    }
    divide(some.first(count), left, first);
    divide(some.subspan(count), parts - left, first + left);
  }

 private:
  const double Vec::*longer_side(Strands some) const {
    models::Box box = models::Box::none();
    for (const std::size_t k : some) box.include(roots_[k]);
    const Vec size = box.most - box.least;
    if (size.x >= size.y && size.x >= size.z) return &Vec::x;
    return size.y >= size.z ? &Vec::y : &Vec::z;
  }

  std::span<const Vec> roots_;
  std::span<const double> cost_;
  Take take_;
};

}  // namespace

HeadDivision::HeadDivision(std::size_t strands) : owner_(strands, 0), own_(strands) {
  std::iota(own_.begin(), own_.end(), std::size_t{0});
  order_own();
}

HeadDivision::HeadDivision(std::span<const Vec> roots, std::span<const double> cost,
                           int ranks, int rank)
    : ranks_(ranks), rank_(rank), owner_(roots.size()) {
  std::vector<std::size_t> all(roots.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Bisection(roots, cost, [&](Strands some, std::size_t part) {
    for (const std::size_t k : some) owner_[k] = static_cast<int>(part);
    if (static_cast<int>(part) == rank) own_.assign(some.begin(), some.end());
  }).divide(all, static_cast<std::size_t>(ranks));
  const std::vector<double> equal(roots.size(), 1);
  Bisection(roots, equal, [](Strands some, std::size_t) {
    std::ranges::sort(some);
  }).divide(own_, std::max(own_.size() / most_of_group, std::size_t{1}));
  order_own();
}

void HeadDivision::order_own() {
  by_number_.resize(own_.size());
  std::iota(by_number_.begin(), by_number_.end(), std::size_t{0});
  std::ranges::sort(by_number_, {}, [this](std::size_t place) { return own_[place]; });
  order_.resize(own_.size());
  for (std::size_t i = 0; i < own_.size(); ++i) order_[by_number_[i]] = i;
}

std::vector<HeadDivision::Listed> HeadDivision::own_among(
    std::span<const std::size_t> numbers) const {
  std::vector<Listed> found;
  if (numbers.empty()) return found;
  auto next = std::ranges::lower_bound(by_number_, numbers.front(), {},
                                       [this](std::size_t place) { return own_[place]; });
  for (const std::size_t k : numbers) {
    if (owner_[k] != rank_) continue;
    while (own_[*next] != k) ++next;
    found.push_back({*next, found.size()});
  }
  std::ranges::sort(found, {}, &Listed::place);
  return found;
}

std::vector<std::size_t> HeadDivision::counts(
    std::span<const std::size_t> numbers) const {
  std::vector<std::size_t> all(static_cast<std::size_t>(ranks_));
  for (const std::size_t k : numbers) ++all[static_cast<std::size_t>(owner_[k])];
  return all;
}

}  // namespace tress::simulation
