#include "simulation/fit/record_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include "contract/input_error.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/changes.h"

namespace tress::simulation {
namespace {

constexpr double nominal_part = 1e-3;  // of the strand: sigma where it is unknown

using Finer = RecordRuns::Finer;

/// The scene with all parameters changed, and parameter k by ds more.
class ChangedScene {
 public:
  ChangedScene(const Scene& scene, const std::vector<SceneParameter>& parameters,
               In values, Finer finer)
      : scene_(scene), parameters_(parameters), finer_(finer) {
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      s_.push_back((values[k] - parameters[k].value) / parameters[k].measure);
    }
  }

  Scene at(std::size_t k, double ds) const {
    Scene changed = scene_;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      parameters_[j].change(changed, s_[j] + (j == k ? ds : 0));
    }
    if (finer_ != Finer::twice_the_elements) return changed;
    const Options options = changed.options;
    const auto tables = changed.tables;  // with the strands that joints name
    changed = refined(std::move(changed));
    changed.options = options;
    changed.tables = tables;
    return changed;
  }
  Scene at_values() const { return at(parameters_.size(), 0); }

  /// Parameters of at_values().
  std::vector<SceneParameter> parameters() const {
    std::vector<SceneParameter> all = parameters_;
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k].change = [this, k](Scene& scene, double ds) { scene = at(k, ds); };
    }
    return all;
  }

 private:
  const Scene& scene_;
  const std::vector<SceneParameter>& parameters_;
  Finer finer_;
  std::vector<double> s_;
};

/// Why a run has no derivatives at these values: they are at the end of their range, and
/// a derivative looks to both sides. Empty: it has.
std::string out_of_range(std::span<const SceneParameter> parameters, In values) {
  // As far as integrators/gradient/varied_system.h goes, of the measure.
  constexpr double below = 1e-5, above = 0.25;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const SceneParameter& one = parameters[k];
    if (values[k] - below * one.measure >= one.min &&
        values[k] + above * one.measure <= one.max) {
      continue;
    }
    return fmt::format("{} = {:.4g} comes to the end of its range, {:g} to {:g}",
                       one.name, values[k], one.min, one.max);
  }
  return {};
}

std::string start_of(const Scene& scene) {
  if (!scene.tables->gradient) return "auto";
  return std::string(scene.tables->gradient->values().word("start"));
}

}  // namespace

void check_last_time(const Scene& scene, std::string_view column, double last,
                     const std::string& place) {
  constexpr double rounding = 1e-8;  // of times with 9 digits, as in tables of simulate
  refuse_if(
      last > scene.duration * (1 + rounding),
      fmt::format("the last {} = {} is after the end of scene {}, which lasts {} s",
                  column, last, scene.name, scene.duration),
      place,
      fmt::format("set duration_s = {} in the scene, or leave out later rows", last));
}

RecordRuns::RecordRuns(const FitTask& task) {
  refuse_if(task.by.empty(), "no parameter to fit", task.place,
            "name one, as youngs_modulus_pa");
  refuse_if(task.records.empty(), "no record to fit", "record",
            "give a table with the columns time_s, x_m, y_m, z_m");
  for (std::size_t i = 0; i < task.records.size(); ++i) {
    const PointRecord& points = *task.records[i].points;
    for (std::size_t j = 0; j < i; ++j) {
      const bool same = points.hash == task.records[j].points->hash &&
                        task.records[i].scene == task.records[j].scene;
      refuse_if(same && !points.hash.empty(), "a record that is given twice counts twice",
                points.file, "leave one of them out");
    }
  }
  const auto unknown = [](const FitRecord& one) { return one.points->sigma.empty(); };
  const auto none = std::ranges::find_if(task.records, unknown),
             some = std::ranges::find_if_not(task.records, unknown);
  refuse_if(none != task.records.end() && some != task.records.end(),
            fmt::format("no column sigma_m, which {} has: residuals of the two have no "
                        "common scale",
                        some == task.records.end() ? "" : some->points->file),
            none == task.records.end() ? "" : none->points->file,
            "give sigma_m in all records, or in none");
  known_ = none == task.records.end();
  for (const FitRecord& record : task.records) add(task, record);
}

void RecordRuns::add(const FitTask& task, const FitRecord& from) {
  check_derivatives(*from.scene);
  Record record{
      from.scene, gradient_parameters(*from.scene, task.by, task.place), false, {}};
  record.damped = starts_damped(start_of(*from.scene), record.parameters);
  const bool alike = records_.empty() ||
                     std::ranges::equal(record.parameters, parameters(), {},
                                        &SceneParameter::name, &SceneParameter::name);
  if (!alike) {
    throw InputError(fmt::format("{} and {} have different parameters by these names",
                                 records_[0].scene->name, from.scene->name),
                     task.place, "leave out .each, or give scenes with equal elements");
  }
  const std::vector<Observation>& all = from.points->observations;
  const Observation& last = *std::ranges::max_element(all, {}, &Observation::t);
  check_last_time(*from.scene, "time_s", last.t,
                  from.points->place(last, &RowPlace::time));
  std::map<std::size_t, OfStrand> strands;
  for (const Observation& one : all) {
    refuse_if(one.strand >= from.scene->strands.size(),
              fmt::format("scene {} has no strand {}", from.scene->name, one.strand),
              from.points->place(one, &RowPlace::strand),
              fmt::format("it has {}, the first is 0", from.scene->strands.size()));
    strands[one.strand].times.push_back(one.t);
  }
  for (auto& [k, strand] : strands) {
    strand.strand = k;
    std::ranges::sort(strand.times);
    const auto rest = std::ranges::unique(strand.times);
    strand.times.erase(rest.begin(), rest.end());
  }
  const std::size_t first = measured_.size();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Observation& one = all[i];
    OfStrand& strand = strands[one.strand];
    const auto time = std::ranges::lower_bound(strand.times, one.t);
    strand.cells.push_back({static_cast<std::size_t>(time - strand.times.begin()),
                            one.point, one.component, first + i});
    measured_.push_back(one.value);
    sigma_.push_back(from.points->sigma.empty()
                         ? nominal_part * from.scene->strands[one.strand].length()
                         : from.points->sigma[i]);
  }
  // Coordinates in the order of their times, by point and component.
  std::map<std::tuple<std::size_t, std::optional<std::size_t>, std::size_t>,
           std::multimap<double, std::size_t>>
      paths;
  for (std::size_t i = 0; i < all.size(); ++i) {
    paths[{all[i].strand, all[i].point, all[i].component}].emplace(all[i].t, first + i);
  }
  for (const auto& [which, path] : paths) {
    for (auto one = path.begin(); std::next(one) != path.end(); ++one) {
      successive_.emplace_back(one->second, std::next(one)->second);
    }
  }
  for (auto& [k, strand] : strands) {
    check_points(from, strand);
    record.strands.push_back(std::move(strand));
  }
  records_.push_back(std::move(record));
}

void RecordRuns::check_points(const FitRecord& record, const OfStrand& one) const {
  const std::size_t count = points_of(*record.scene, one.strand).count;
  for (const Observation& point : record.points->observations) {
    if (point.strand != one.strand || point.point.value_or(0) < count) continue;
    throw InputError(
        fmt::format("strand {} has no point {}", one.strand, *point.point),
        record.points->place(point, &RowPlace::point),
        fmt::format("it has points 0 to {}, the last one is the tip", count - 1));
  }
}

std::string RecordRuns::run(In values, Finer finer, Out simulated, Out by) const {
  const std::size_t p = parameters().size();
  for (const Record& record : records_) {
    std::string beyond = out_of_range(record.parameters, values);
    if (!beyond.empty()) return beyond;
    const ChangedScene changed(*record.scene, record.parameters, values, finer);
    const Scene scene = changed.at_values();
    GradientTask task{changed.parameters(), record.damped, {}, 1};
    if (finer == Finer::half_step) task.parts = 2;
    for (const OfStrand& strand : record.strands) {
      task.times = strand.times;
      const StrandGradient found = strand_gradient(scene, strand.strand, task);
      if (!found.unfinished.empty()) return found.unfinished;
      const std::size_t points = found.points.front().size() / 3;
      // Points of a strand with halved elements lie at every second one.
      const std::size_t stride = finer == Finer::twice_the_elements ? 2 : 1;
      for (const auto& cell : strand.cells) {
        const std::size_t point = cell.point ? stride * *cell.point : points - 1;
        const std::size_t i = 3 * point + cell.component;
        simulated[cell.at] = found.points[cell.time][i];
        for (std::size_t k = 0; k < p; ++k) {
          by[cell.at * p + k] = found.by[k][cell.time][i];
        }
      }
    }
  }
  return {};
}

}  // namespace tress::simulation
