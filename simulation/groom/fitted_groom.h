#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "simulation/groom/helix_fit.h"
#include "simulation/groom/place_groom.h"

namespace tress::simulation {

/// Settings by which the strands of a file become elements.
struct GroomFit {
  int elements = 20;         // of every strand, or with a tolerance at most
  double tolerance_m = 0;    // largest distance from the file's points, m; 0: none
  double tolerance_rel = 0;  // the same over the length of a strand
  bool by_turning = true;    // where elements end; false: equal ones
  Between between = Between::helices;  // from what a distance counts

  /// Returns true if a tolerance is set.
  bool has_tolerance() const { return tolerance_m > 0 || tolerance_rel > 0; }
  double tolerance(double length) const;  // over the length; 0: none
};

/// Strand of a file as a chain of elements.
struct FittedStrand {
  std::size_t number = 0;   // in the file, from 0
  std::size_t points = 0;   // there
  double turning = 0;       // rad
  int by_rule = 0;          // elements_by_turning() for its tolerance; 0: none
  bool rule_holds = false;  // these are enough
  HelixChain chain;         // fitted chain
  FitError error;           // m
  /// Radius of each element, in its middle, m; empty: the file's widths are not taken.
  std::vector<double> radii;

  /// Returns the length of the chain, m.
  double length() const { return chain.joint.back(); }
  /// Returns the number of elements.
  int elements() const { return static_cast<int>(chain.darboux.size()); }
};

/// With a tolerance, the number of elements starts from the turning or, for edges, from
/// the square root of the curvature. It is increased by half until the strand is within
/// the tolerance or has `elements`.
FittedStrand fitted(const PlacedGroom& groom, std::size_t k, const GroomFit& fit);

/// Strands of a file that were fitted.
struct FittedGroom {
  std::string file;                   // name of the file
  std::vector<std::string> notes;     // of the file and its fit
  std::vector<FittedStrand> strands;  // strands that were taken
};

/// Fits `count` strands of a groom, evenly spread, on several threads; results do not
/// depend on the number of threads.
FittedGroom fit_groom(const PlacedGroom& groom, std::size_t count, const GroomFit& fit,
                      int threads);

/// A table with a row for each strand of these grooms: its number in its file, elements,
/// errors.
std::string fit_csv(std::span<const std::shared_ptr<const FittedGroom>> grooms);

}  // namespace tress::simulation
