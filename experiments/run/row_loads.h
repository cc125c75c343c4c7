#pragma once

#include <set>
#include <string>
#include <vector>

#include "experiments/run/machine.h"
#include "simulation/files/row.h"

namespace tress::experiments {

/// Largest load of a processor by other programs: timings with more are repeated or
/// marked.
inline constexpr double most_load = 0.5;

inline constexpr simulation::Column others_load{
    "others_load",
    "mean number of processors that other programs used while the row "
    "was timed. A row below half a second has the value of the last "
    "measurement. Empty: rows ran at the same time",
    true};

/// Load of the processors by other programs while rows ran, one row at a time.
class RowLoads {
 public:
  /// The row that ran since the last call, or since this was made, has ended. Returns
  /// the load meanwhile; of short rows, that of the last measurement.
  double finished(std::string run_id);
  /// Rows that ran above most_load, and did not run again below it.
  std::set<std::string> above();
  /// Processors that others used, at most.
  double largest() const { return largest_; }

 private:
  void measure();

  OtherLoad others_;
  std::vector<std::string> pending_;  // that ran since others_ was asked
  std::set<std::string> above_;
  double last_ = 0, largest_ = 0;
};

}  // namespace tress::experiments
