#pragma once

#include <limits>
#include <string>
#include <vector>

#include "contract/basics.h"

namespace tress::models {

/// Factor of a load over time: linear between rows and constant beyond them, 1 without
/// rows.
class FactorOverTime {
 public:
  /// Factor at a time.
  struct Row {
    double time, factor;  // s, and the factor there
  };
  /// Returns the rows of numbers that alternate between time and factor.
  static std::vector<Row> rows_of(In numbers);

  FactorOverTime() = default;
  /// Takes rows in order of time. Throws InputError naming `key` and `where` on numbers
  /// that are not finite and on times that do not increase.
  FactorOverTime(std::vector<Row> rows, const std::string& where,
                 const std::string& key = "factor_over_time");
  /// Takes rows of two numbers each, time and factor.
  FactorOverTime(In rows, const std::string& where,
                 const std::string& key = "factor_over_time")
      : FactorOverTime(rows_of(rows), where, key) {}

  /// Returns true if there are no rows.
  bool constant() const { return rows_.empty(); }
  /// Returns the factor at a time (s).
  double operator()(double t) const noexcept;
  /// Returns the derivative of the factor by time, 1/s.
  double rate(double t) const noexcept;
  /// Returns the time of the first row after t, s; infinity: none.
  double next_breakpoint(double t) const noexcept;
  /// Returns the times of all rows, s.
  std::vector<double> times() const;

 private:
  std::vector<Row> rows_;
};

}  // namespace tress::models
