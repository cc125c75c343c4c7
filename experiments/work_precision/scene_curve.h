#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/problems/scene_files.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/work_precision/work_precision.h"
#include "integrators/catalogue.h"

namespace tress::experiments::work_precision {

inline constexpr double rate = 60;  // 1/s, of the instants at which tips are compared

/// Extent of the sweep.
struct Extent {
  double work;         // per run
  int rungs;           // steps or tolerances of a curve
  int model_halvings;  // of a frame, to the step of a model's reference
  Finest rod;
  int repeat;
  std::span<const double> tolerances;  // of curves by tolerance
};

Extent extent(const CommandLine& line, const Settings& settings);

/// A scene file as used by all its runs: typical strands, up to the horizon.
class Study {
 public:
  Study(SceneFile file, const Settings& settings);

  const std::string& name() const { return name_; }
  double length() const { return length_; }  // mean, m
  bool touching() const { return scene_.strands_touch(); }
  double duration() const { return scene_.duration; }

  /// Strands with this many elements, 0: the file's discretisation. The choice of strands
  /// does not depend on it.
  Scene cut(int elements) const;

 private:
  std::string name_;
  Scene scene_;
  std::vector<std::size_t> chosen_;
  double length_ = 0;
};

/// References for the errors of one model at one number of elements.
struct Sides {
  std::optional<TipReference> time, total;
};

struct Curve {
  std::shared_ptr<const Study> study;
  Scene cut;
  const ModelEntry* model;
  const IntegratorEntry* integrator;
  std::shared_ptr<const Sides> sides;
  Options options;
  Extent extent;
};

/// The rows of one curve, from loose to tight: by fixed steps, or rtol; after them by
/// tolerances, where the method controls its error.
std::vector<Row> curve(const Curve& work, const Row& identity);

}  // namespace tress::experiments::work_precision
