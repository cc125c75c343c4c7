#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "simulation/fit/scene_fit.h"
#include "simulation/gradient/scene_gradient.h"

namespace tress::simulation {

/// Throws InputError naming `place` where a record goes on after the end of its scene.
/// `column`: name of its times; `last`: the last one (s).
void check_last_time(const Scene& scene, std::string_view column, double last,
                     const std::string& place);

/// Residuals of records and their derivatives, for values of the parameters.
class RecordRuns {
 public:
  /// Throws InputError as fit_scenes() does. `task` must outlive it.
  explicit RecordRuns(const FitTask& task);

  /// Refinement of the runs: `no`, `half_step` or `twice_the_elements`.
  enum class Finer { no, half_step, twice_the_elements };

  /// Returns the fitted parameters, with the values of the first record.
  const std::vector<SceneParameter>& parameters() const { return records_[0].parameters; }
  /// Coordinates of all records.
  std::size_t count() const { return sigma_.size(); }
  /// Standard errors of all coordinates (m): a thousandth of the strand where unknown.
  In sigma() const { return sigma_; }
  /// Returns whether every record has standard errors.
  bool sigma_known() const { return known_; }
  /// Pairs of the same coordinate at successive times.
  std::span<const std::pair<std::size_t, std::size_t>> successive() const {
    return successive_;
  }

  /// Fills simulated coordinates (m), and their derivatives by the parameters
  /// (count x parameters, row-major, m per unit). Returns why a run fails.
  std::string run(In values, Finer finer, Out simulated, Out by) const;
  /// Returns the measured coordinates of all records (m).
  In measured() const { return measured_; }

 private:
  /// Observations of one strand of a record.
  struct OfStrand {
    std::size_t strand = 0;
    std::vector<double> times;  // s, ascending
    /// One observed coordinate.
    struct Cell {
      std::size_t time;                  // index in times
      std::optional<std::size_t> point;  // empty: the tip
      std::size_t component, at;         // at: index among all coordinates
    };
    std::vector<Cell> cells;
  };
  struct Record {
    const Scene* scene;
    std::vector<SceneParameter> parameters;
    bool damped;
    std::vector<OfStrand> strands;
  };

  void add(const FitTask& task, const FitRecord& record);
  void check_points(const FitRecord& record, const OfStrand& one) const;

  std::vector<Record> records_;
  std::vector<double> measured_, sigma_;
  std::vector<std::pair<std::size_t, std::size_t>> successive_;
  bool known_ = true;
};

}  // namespace tress::simulation
