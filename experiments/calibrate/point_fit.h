#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/run/settings.h"
#include "simulation/files/row.h"
#include "simulation/fit/scene_fit.h"

namespace tress::experiments::calibrate {

/// Records of points and the scenes that they are of.
struct PointFit {
  std::vector<Scene> scenes;  // one for all records, or one for each
  std::vector<PointRecord> records;
  std::string bounds, priors;  // as given
  FitTask asked;               // without its records

  /// The fit of these records, to which it refers.
  FitTask task() const;
  Row identity() const;
  /// A row for each fitted parameter.
  std::vector<Row> rows(const Row& identity) const;
  /// Measured and fitted coordinates as a CSV, for the fitted values of its rows. Empty:
  /// a run fails there.
  std::string points(const std::vector<Row>& rows) const;
};

/// Whether these files are records of points: the header of the first decides.
bool are_points(const std::vector<std::string>& files);

/// The fit that the user asks for. Throws InputError on settings of oscillations.
PointFit point_fit(const CommandLine& line, const Settings& settings);

/// The fitted values in words, then what limits them, each reason once.
std::vector<std::string> point_answer(const std::vector<Row>& rows);

}  // namespace tress::experiments::calibrate
