#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "contract/basics.h"
#include "contract/pattern.h"

namespace tress::experiments::matrices {

/// A matrix by its entries that are not zero, column by column, rows ascending.
struct Matrix {
  struct Entry {
    int row, col;
    double value;
  };
  int rows = 0, cols = 0;
  std::vector<Entry> entries;

  Eigen::MatrixXd dense() const;
};

/// `values` on the pattern, zeros that the pattern holds included.
Matrix on_pattern(const Pattern& pattern, In values);
/// The entries of a dense matrix that are not zero.
Matrix entries_of(const Eigen::MatrixXd& dense);

/// MatrixMarket's coordinate format [Boisvert, Pozo & Remington 1996, NISTIR 5935], real
/// and general, indices from 1, `comment` of one line at its head; numbers read back to
/// the same bits.
std::string matrix_market(const Matrix& matrix, const std::string& comment);

}  // namespace tress::experiments::matrices
