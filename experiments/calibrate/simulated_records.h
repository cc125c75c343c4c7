#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "contract/integrator.h"
#include "experiments/calibrate/records.h"
#include "experiments/calibrate/specimen.h"

namespace tress::experiments::calibrate {

/// How a simulated strand is watched.
struct Watch {
  std::string_view integrator = "implicit_midpoint";
  Options options;
  Observed observed = Observed::displacement;
  int axis = 2;  // of the displacement: 0, 1, 2 for x, y, z
};

/// 1/sigma^2 of a point; 1 where standard errors are not known.
double weight(const Record& record, std::size_t k);

/// Takes the weighted mean out of values at the points of a record.
void centre(const Record& record, std::vector<double>& values);

/// What the records would be of these strands, one for each, m; displacements from the
/// mean of their record. Empty when a run fails or does not oscillate.
std::vector<std::vector<double>> simulated(const Records& records,
                                           const std::vector<BuiltStrand>& strands,
                                           const Watch& watch);

/// Gaussian errors of zero mean, independent, of GSL's mt19937.
struct Noise {
  double sigma;  // m
  std::uint64_t seed;
};

/// Sets the values at the times of the records to what simulated() says, and errors.
/// False: there is none.
bool fill_in(Records& records, const std::vector<BuiltStrand>& strands,
             const Watch& watch, const Noise& noise);

}  // namespace tress::experiments::calibrate
