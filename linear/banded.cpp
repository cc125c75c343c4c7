#include "linear/banded.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace tress {
namespace {

/// Neighbours of every node in the graph of A + A^T, without the diagonal.
class Graph {
 public:
  explicit Graph(const Pattern& pattern) : neighbours_(index(pattern.cols)) {
    for (int j = 0; j < pattern.cols; ++j) {
      for (int p = pattern.start[index(j)]; p < pattern.start[index(j) + 1]; ++p) {
        const int i = pattern.row[index(p)];
        if (i == j) continue;
        neighbours_[index(i)].push_back(j);
        neighbours_[index(j)].push_back(i);
      }
    }
    for (auto& list : neighbours_) {
      std::ranges::sort(list);
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    for (auto& list : neighbours_) {
      std::ranges::stable_sort(list, {}, [this](int i) { return degree(i); });
    }
  }

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  int size() const { return static_cast<int>(neighbours_.size()); }
  std::size_t degree(int i) const { return neighbours_[index(i)].size(); }

  /// Appends the component of `root` to `order`, breadth first; returns the depth.
  /// `seen` marks visited nodes with `mark`.
  int sweep(int root, int mark, std::vector<int>& seen, std::vector<int>& order) const {
    std::size_t next = order.size();
    order.push_back(root);
    seen[index(root)] = mark;
    int depth = 0;
    for (std::size_t level_end = order.size(); next < order.size(); ++next) {
      if (next == level_end) {
        level_end = order.size();
        ++depth;
      }
      for (int i : neighbours_[index(order[next])]) {
        if (std::exchange(seen[index(i)], mark) != mark) order.push_back(i);
      }
    }
    return depth;
  }

 private:
  std::vector<std::vector<int>> neighbours_;
};

}  // namespace

BandOrdering reverse_cuthill_mckee(const Pattern& pattern) {
  const Graph graph(pattern);
  const auto n = static_cast<std::size_t>(graph.size());
  std::vector<int> seen(n, 0);
  std::vector<int> order;
  order.reserve(n);
  int mark = 0;
  for (int node = 0; node < graph.size(); ++node) {
    if (seen[Graph::index(node)] != 0) continue;
    // Walk to the far end until the level structure stops getting longer.
    const std::size_t done = order.size();
    int root = node;
    for (int longest = -1;;) {
      order.resize(done);
      const int depth = graph.sweep(root, ++mark, seen, order);
      if (depth <= longest) break;
      longest = depth;
      root = order.back();
    }
  }
  BandOrdering result;
  result.position.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    result.position[Graph::index(order[k])] = static_cast<int>(n - 1 - k);
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (int p = pattern.start[j]; p < pattern.start[j + 1]; ++p) {
      const int i = pattern.row[Graph::index(p)];
      const int below = result.position[Graph::index(i)] - result.position[j];
      result.lower = std::max(result.lower, below);
      result.upper = std::max(result.upper, -below);
    }
  }
  return result;
}

BandedSolver::BandedSolver(const Pattern& pattern)
    : BandedSolver(pattern, reverse_cuthill_mckee(pattern)) {}

BandedSolver::BandedSolver(const Pattern& pattern, BandOrdering ordering)
    : DirectSolver(pattern),
      ordering_(std::move(ordering)),
      n_(pattern.cols),
      stride_(2 * ordering_.lower + ordering_.upper + 1),
      slot_(static_cast<std::size_t>(pattern.nonzeros())),
      band_(static_cast<std::size_t>(n_) * static_cast<std::size_t>(stride_)),
      pivot_(static_cast<std::size_t>(n_)),
      work_(static_cast<std::size_t>(n_)) {
  for (std::size_t j = 0; j < pivot_.size(); ++j) {
    double* const middle = diagonal(ordering_.position[j]);
    for (int p = pattern.start[j]; p < pattern.start[j + 1]; ++p) {
      const int i = pattern.row[static_cast<std::size_t>(p)];
      const int below =
          ordering_.position[static_cast<std::size_t>(i)] - ordering_.position[j];
      slot_[static_cast<std::size_t>(p)] =
          static_cast<std::size_t>(middle + below - band_.data());
    }
  }
}

double* BandedSolver::diagonal(int column) noexcept {
  return band_.data() + static_cast<std::ptrdiff_t>(column) * stride_ + ordering_.lower +
         ordering_.upper;
}

const double* BandedSolver::diagonal(int column) const noexcept {
  return const_cast<BandedSolver*>(this)->diagonal(column);
}

double BandedSolver::factor_scaled(In values) noexcept {
  std::ranges::fill(band_, 0.0);
  for (std::size_t p = 0; p < slot_.size(); ++p) band_[slot_[p]] = values[p];

  double smallest = std::numeric_limits<double>::infinity();
  int reach = 0;  // last column touched by the row swaps so far
  for (int j = 0; j < n_; ++j) {
    double* const column = diagonal(j);
    const int below = std::min(ordering_.lower, n_ - 1 - j);
    int best = 0;
    for (int i = 1; i <= below; ++i) {
      if (std::abs(column[i]) > std::abs(column[best])) best = i;
    }
    pivot_[static_cast<std::size_t>(j)] = best;
    const double pivot = column[best];
    if (pivot == 0) return 0;
    smallest = std::min(smallest, std::abs(pivot));
    reach = std::max(reach, std::min(j + ordering_.upper + best, n_ - 1));

    std::swap(column[0], column[best]);
    const double inverse = 1 / pivot;
    for (int i = 1; i <= below; ++i) column[i] *= inverse;
    for (int k = j + 1; k <= reach; ++k) {
      double* const target = diagonal(k) + (j - k);
      std::swap(target[0], target[best]);
      const double factor = target[0];
      if (factor == 0) continue;
      for (int i = 1; i <= below; ++i) target[i] -= factor * column[i];
    }
  }
  return smallest;
}

void BandedSolver::solve_scaled(InOut b) const noexcept {
  const auto place = [this](std::size_t i) {
    return static_cast<std::size_t>(ordering_.position[i]);
  };
  for (std::size_t i = 0; i < b.size(); ++i) work_[place(i)] = b[i];
  for (int j = 0; j < n_; ++j) {
    const double* const column = diagonal(j);
    double* const x = work_.data() + j;
    std::swap(x[0], x[pivot_[static_cast<std::size_t>(j)]]);
    const int below = std::min(ordering_.lower, n_ - 1 - j);
    for (int i = 1; i <= below; ++i) x[i] -= column[i] * x[0];
  }
  for (int j = n_ - 1; j >= 0; --j) {
    const double* const column = diagonal(j);
    double* const x = work_.data() + j;
    x[0] /= column[0];
    const int above = std::min(ordering_.lower + ordering_.upper, j);
    for (int i = 1; i <= above; ++i) x[-i] -= column[-i] * x[0];
  }
  for (std::size_t i = 0; i < b.size(); ++i) b[i] = work_[place(i)];
}

}  // namespace tress
