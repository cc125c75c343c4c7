#pragma once

#include <utility>
#include <vector>

#include "contract/forms/natural_strains.h"

namespace tress::models {

/// Natural strains of a strand over time, linear between rows and constant beyond them:
/// muscles, and curls that dry.
class NaturalMotion {
 public:
  /// Natural strains at a time.
  struct Row {
    double time;                 // s
    std::vector<double> values;  // in the order of NaturalStrains::natural()
  };
  NaturalMotion() = default;
  /// Takes at least one row, times ascending.
  explicit NaturalMotion(std::vector<Row> rows) : rows_(std::move(rows)) {}

  /// Returns true if there are rows.
  bool any() const { return !rows_.empty(); }
  /// Sets the natural strains of time t, if they differ from those set last.
  void set(NaturalStrains& strains, double t);
  /// Writes the natural strains of time t and their change over the interval between
  /// rows; returns the length of the interval in s. 0: they are constant at t.
  double slope(double t, std::vector<double>& values, std::vector<double>& change) const;
  /// Returns the time of the first row after t, s; infinity: none.
  double next_breakpoint(double t) const;

 private:
  std::vector<Row> rows_;
  std::vector<double> now_;  // scratch
  double set_ = 0;           // time that was set last, s
  bool begun_ = false;
};

}  // namespace tress::models
