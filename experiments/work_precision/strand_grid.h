#pragma once

#include <string_view>
#include <vector>

#include "contract/integrator.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/run/command_line.h"
#include "experiments/run/settings.h"
#include "models/catalogue.h"
#include "simulation/files/row.h"

namespace tress::experiments::work_precision {

/// A strand whose tip is followed: its name in the column `scene`, the strand scene it
/// runs, and the sampling of the tip comparison.
struct FollowedStrand {
  std::string_view name, scene;
  TipSampling sampling;
};

/// The strand on which other simulators were measured, sampled every 20 ms as theirs.
inline constexpr FollowedStrand swing{"swing", "swing", {2, 100, 0.2}};
/// A hair released horizontally, for the first quarter of a second of its fall.
inline constexpr FollowedStrand strand_release{
    "strand_release", "release", {0.25, 5, 0.1}};

/// Elements at which other simulators were measured, with their time error.
constexpr int peer_elements = 20;

/// One row about a strand: the method, and the kind of error.
struct StrandCase {
  const FollowedStrand* strand;
  std::string_view error_kind;  // time or total
  const ModelEntry* model;
  std::string_view modes, solver;  // empty: the model has no such option
  std::string_view tangent;        // empty: not used by the integrator
  std::string_view integrator;
  bool adaptive, newton;  // whether it is driven by rtol, and iterates with `options`
  Options options;
  int elements;
  double grading;

  Row identity() const;
  Parameters parameters(const Settings& settings) const;
};

/// Parameters of a row's strand, or of a reference's: defaults, then the user's and the
/// scene's, bending only, since nothing twists these strands and explicit methods take
/// part.
Parameters strand_parameters_of(const FollowedStrand& strand, const Settings& settings,
                                const ModelEntry& model, int elements);

/// The rows that the command line and its settings select, without those whose model the
/// integrator refuses: the swing by every integrator, and every strand model on the
/// released hair against the continuous rod.
std::vector<StrandCase> strand_cases(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::work_precision
