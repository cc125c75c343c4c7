#include "linear/linear_solver.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "linear/banded.h"
#include "linear/definite_band.h"
#include "linear/dense.h"
#include "linear/klu.h"

namespace tress {
namespace {

/// Measured, factor and solve: dense and banded are equal at 16 unknowns (1.4 and 1.2
/// us), dense takes 1.6 times as long at 32.
constexpr int most_dense_unknowns = 16;

/// Ratio of half-bandwidth to mean entries of a column up to which banded elimination is
/// used. KLU's time over banded's, with the ratio in parentheses:
/// - rods of 3 to 6 unknowns per node: 1.0 to 2.7 (0.6 to 0.8);
/// - nets 2 to 4 nodes wide: 1.2 (0.8 to 1.1);
/// - square nets of point masses: 0.9 (5) to 0.7 (13);
/// - stars: 1.0 (0.9) with 3 strands, 0.9 (2.1) with 6, 0.5 (4.5) with 12.
constexpr double band_per_entry = 1.5;

bool prefers_band(const Pattern& pattern, const BandOrdering& ordering) {
  const double mean_entries = static_cast<double>(pattern.nonzeros()) / pattern.cols;
  return std::max(ordering.lower, ordering.upper) <= band_per_entry * mean_entries;
}

template <class Band>
std::unique_ptr<LinearSolver> make_solver(LinearKind kind, const Pattern& pattern) {
  switch (kind) {
    case LinearKind::dense:
      return std::make_unique<DenseSolver>(pattern);
    case LinearKind::banded:
      return std::make_unique<Band>(pattern);
    case LinearKind::klu:
      return std::make_unique<KluSolver>(pattern);
    case LinearKind::automatic: {
      if (pattern.cols <= most_dense_unknowns)
        return std::make_unique<DenseSolver>(pattern);
      BandOrdering ordering = reverse_cuthill_mckee(pattern);
      if (prefers_band(pattern, ordering)) {
        return std::make_unique<Band>(pattern, std::move(ordering));
      }
      return std::make_unique<KluSolver>(pattern);
    }
  }
  throw std::invalid_argument("linear solver: unknown kind");
}

}  // namespace

std::unique_ptr<LinearSolver> make_linear_solver(LinearKind kind,
                                                 const Pattern& pattern) {
  return make_solver<BandedSolver>(kind, pattern);
}

std::unique_ptr<LinearSolver> make_definite_solver(LinearKind kind,
                                                   const Pattern& pattern) {
  return make_solver<DefiniteBand>(kind, pattern);
}

}  // namespace tress
