// Pairs of pieces that touch: against every pair looked at, on moving tangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>
#include <thread>

#include "models/contact/pieces/piece_search.h"
#include "tests/models/contact/random_contacts.h"

namespace tress::test_piece_search {

using namespace models;
using test_contact::random_vec;

const Loop in_order = [](std::size_t count, const auto& work) {
  for (std::size_t i = 0; i < count; ++i) work(i);
};
const Loop backwards_on_threads = [](std::size_t count, const auto& work) {
  std::vector<std::jthread> threads;
  for (std::size_t t = 0; t < 3; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = count; i-- > 0;) {
        if (i % 3 == t) work(i);
      }
    });
  }
};

Box random_box(std::mt19937& random, double size) {
  const Vec at = random_vec(random), side = random_vec(random);
  return {at, at + size * Vec{std::abs(side.x), std::abs(side.y), std::abs(side.z)}};
}

template <class Found>
std::vector<std::pair<int, int>> pairs_of(const std::vector<Found>& found) {
  std::vector<std::pair<int, int>> all;
  for (const Found& f : found) all.emplace_back(f.first, f.second);
  return all;
}

TEST(BoxPairs, AreAllThatOverlapOnceEach) {
  std::mt19937 random(1);
  BoxPairs broad;
  std::size_t some = 0;
  for (const double size : {1e-3, 0.05, 0.3, 3.0}) {
    std::vector<Box> boxes;
    boxes.reserve(301);
    for (int i = 0; i < 300; ++i) boxes.push_back(random_box(random, size));
    boxes.push_back(random_box(random, 1000));  // one of another size
    boxes[7].most.x = std::numeric_limits<double>::quiet_NaN();
    boxes[8].most.x = std::numeric_limits<double>::infinity();
    boxes[9] = {{1e300, 0, 0}, {1e300, 1, 1}};
    std::vector<std::pair<int, int>> all;
    for (int i = 0; i < 301; ++i) {
      for (int j = i + 1; j < 301; ++j) {
        if (i == 7 || i == 8 || j == 7 || j == 8) continue;
        const Box& a = boxes[static_cast<std::size_t>(i)];
        const Box& b = boxes[static_cast<std::size_t>(j)];
        if (!apart(a, b) && (i + j) % 5 != 0) all.emplace_back(i, j);
      }
    }
    const auto sift = [](std::vector<BoxPairs::Pair>& pairs) {
      std::erase_if(pairs, [](const BoxPairs::Pair& pair) {
        return (pair.first + pair.second) % 5 == 0;
      });
    };
    auto found = pairs_of(broad.find(boxes, in_order, sift));
    EXPECT_EQ(pairs_of(broad.find(boxes, backwards_on_threads, sift)), found)
        << "same order";
    std::ranges::sort(found);
    EXPECT_EQ(found, all) << size;
    some += all.size();
  }
  EXPECT_GT(some, 10000u);
}

/// Walks whose points move by `far`; some are thrown much farther.
struct Tangle {
  std::vector<PieceSearch::Strand> strands;
  std::vector<double> from, to;
};
Tangle tangle(std::mt19937& random, double far) {
  Tangle all;
  std::uniform_int_distribution<int> length(2, 12);
  for (int k = 0; k < 25; ++k) {
    const int points = length(random);
    all.strands.push_back({points, 0.005 * (1 + k % 3), 1});
    Vec x = 0.4 * random_vec(random);
    const Vec drift = far * random_vec(random);
    for (int i = 0; i < points; ++i, x = x + 0.15 * random_vec(random)) {
      const Vec to = x + drift + 0.2 * far * random_vec(random);
      all.from.insert(all.from.end(), {x.x, x.y, x.z});
      all.to.insert(all.to.end(), {to.x, to.y, to.z});
    }
  }
  return all;
}

/// Every pair that touches, by touch() alone.
std::vector<std::pair<int, int>> touching(const PieceSearch& search, const Tangle& t,
                                          In now, bool own) {
  std::vector<std::pair<int, int>> all;
  for (int i = 0; i < static_cast<int>(search.pieces()); ++i) {
    for (int j = i + 1; j < static_cast<int>(search.pieces()); ++j) {
      const bool same = search.strand_of(i) == search.strand_of(j);
      if (same && (!own || j - i < 2)) continue;
      MovingPieces pieces;
      const auto ends = search.ends(i, j);
      for (std::size_t e = 0; e < 4; ++e) {
        pieces.from[e] = load3(&t.from[3 * ends[e]]);
        pieces.to[e] = load3(&now[3 * ends[e]]);
      }
      const double thick = search.thickness(i, j);
      const auto at = touch(pieces, thick);
      if (!at) continue;
      const bool bend = same && search.arc(j, at->t) - search.arc(i, at->s) <
                                    0.5 * std::numbers::pi * thick;
      if (!bend) all.emplace_back(i, j);
    }
  }
  return all;
}

TEST(PieceSearch, FindsWhatTouchesAlsoWhereForcesMovedIt) {
  std::mt19937 random(2);
  std::size_t some = 0, more = 0;
  for (int run = 0; run < 40; ++run) {
    const bool own = run % 2 == 0;
    const double thickness = run % 3 == 0 ? 0.02 : 0;
    Tangle t = tangle(random, run % 4 == 0 ? 0.3 : 0.02);
    PieceSearch search(t.strands, thickness, own);
    search.begin(t.from, t.to);
    const Loop& loop = run % 2 == 0 ? in_order : backwards_on_threads;
    const auto never = [](int, int) { return false; };
    const auto first = pairs_of(search.find(loop, never));
    EXPECT_EQ(first, touching(search, t, t.to, own)) << run;
    some += first.size();
    // Forces move a few strands, some of them beyond their room: what they touch now is
    // found; pairs of strands at rest are not looked at again.
    std::vector<double> now = t.to;
    std::vector<char> moved(t.strands.size());
    for (std::size_t k = 0; k < t.strands.size(); k += 4) {
      moved[k] = 1;
      const std::size_t at = 3 * search.first_point(k);
      const std::size_t numbers = 3 * search.points(k);
      const Vec by = (k % 8 == 0 ? 0.2 : 0.01) * random_vec(random);
      for (std::size_t i = at; i < at + numbers; i += 3) {
        store3(load3(&now[i]) + by, &now[i]);
      }
      search.place(k, In(now).subspan(at, numbers));
    }
    auto again = touching(search, t, now, own);
    std::erase_if(again, [&](const auto& pair) {
      return moved[search.strand_of(pair.first)] == 0 &&
             moved[search.strand_of(pair.second)] == 0;
    });
    EXPECT_EQ(pairs_of(search.find(loop, never)), again) << run;
    more += again.size();
    EXPECT_TRUE(search.find(loop, never).empty()) << "nothing has moved";
  }
  EXPECT_GT(some, 300u);
  EXPECT_GT(more, 100u);
}

/// A contact whose pieces seem to overlap before the step more than they do would be left
/// as deep as that.
TEST(PieceSearch, FindsContactsOnTheSideThatPiecesComeFrom) {
  std::mt19937 random(3);
  std::size_t seen = 0, slipped = 0;
  for (int run = 0; run < 80; ++run) {
    Tangle t = tangle(random, 0.1);
    PieceSearch search(t.strands, 0, false);
    search.begin(t.from, t.to);
    for (const auto& found : search.find(in_order, [](int, int) { return false; })) {
      MovingPieces pieces;
      const auto ends = search.ends(found.first, found.second);
      for (std::size_t e = 0; e < 4; ++e) {
        pieces.from[e] = load3(&t.from[3 * ends[e]]);
        pieces.to[e] = load3(&t.to[3 * ends[e]]);
      }
      const double thick = search.thickness(found.first, found.second);
      const double before = std::min(0.0, distance(pieces.from) - thick);
      EXPECT_GE(search.gap_before(found), before - 0.1001 * thick);
      const auto at_end = touch(pieces, thick);
      const PieceSearch::Found by_end{found.first, found.second, at_end.value()};
      if (search.gap_before(by_end) < before - 0.5 * thick) ++slipped;
      ++seen;
    }
  }
  EXPECT_GT(seen, 500u);
  EXPECT_GT(slipped, 20u);
}

}  // namespace tress::test_piece_search
