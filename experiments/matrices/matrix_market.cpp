#include "experiments/matrices/matrix_market.h"

#include <fmt/format.h>

#include <iterator>

namespace tress::experiments::matrices {

Eigen::MatrixXd Matrix::dense() const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows, cols);
  for (const Entry& e : entries) all(e.row, e.col) = e.value;
  return all;
}

Matrix on_pattern(const Pattern& pattern, In values) {
  Matrix matrix{pattern.rows, pattern.cols, {}};
  for (int col = 0; col < pattern.cols; ++col) {
    const auto column = static_cast<std::size_t>(col);
    for (int k = pattern.start[column]; k < pattern.start[column + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      matrix.entries.push_back({pattern.row[at], col, values[at]});
    }
  }
  return matrix;
}

Matrix entries_of(const Eigen::MatrixXd& dense) {
  Matrix matrix{static_cast<int>(dense.rows()), static_cast<int>(dense.cols()), {}};
  for (int col = 0; col < matrix.cols; ++col) {
    for (int row = 0; row < matrix.rows; ++row) {
      if (dense(row, col) != 0) matrix.entries.push_back({row, col, dense(row, col)});
    }
  }
  return matrix;
}

std::string matrix_market(const Matrix& matrix, const std::string& comment) {
  std::string text = "%%MatrixMarket matrix coordinate real general\n";
  auto out = std::back_inserter(text);
  fmt::format_to(out, "% {}\n{} {} {}\n", comment, matrix.rows, matrix.cols,
                 matrix.entries.size());
  for (const Matrix::Entry& e : matrix.entries) {
    fmt::format_to(out, "{} {} {}\n", e.row + 1, e.col + 1, e.value);
  }
  return text;
}

}  // namespace tress::experiments::matrices
