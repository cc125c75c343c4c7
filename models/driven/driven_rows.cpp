#include "models/driven/driven_rows.h"

#include <algorithm>

#include "contract/forms/sparse_form.h"

namespace tress::models {

DrivenRows::DrivenRows(System& strand, std::size_t coordinates)
    : strand_(strand),
      rows_(*strand.constraint_form()),
      size_(static_cast<std::size_t>(strand.layout().coordinates)),
      pattern_(rows_.pattern()) {
  pattern_.rows = static_cast<int>(coordinates);
}

Status DrivenRows::add_curvature(double t, In q, In lambda, double factor,
                                 InOut s) noexcept {
  const Pattern& own = strand_.sparse_form()->pattern();
  own_.assign(static_cast<std::size_t>(own.nonzeros()), 0.0);
  const Status status = rows_.add_curvature(t, of_strand(q), lambda, factor, own_);
  for (std::size_t column = 0; column < size_; ++column) {
    for (auto p = static_cast<std::size_t>(own.start[column]);
         p < static_cast<std::size_t>(own.start[column + 1]); ++p) {
      s[column * q.size() + static_cast<std::size_t>(own.row[p])] += own_[p];
    }
  }
  return status;
}

}  // namespace tress::models
