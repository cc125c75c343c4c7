#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "contract/integrator.h"
#include "experiments/calibrate/records.h"
#include "experiments/calibrate/specimen.h"

namespace tress::experiments::calibrate {

/// Settings by which a simulated strand is integrated and observed.
struct Watch {
  std::string_view integrator = "implicit_midpoint";
  Options options;
  Observed observed = Observed::displacement;
  int axis = 2;  // of the displacement: 0, 1, 2 for x, y, z
};

/// 1/sigma^2 of a point; 1 where standard errors are unknown.
double weight(const Record& record, std::size_t k);

/// Subtracts the weighted mean from values at the points of a record.
void centre(const Record& record, std::vector<double>& values);

/// Simulated records of these strands, one each, m; displacements from the mean of their
/// record. Empty when a run fails or does not oscillate.
std::vector<std::vector<double>> simulated(const Records& records,
                                           const std::vector<BuiltStrand>& strands,
                                           const Watch& watch);

/// Gaussian errors of zero mean, independent, from GSL's mt19937.
struct Noise {
  double sigma;  // m
  std::uint64_t seed;
};

/// Sets the values at the times of the records to simulated() plus errors. False if
/// simulated() is empty.
bool fill_in(Records& records, const std::vector<BuiltStrand>& strands,
             const Watch& watch, const Noise& noise);

}  // namespace tress::experiments::calibrate
