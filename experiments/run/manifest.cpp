#include "experiments/run/manifest.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>

#include "contract/read_file.h"
#include "experiments/run/message.h"
#include "experiments/run/sundials_speed.h"
#include "simulation/files/build_facts.h"
#include "simulation/files/checksum.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"
#include "simulation/plugin/load_plugin.h"

namespace tress::experiments {
namespace {

using nlohmann::ordered_json;

std::string utc_now() {
  const auto now =
      std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

ordered_json checks_of(const Verdicts& verdicts) {
  ordered_json all = ordered_json::array();
  for (const auto& [claim, held, value, state, reason, key] : verdicts.all()) {
    ordered_json one = ordered_json::object();
    one["claim"] = claim;
    if (!key.empty()) one["key"] = key;
    one["held"] = held;
    one["value"] = value;
    one["state"] = name(state);
    if (!reason.empty()) one["reason"] = reason;
    all.push_back(std::move(one));
  }
  return all;
}

ordered_json outcome_of(const Row& row) {
  ordered_json all = ordered_json::object();
  for (const auto& [column, text] : row.cells()) {
    const double value = row.number(column);
    if (std::isnan(value)) {
      all[column] = text;
    } else {
      all[column] = value;
    }
  }
  return all;
}

}  // namespace

std::string plugins_text() {
  std::string text;
  for (const LoadedPlugin& plugin : loaded_plugins()) {
    const std::string name = std::filesystem::path(plugin.file).filename().string();
    text += fmt::format(" plugin={}:{}", name, plugin.checksum);
  }
  return text;
}

std::string settings_text(const CommandLine& line) {
  auto sorted = line.set;
  std::sort(sorted.begin(), sorted.end());
  std::string text = fmt::format("seed={}", line.seed);
  if (line.quick) text += " quick";
  if (line.full) text += " full";
  for (const auto& [key, value] : sorted) text += fmt::format(" {}={}", key, value);
  if (!line.run_ids.empty()) {
    text += fmt::format(" run-id={}", fmt::join(line.run_ids, ","));
  }
  return text + plugins_text();
}

Manifest::Manifest(const Experiment& experiment, const CommandLine& line)
    : experiment_(experiment),
      line_(line),
      load_(load_average()),
      sundials_ratio_(sundials_speed_ratio()),
      start_(utc_now()) {
  if (sundials_ratio_ > slow_sundials_ratio) {
    tell(
        "{}: warning: slow SUNDIALS build ({:.1f} x our own loop): its timings mean "
        "nothing; './tress setup' builds a Release one\n",
        experiment.name, sundials_ratio_);
  }
  const std::string here = checked_out(build_facts().source_tree);
  if (!here.empty() && here != build_facts().commit) {
    tell(
        "{}: warning: this program was built from commit {:.10}, and the source tree has "
        "{:.10} checked out: build it again, or the table is not of that commit\n",
        experiment.name, build_facts().commit, here);
  }
  const int cpus = machine().cpus;
  if (load_[0] > cpus) {
    tell("{}: warning: the machine is busy (load {:.1f} on {} CPUs): timings are noisy\n",
         experiment.name, load_[0], cpus);
  }
}

void Manifest::add_input(std::string file, std::string text) {
  inputs_.emplace_back(std::move(file), std::move(text));
}

void Manifest::set_load(RowLoads& loads) {
  load_during_ = {
      {"limit", most_load}, {"rows_above", loads.above()}, {"largest", loads.largest()}};
}

std::string Manifest::finished(const std::vector<Row>& rows, const Verdicts& verdicts,
                               std::size_t kept_from_before) const {
  const Machine here = machine();
  const Spent spent = spent_so_far();
  std::map<std::string, int> counts;
  for (const Row& row : rows) ++counts[std::string(row.status())];
  ordered_json columns, timings = ordered_json::array();
  for (const Column& column : experiment_.columns) {
    columns[std::string(column.name)] = column.help;
    if (column.timing) timings.push_back(column.name);
  }
  ordered_json libraries;
  for (const auto& [library, version] : library_versions()) libraries[library] = version;
  ordered_json glossary = ordered_json::object();
  if (experiment_.glossary) {
    for (const auto& [column, value, texts] : experiment_.glossary()) {
      auto& entry = glossary[std::string(column)][std::string(value)];
      for (const auto& [key, text] : texts) entry[std::string(key)] = text;
    }
  }
  ordered_json inputs = ordered_json::array();
  for (const auto& [file, text] : inputs_) {
    inputs.push_back({{"file", file}, {"fnv1a_64", checksum(text)}, {"text", text}});
  }
  ordered_json plugins = ordered_json::array();
  for (const LoadedPlugin& plugin : loaded_plugins()) {
    plugins.push_back({{"file", plugin.file},
                       {"fnv1a_64", plugin.checksum},
                       {"models", plugin.models},
                       {"integrators", plugin.integrators},
                       {"effects", plugin.effects}});
  }
  ordered_json manifest{
      {"experiment", experiment_.name},
      {"question", experiment_.question},
      {"schema", schema_version},
      {"tress_version", build_facts().version},
      {"argv", line_.argv},
      {"merged_from", line_.merge},
      {"settings", settings_text(line_)},
      {"options_file", line_.options_file},
      {"inputs", inputs},
      {"plugins", plugins},
      {"seed", line_.seed},
      {"jobs", line_.jobs},
      {"repeat", line_.repeat},
      {"timeout_s", line_.timeout_s},
      {"quick", line_.quick},
      {"full", line_.full},
      {"shard", fmt::format("{}/{}", line_.shard_index, line_.shard_count)},
      {"start", start_},
      {"end", utc_now()},
      {"checks", checks_of(verdicts)},
      {"git",
       {{"commit", build_facts().commit},
        {"dirty", build_facts().dirty()},
        {"changes", build_facts().changes}}},
      {"build",
       {{"compiler", build_facts().compiler},
        {"flags", build_facts().flags},
        {"type", build_facts().type},
        {"executable_fnv1a_64", executable_checksum()}}},
      {"machine",
       {{"cpu", here.cpu},
        {"cpus", here.cpus},
        {"caches", here.caches},
        {"simd", here.simd},
        {"kernels", here.kernels},
        {"kernel", here.kernel},
        {"load_before", load_},
        {"load_of_others_during", load_during_},
        {"load_after", load_average()}}},
      {"libraries", libraries},
      {"sundials_speed_ratio", sundials_ratio_},
      {"rows",
       {{"total", rows.size()}, {"by_status", counts}, {"resumed", kept_from_before}}},
      {"spent", {{"processor_s", spent.processor_s}, {"largest_mb", spent.largest_mb}}},
      {"columns", columns},
      {"timings", timings},
      {"glossary", glossary}};
  if (outcome_) manifest["outcome"] = outcome_of(*outcome_);
  return manifest.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

bool made_by_this_program(const nlohmann::json& manifest) {
  if (!manifest.is_object() || !manifest.contains("build")) return false;
  const nlohmann::json& build = manifest.at("build");
  return build.is_object() &&
         build.value("executable_fnv1a_64", nlohmann::json()) == executable_checksum();
}

std::optional<nlohmann::json> manifest_of(const std::string& table) {
  const std::string file = beside(table, ".meta.json");
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return {};
  return nlohmann::json::parse(read_file(file, most_table_bytes), nullptr, false);
}

}  // namespace tress::experiments
