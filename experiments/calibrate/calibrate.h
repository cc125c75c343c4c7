#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/calibrate/oscillation_fit.h"
#include "experiments/run/experiment.h"
#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::calibrate {

/// Sampling of a simulated record, for a scene without data.
struct SceneRecord {
  double t_end;  // s
  Noise noise;
};

/// One row: records, their strands, and the fit options.
struct FitRow {
  std::string data;
  std::shared_ptr<const Records> records;
  std::optional<Properties> truth;  // empty: the records were measured
  const ModelEntry* model;
  std::vector<Specimen> strands;
  FitOptions how;
  int elements;
  std::optional<SceneRecord> simulate = {};  // simulates the records when the row is
                                             // measured

  Row identity() const;
  /// Fits, and fills the other columns.
  void measure(Row& row) const;
};

/// A word of the setting `fit`, and its meaning.
std::string_view name(Fitted fitted);
Fitted fitted_of(std::string_view word);

/// --set keys that select records and how they are fitted.
std::span<const Parameter> calibrate_settings();

/// Fits of the user's records, of records simulated from the user's scene, or of those in
/// experiments/calibrate/data. Throws InputError on what cannot be read or built.
std::vector<Case> calibrate_cases(const CommandLine& line);

namespace calibrate {

constexpr std::string_view fitting = "implicit_midpoint";  // adds no damping
constexpr std::string_view damping = "backward_euler";

}  // namespace calibrate

/// Claims about rows of simulated records: the true value lies in its interval, and rows
/// without an answer (one length for two values, a method that adds damping) report it.
void check_calibrate_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::calibrate
