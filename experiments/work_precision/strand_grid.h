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

/// A strand whose tip is followed: the name in the column `scene`, that of the strand
/// scene it runs, and when and over which length tips are compared.
struct FollowedStrand {
  std::string_view name, scene;
  TipSampling sampling;
};

/// The strand on which other simulators were measured, every 20 ms as their error is.
inline constexpr FollowedStrand swing{"swing", "swing", {2, 100, 0.2}};
/// A hair let go horizontally, for the quarter of a second of its fall.
inline constexpr FollowedStrand strand_release{
    "strand_release", "release", {0.25, 5, 0.1}};

/// Elements at which other simulators were measured, with their time error.
constexpr int peer_elements = 20;

/// One row about a strand: who steps it and how, and what error is asked for.
struct StrandCase {
  const FollowedStrand* strand;
  std::string_view error_kind;  // time or total
  const ModelEntry* model;
  std::string_view modes, solver;  // empty: the model has no such choice
  std::string_view tangent;        // empty: the integrator takes none
  std::string_view integrator;
  bool adaptive, newton;  // whether it is driven by rtol, and iterates with `options`
  Options options;
  int elements;
  double grading;

  Row identity() const;
  Parameters parameters(const Settings& settings) const;
};

/// The strand of a row, or of a reference: defaults, the user's, the scene's, bending
/// alone, for nothing twists these strands and explicit methods take part.
Parameters strand_parameters_of(const FollowedStrand& strand, const Settings& settings,
                                const ModelEntry& model, int elements);

/// The rows that the command line and its settings leave, without those whose model the
/// integrator refuses: the swing by every integrator, and every strand model on the
/// released hair against the continuous rod.
std::vector<StrandCase> strand_cases(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::work_precision
