#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "contract/pattern.h"
#include "linear/linear_solver.h"

namespace tress::testing_matrices {

/// A sparse matrix as a pattern and its values.
struct Sparse {
  Pattern pattern;
  std::vector<double> values;
};

/// Entries of `a` that are not zero; `always`: where entries are kept even if zero.
inline Sparse sparse(const Eigen::MatrixXd& a, const Eigen::MatrixXd& always) {
  Sparse result;
  result.pattern.rows = static_cast<int>(a.rows());
  result.pattern.cols = static_cast<int>(a.cols());
  result.pattern.start.push_back(0);
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      if (always(i, j) == 0) continue;
      result.pattern.row.push_back(static_cast<int>(i));
      result.values.push_back(a(i, j));
    }
    result.pattern.start.push_back(static_cast<int>(result.pattern.row.size()));
  }
  return result;
}

inline Sparse sparse(const Eigen::MatrixXd& a) { return sparse(a, a); }

inline Eigen::MatrixXd dense(const Pattern& pattern, In values) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(pattern.rows, pattern.cols);
  for (int j = 0; j < pattern.cols; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int p = pattern.start[column]; p < pattern.start[column + 1]; ++p) {
      const auto entry = static_cast<std::size_t>(p);
      a(pattern.row[entry], j) = values[entry];
    }
  }
  return a;
}

inline std::span<double> span_of(Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

inline std::string kind_name(const testing::TestParamInfo<LinearKind>& kind) {
  constexpr const char* names[] = {"automatic", "klu", "banded", "dense"};
  return names[static_cast<int>(kind.param)];
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double normal() { return distribution_(engine_); }
  Eigen::VectorXd vector(int n) {
    return Eigen::VectorXd::NullaryExpr(n, [this] { return normal(); });
  }
  Eigen::MatrixXd matrix(int rows, int cols) {
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [this] { return normal(); });
  }
  /// Each entry is kept with the given probability.
  Eigen::MatrixXd thinned(int rows, int cols, double probability) {
    std::bernoulli_distribution keep(probability);
    return matrix(rows, cols).unaryExpr([&](double a) {
      return keep(engine_) ? a : 0.0;
    });
  }
  std::vector<int> permutation(int n) {
    std::vector<int> order(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = i;
    std::shuffle(order.begin(), order.end(), engine_);
    return order;
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> distribution_;
};

}  // namespace tress::testing_matrices
