#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/calibrate/records.h"
#include "experiments/calibrate/specimen.h"
#include "simulation/run/simulation.h"

namespace tress::experiments::calibrate {

/// Records under experiments/calibrate/data, none of them measured: simulated with known
/// properties, with added errors. The strands are hairs of default material and
/// section in a default scene except for `strand` and their lengths.
struct ShippedRecords {
  std::string_view name;  // experiments/calibrate/data/<name>.csv
  std::string_view what;
  Observed observed = Observed::displacement;
  std::vector<double> lengths;  // m, one record each
  ModelSettings strand = {};
  bool planar = true;   // the motion stays in a plane
  double t_end = 1.5;   // s
  int points = 150;     // per record; for an envelope its first swings
  double sigma = 5e-4;  // m, Gaussian errors of zero mean, independent
  std::uint64_t seed;
  Properties truth{1e-10, 2e-5, 3e9};
  int made_with = 40;  // elements
  int elements = 10;   // enough for a fit
};

std::span<const ShippedRecords> shipped_records();

/// Path of its file in the source tree.
std::string file_of(const ShippedRecords& shipped);

/// Parameters of super_helix for the strands of `shipped`, except those given by the
/// records.
ModelSettings settings_of(const ShippedRecords& shipped, int elements);

/// Generates the records: super_helix with more elements than a fit uses, implicit
/// midpoint at 0.5 ms, and errors from GSL's mt19937. Another seed gives another sample
/// of the same errors.
Records synthetic(const ShippedRecords& shipped, std::uint64_t seed);

/// Returns the records as CSV text, rounded to 0.1 ms and 1 um.
std::string csv_of(const ShippedRecords& shipped, const Records& records);

}  // namespace tress::experiments::calibrate
