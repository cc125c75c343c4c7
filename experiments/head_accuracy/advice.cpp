#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/head_accuracy/head_accuracy.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/changes.h"
#include "simulation/scene_text/write_scene.h"

namespace tress::experiments::head_accuracy {
namespace {

std::string guides(double count) {
  return fmt::format("{} guide{}", count, count == 1 ? "" : "s");
}

bool every(const Row& row) { return row.number("guides") == row.number("strands"); }

double wanted(const Row& row) {
  const std::string_view over = row.text("over");
  return row.number(over == "mean"  ? "error_mean_rel"
                    : over == "p95" ? "error_p95_rel"
                                    : "error_max_rel");
}

std::string hairs(const Row& row) {
  if (every(row)) return fmt::format("each of {} hairs", row.text("strands"));
  return fmt::format("{} for {} hairs", guides(row.number("guides")),
                     row.text("strands"));
}

/// "800 guides for 10000 hairs, 9 elements, steps of 5.6 ms, 32-bit precision: ... over
/// 0.5 s, in 1.2 ms a frame"
std::string run(const Row& row) {
  return fmt::format(
      "{}, {} elements, steps of {:.3g} ms, {}-bit precision: 95 % of hairs within "
      "{:.2g} % of their length (mean {:.2g} %, largest {:.2g} %) over {:.3g} s, in "
      "{:.2g} ms a frame",
      hairs(row), row.text("elements"), 1e3 * row.number("dt_s"), row.text("precision"),
      1e2 * row.number("error_p95_rel"), 1e2 * row.number("error_mean_rel"),
      1e2 * row.number("error_max_rel"), row.number("horizon_s"),
      row.number("ms_per_frame"));
}

std::string why_every(const Row& row) {
  if (!every(row) || !row.has("best_guides")) return "";
  return fmt::format("; hairs that follow {} are off by {:.2g} %",
                     guides(row.number("best_guides")),
                     1e2 * row.number("best_interpolation_rel"));
}

std::string sentence(const Row& row) {
  if (!row.has("kind")) {
    return fmt::format("{}: {} ({})", row.text("scene"), row.status(),
                       row.text("reason"));
  }
  const std::string asked =
      row.text("kind") == "budget"
          ? fmt::format("{:.3g} ms a frame", row.number("budget_ms"))
          : fmt::format("{:.3g} %", 1e2 * row.number("target_error_rel"));
  if (row.ok()) {
    return fmt::format("{}, {}: take {}{}", row.text("scene"), asked, run(row),
                       why_every(row));
  }
  const std::string best = row.has("guides") ? "; nearest: " + run(row) : "";
  return fmt::format("{}, {}: {} ({}){}", row.text("scene"), asked, row.status(),
                     row.text("reason"), best);
}

}  // namespace

std::vector<std::string> advice(const std::vector<Row>& rows) {
  std::vector<std::string> all;
  for (const Row& row : rows) {
    const bool answer = row.text("kind") == "cheapest" || row.text("kind") == "budget" ||
                        !row.has("kind");
    if (answer) all.push_back(sentence(row));
  }
  return all;
}

std::string advised_text(const Scene& given, const Row& row) {
  const auto guides = static_cast<std::size_t>(row.number("guides"));
  const double strands = row.number("strands"), elements = row.number("elements");
  if (strands > static_cast<double>(held_at_once.strands) ||
      strands * elements > static_cast<double>(held_at_once.elements)) {
    return {};
  }
  Scene scene = every_strand(with_elements(given, static_cast<int>(elements)),
                             held_at_once.strands);
  scene = with_guides(std::move(scene), guides);
  scene.options.step = row.number("dt_s");
  return fmt::format("# {} as advised: {}.\n\n{}", given.name, run(row),
                     scene_text(scene));
}

void check_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  int answers = 0, cheaper = 0;
  double margin = 0, error = 0;
  for (const Row& row : rows) {
    if (row.text("kind") != "cheapest" || !row.ok()) continue;
    ++answers;
    const double target = row.number("target_error_rel"),
                 gap = row.number("reference_gap");
    margin = std::max(margin, row.number("margin"));
    error = std::max(error, (wanted(row) + gap) / target);
    for (const Row& other : rows) {
      // Of other runs in the table these alone have shown that their neighbours hold.
      if (other.text("kind") != "cheapest" || !other.ok()) continue;
      if (other.text("scene") != row.text("scene") || &other == &row) continue;
      if (other.number("target_error_rel") <= target &&
          other.number("work") < row.number("work")) {
        ++cheaper;
      }
    }
  }
  const std::string kept =
                        "every answer meets its target, including the gap between "
                        "references",
                    holds = "neighbours of every answer are within 1.5 times its target",
                    least = "no answer to a smaller target takes less work";
  if (answers == 0) {
    for (const std::string& claim : {kept, holds, least}) verdicts.not_judged(claim);
    return;
  }
  verdicts.check(kept, error <= 1, error);
  verdicts.check(holds, margin <= neighbour_allowance, margin);
  verdicts.check(least, cheaper == 0, cheaper);
}

}  // namespace tress::experiments::head_accuracy
