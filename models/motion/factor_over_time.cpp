#include "models/motion/factor_over_time.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/input_error.h"
#include "math/piecewise_linear.h"

namespace tress::models {

FactorOverTime::FactorOverTime(std::vector<Row> rows, const std::string& where,
                               const std::string& key)
    : rows_(std::move(rows)) {
  const Row* before = nullptr;
  for (const Row& row : rows_) {
    refuse_if(!std::isfinite(row.time) || !std::isfinite(row.factor),
              "a row of " + key + " is not finite", where, "give finite numbers");
    refuse_if(before != nullptr && !(row.time > before->time),
              "the times of " + key + " do not increase", where,
              "give rows in order of time, each time once");
    before = &row;
  }
}

double FactorOverTime::operator()(double t) const noexcept {
  if (rows_.empty()) return 1;
  const auto [before, after, part] = between_rows(rows_, t, &Row::time);
  return std::lerp(before->factor, after->factor, part);
}

double FactorOverTime::rate(double t) const noexcept {
  if (rows_.empty()) return 0;
  const auto [before, after, part] = between_rows(rows_, t, &Row::time);
  if (before == after) return 0;
  return (after->factor - before->factor) / (after->time - before->time);
}

double FactorOverTime::next_breakpoint(double t) const noexcept {
  const auto after = std::ranges::upper_bound(rows_, t, {}, &Row::time);
  return after == rows_.end() ? std::numeric_limits<double>::infinity() : after->time;
}

std::vector<double> FactorOverTime::times() const {
  std::vector<double> all;
  for (const Row& row : rows_) all.push_back(row.time);
  return all;
}

std::vector<FactorOverTime::Row> FactorOverTime::rows_of(In numbers) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    rows.push_back({numbers[i], numbers[i + 1]});
  }
  return rows;
}

}  // namespace tress::models
