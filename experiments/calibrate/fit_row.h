#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/calibrate/friction_fit.h"
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
  std::optional<Friction> truth;  // empty: the records were measured
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

std::string_view name(Fitted fitted);

}  // namespace tress::experiments::calibrate
