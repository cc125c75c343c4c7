#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/calibrate/friction_fit.h"
#include "simulation/files/row.h"

namespace tress::experiments::calibrate {

/// How a scene without data is watched.
struct SceneRecord {
  double t_end;  // s
  Noise noise;
};

/// One row: records, the strand that they are of, and how they are fitted.
struct FitRow {
  std::string data;
  std::shared_ptr<const Records> records;
  std::optional<Friction> truth;  // none: the records were measured
  const ModelEntry* model;
  std::vector<Specimen> strands;
  FitOptions how;
  int elements;
  std::optional<SceneRecord> simulate = {};  // the records, when the row is measured

  Row identity() const;
  /// Fits, and fills the other columns.
  void measure(Row& row) const;
};

std::string_view name(Fitted fitted);

}  // namespace tress::experiments::calibrate
