#include "linear/definite_band.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "linear/finite.h"
#include "linear/sparse_pattern.h"

namespace tress {
namespace {

/// Index of entry (row, column) among the values, -1: not in the pattern.
int find(const Pattern& pattern, int row, int column) {
  const int at = place_of(pattern, row, column);
  const bool present = at < pattern.start[static_cast<std::size_t>(column) + 1] &&
                       pattern.row[static_cast<std::size_t>(at)] == row;
  return present ? at : -1;
}

// Sums of the same terms in another order differ by a few roundoffs of the diagonal.
constexpr double symmetry = 1e-12;

// Stride for rods with nodal positions and one twist angle per edge: loops of a known
// size are unrolled and vectorised.
constexpr std::size_t of_rods = 11;

}  // namespace

DefiniteBand::DefiniteBand(const Pattern& pattern)
    : DefiniteBand(pattern, reverse_cuthill_mckee(pattern)) {}

DefiniteBand::DefiniteBand(const Pattern& pattern, BandOrdering ordering)
    : general_(pattern, ordering),
      position_(std::move(ordering.position)),
      n_(position_.size()),
      stride_(static_cast<std::size_t>(std::max(ordering.lower, ordering.upper)) + 1),
      diagonal_(n_),
      band_((n_ + stride_) * stride_),
      entries_(n_),
      work_(n_ + stride_) {
  for (std::size_t j = 0; j < n_; ++j) {
    const int own = find(pattern, static_cast<int>(j), static_cast<int>(j));
    diagonal_[static_cast<std::size_t>(position_[j])] = static_cast<std::size_t>(own);
    mirrored_ = mirrored_ && own >= 0;
    for (int p = pattern.start[j]; p < pattern.start[j + 1]; ++p) {
      const auto at = static_cast<std::size_t>(p);
      const auto i = static_cast<std::size_t>(pattern.row[at]);
      const auto row = static_cast<std::size_t>(position_[i]);
      const auto column = static_cast<std::size_t>(position_[j]);
      const int mirror = find(pattern, static_cast<int>(j), static_cast<int>(i));
      mirrored_ = mirrored_ && mirror >= 0;
      if (row <= column) continue;
      pairs_.push_back({at, static_cast<std::size_t>(mirror),
                        column * stride_ + row - column, row, column});
    }
  }
}

bool DefiniteBand::gather(In values) noexcept {
  std::ranges::fill(band_, 0.0);
  for (std::size_t j = 0; j < n_; ++j) {
    entries_[j] = band_[j * stride_] = values[diagonal_[j]];
  }
  bool symmetric = true;
  for (const Pair& pair : pairs_) {
    const double off = values[pair.below] - values[pair.above];
    band_[pair.slot] = values[pair.below];
    symmetric &=
        off * off <= symmetry * symmetry * (entries_[pair.row] * entries_[pair.column]);
  }
  return symmetric;
}

/// Column by column. `known`: the stride, 0: any.
template <std::size_t known>
bool DefiniteBand::eliminate() noexcept {
  const std::size_t stride = known > 0 ? known : stride_;
  condition_ = 1;
  for (std::size_t j = 0; j < n_; ++j) {
    double* const column = &band_[j * stride];
    const double pivot = column[0];
    if (!(pivot > DirectSolver::rounding * entries_[j])) return false;
    const double inverse = 1 / pivot;
    condition_ = std::max(condition_, entries_[j] * inverse);
    // Columns beyond the last are zero and stay so.
    for (std::size_t i = 1; i < stride; ++i) {
      const double factor = column[i] * inverse;
      double* const target = column + i * stride;
      for (std::size_t k = i; k < stride; ++k) target[k - i] -= factor * column[k];
    }
    for (std::size_t i = 1; i < stride; ++i) column[i] *= inverse;
  }
  return true;
}

bool DefiniteBand::eliminate() noexcept {
  return stride_ == of_rods ? eliminate<of_rods>() : eliminate<0>();
}

template <std::size_t known>
void DefiniteBand::substitute() noexcept {
  const std::size_t stride = known > 0 ? known : stride_;
  for (std::size_t j = 0; j < n_; ++j) {
    const double* const column = &band_[j * stride];
    for (std::size_t i = 1; i < stride; ++i) work_[j + i] -= column[i] * work_[j];
  }
  for (std::size_t j = n_; j-- > 0;) {
    const double* const column = &band_[j * stride];
    double sum = work_[j] / column[0];
    for (std::size_t i = 1; i < stride; ++i) sum -= column[i] * work_[j + i];
    work_[j] = sum;
  }
}

Status DefiniteBand::factor(In values) noexcept {
  definite_ = mirrored_ && gather(values) && eliminate();
  return definite_ ? Status::ok : general_.factor(values);
}

Status DefiniteBand::solve(InOut b) noexcept {
  if (!definite_) return general_.solve(b);
  for (std::size_t i = 0; i < n_; ++i) {
    work_[static_cast<std::size_t>(position_[i])] = b[i];
  }
  std::fill(work_.begin() + static_cast<std::ptrdiff_t>(n_), work_.end(), 0.0);
  stride_ == of_rods ? substitute<of_rods>() : substitute<0>();
  for (std::size_t i = 0; i < n_; ++i) {
    b[i] = work_[static_cast<std::size_t>(position_[i])];
  }
  return all_finite(b) ? Status::ok : Status::retry;
}

double DefiniteBand::condition() const noexcept {
  return definite_ ? condition_ : general_.condition();
}

}  // namespace tress
