#include "linear/klu.h"

#include <klu.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tress {
namespace {

/// Reused pivots are abandoned when an entry of U outgrows its column by this much ...
constexpr double least_reciprocal_growth = 1e-3;
/// ... or by this factor more than it did with freshly chosen pivots.
constexpr double growth_margin = 0.1;

}  // namespace

struct KluSolver::Handles {
  mutable klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  double fresh_growth = 1;  // reciprocal growth of the last full factorisation

  ~Handles() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
};

KluSolver::KluSolver(const Pattern& pattern, double singular_pivot)
    : DirectSolver(pattern, singular_pivot), klu_(std::make_unique<Handles>()) {
  klu_defaults(&klu_->common);
  klu_->common.scale = -1;  // scaled by DirectSolver
  // One connected body is one irreducible block, so looking for more costs time only.
  // Refactor and solve on the KKT matrix of a chain of 10 000 links, AMD without BTF = 1:
  // AMD with BTF 1.2, COLAMD 1.2, COLAMD with BTF 1.5; on nets COLAMD takes 1.1 to 1.8.
  klu_->common.btf = 0;
  klu_->common.ordering = 0;  // AMD
  Pattern copy = pattern;     // KLU takes pointers to non-const and does not write
  klu_->symbolic =
      klu_analyze(copy.cols, copy.start.data(), copy.row.data(), &klu_->common);
  if (klu_->symbolic == nullptr && klu_->common.status != KLU_SINGULAR) {
    throw std::invalid_argument("klu: malformed sparse pattern");
  }
}

KluSolver::~KluSolver() = default;

double KluSolver::factor_scaled(In values) noexcept {
  Handles& k = *klu_;
  if (k.symbolic == nullptr) return 0;  // structurally singular
  auto* start = const_cast<int*>(pattern().start.data());
  auto* row = const_cast<int*>(pattern().row.data());
  auto* value = const_cast<double*>(values.data());

  const auto smallest_pivot = [&] {
    const auto* pivot = static_cast<const double*>(k.numeric->Udiag);
    return std::abs(*std::ranges::min_element(pivot, pivot + k.numeric->n, {},
                                              [](double u) { return std::abs(u); }));
  };
  const auto reciprocal_growth = [&] {
    klu_rgrowth(start, row, value, k.symbolic, k.numeric, &k.common);
    return k.common.rgrowth;
  };

  if (k.numeric != nullptr) {
    const double least =
        std::min(least_reciprocal_growth, growth_margin * k.fresh_growth);
    const bool reused =
        klu_refactor(start, row, value, k.symbolic, k.numeric, &k.common) != 0 &&
        k.common.status == KLU_OK && reciprocal_growth() >= least;
    if (reused) return smallest_pivot();
    klu_free_numeric(&k.numeric, &k.common);
  }
  k.numeric = klu_factor(start, row, value, k.symbolic, &k.common);
  if (k.numeric == nullptr || k.common.status != KLU_OK) return 0;
  k.fresh_growth = reciprocal_growth();
  return smallest_pivot();
}

void KluSolver::solve_scaled(InOut b) const noexcept {
  klu_solve(klu_->symbolic, klu_->numeric, pattern().cols, 1, b.data(), &klu_->common);
}

}  // namespace tress
