#include "experiments/calibrate/shipped_records.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "experiments/calibrate/simulated_records.h"
#include "experiments/numerics/tip_signal.h"
#include "experiments/problems/strand_models.h"

namespace tress::experiments::calibrate {
namespace {

constexpr const char* model = "super_helix";
constexpr double step = 5e-4;  // s
constexpr int z = 2;

std::vector<ShippedRecords> make_list() {
  const ModelSettings curl{{"natural_curvature_per_m", "100"},
                           {"natural_twist_per_m", "30"},
                           {"motion", "drop_pull"},
                           {"root_tangent", "down"},
                           {"frequency_hz", "5"}};
  return {{.name = "two_lengths",
           .what = "horizontal hairs of 6 and 10 cm let go straight",
           .lengths = {0.06, 0.1},
           .seed = 1},
          {.name = "one_length",
           .what = "the one of 10 cm alone",
           .lengths = {0.1},
           .seed = 2},
          {.name = "two_lengths_envelope",
           .what = "half-swings of both",
           .observed = Observed::envelope,
           .lengths = {0.06, 0.1},
           .points = 5,
           .sigma = 5e-5,
           .seed = 3,
           .elements = 20},
          {.name = "curly_span",
           .what = "span of a hanging curl of 10 cm, dropped and pulled up again by 5 cm",
           .lengths = {0.1},
           .strand = curl,
           .planar = false,
           .t_end = 1,
           .points = 100,
           .sigma = 1e-3,
           .seed = 4,
           .made_with = 80,
           .elements = 40}};
}

/// The times and parameters of the records, without values.
Records planned(const ShippedRecords& shipped) {
  Records records;
  for (const double length : shipped.lengths) {
    Record& record = records.all.emplace_back();
    const std::string where(shipped.name);
    record.of_strand.push_back({"length_m", fmt::format("{}", length), where});
    for (const auto& [key, value] : shipped.strand) {
      record.of_strand.push_back({key, value, where});
    }
    for (int k = 1; k <= shipped.points; ++k) {
      record.t.push_back(shipped.t_end * k / shipped.points);
    }
  }
  return records;
}

/// Replaces the times by those of the first swings.
void take_swing_times(Record& record, const Parameters& strand, const Watch& watch) {
  const auto system = find_model(model).make(strand);
  const TipSignal signal = run_tip_signal(watch.integrator, *system, watch.options,
                                          watch.axis, record.t.back());
  const Swings all = swings(signal);
  if (all.t.size() < record.t.size()) throw std::logic_error("fewer swings than planned");
  const auto count = static_cast<std::ptrdiff_t>(record.t.size());
  record.t.assign(all.t.begin(), all.t.begin() + count);
}

}  // namespace

std::span<const ShippedRecords> shipped_records() {
  static const std::vector<ShippedRecords> all = make_list();
  return all;
}

std::string file_of(const ShippedRecords& shipped) {
  return fmt::format("{}/{}.csv", TRESS_DATA, shipped.name);
}

ModelSettings settings_of(const ShippedRecords& shipped, int count) {
  ModelSettings settings{
      {"elements", fmt::format("{}", count)},
      {gamma_key, fmt::format("{}", shipped.truth.gamma)},
      {drag_key, fmt::format("{}", shipped.truth.nu)},
      {stiffness_key, fmt::format("{}", shipped.truth.youngs_modulus)}};
  if (shipped.planar) settings.emplace_back("modes", "bend_planar");
  return settings;
}

Records synthetic(const ShippedRecords& shipped, std::uint64_t seed) {
  const ModelEntry& entry = find_model(model);
  Parameters parameters(setup_parameters(entry), "model super_helix");
  set_known(parameters, settings_of(shipped, shipped.made_with));
  Watch watch;
  watch.options.step = step;
  watch.observed = shipped.observed;
  watch.axis = z;
  Records records = planned(shipped);
  std::vector<BuiltStrand> strands;
  for (Record& record : records.all) {
    Parameters strand = parameters;
    for (const auto& [key, value, where] : record.of_strand)
      strand.set(key, value, where);
    if (shipped.observed == Observed::envelope) take_swing_times(record, strand, watch);
    const Specimen made = specimen(entry, strand);
    strands.push_back(made.build(made.properties, 1));
  }
  if (!fill_in(records, strands, watch, {shipped.sigma, seed})) {
    throw std::logic_error("a shipped record cannot be simulated");
  }
  if (shipped.observed == Observed::envelope) {
    for (Record& record : records.all)
      record.sigma.assign(record.t.size(), shipped.sigma);
  }
  return records;
}

std::string csv_of(const ShippedRecords& shipped, const Records& records) {
  const bool errors = shipped.observed == Observed::envelope;
  std::string text = errors ? "t_s,amplitude_m,sigma_m" : "t_s,amplitude_m";
  for (const Record::Setting& setting : records.all.front().of_strand) {
    text += ',' + setting.key;
  }
  text += '\n';
  for (const Record& record : records.all) {
    for (std::size_t k = 0; k < record.t.size(); ++k) {
      text += fmt::format("{:.4f},{:.6f}", record.t[k], record.value[k]);
      if (errors) text += fmt::format(",{}", record.sigma[k]);
      for (const Record::Setting& setting : record.of_strand) text += ',' + setting.value;
      text += '\n';
    }
  }
  return text;
}

}  // namespace tress::experiments::calibrate
