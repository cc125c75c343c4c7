#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/problems/strand_models.h"
#include "simulation/scene_text/write_scene.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// "super_helix (modes=bend), 9 elements, implicit_midpoint, dt 8.3 ms", or
/// "..., 10 and 5 elements, esdirk43, tolerance 0.001"
std::string what(const Row& row) {
  const ModelEntry& model = find_model(row.text("model"));
  std::string options;
  const auto add = [&options](std::string_view text) {
    options += fmt::format("{}{}", options.empty() ? "" : ", ", text);
  };
  for (const std::string_view key : {"modes", "jacobian", "solver"}) {
    if (row.has(key) && row.text(key) != first_word(model, key)) {
      add(fmt::format("{}={}", key, row.text(key)));
    }
  }
  if (row.has("options")) add(row.text("options"));
  const auto elements = static_cast<int>(row.number("elements"));
  const std::string counts = row.text("extrapolated") == "true"
                                 ? fmt::format("{} and {}", elements, coarser(elements))
                                 : fmt::format("{}", elements);
  std::string steps =
      row.has("position_tol_rel")
          ? fmt::format("tolerance {:.2g}", row.number("position_tol_rel"))
          : fmt::format("dt {:.5g} ms", 1e3 * row.number("dt_s"));
  if (row.has("mean_step_s")) {
    steps +=
        fmt::format(" (adaptive, mean step {:.3g} ms)", 1e3 * row.number("mean_step_s"));
  }
  return fmt::format("{}{}, {} elements, {}{}, {}", model.id,
                     options.empty() ? "" : fmt::format(" ({})", options), counts,
                     row.text("integrator"),
                     row.has("refresh") ? fmt::format(" ({})", row.text("refresh")) : "",
                     steps);
}

/// For scenes with supports or joints, what the errors are.
void add_measure(const Row& row, std::vector<std::string>& lines) {
  if (row.text("error_of") != "strand") return;
  lines.push_back(
      "errors are the largest along the strands, not of the tip: supports or joints hold "
      "points");
}

/// Models and integrators that the search could not take.
void add_left_out(const std::vector<Row>& rows, std::vector<std::string>& lines) {
  for (const Row& row : rows) {
    if (row.text("kind") != "left_out") continue;
    lines.push_back(
        fmt::format("left out: {}: {}", row.text("choice"), row.text("reason")));
  }
}

/// "0.82 % of the length in 3.2 ms per simulated second (0.053 ms per frame)"
std::string price(const Row& row) {
  return fmt::format(
      "{:.2g} % of the length in {:.3g} ms per simulated second ({:.2g} ms a frame)",
      1e2 * row.number("error_rel"), 1e3 * row.number("wall_s_per_sim_s"),
      row.number("ms_per_frame"));
}

/// Of a promise that does not reach the end of the scene, "valid for the first 0.41 s of
/// 2 s, ...: "; else empty.
std::string limits(const Row& row) {
  if (row.text("horizon_cut") == "true") {
    return fmt::format(
        "valid for the first {:.3g} s of {:.3g} s (beyond, the references differ by "
        "{:.2g} "
        "% of the length): ",
        row.number("horizon_s"), row.number("duration_s"),
        1e2 * row.number("parted_rel"));
  }
  if (row.number("asked_s") < row.number("duration_s")) {
    return fmt::format("valid for the first {:.3g} s of {:.3g} s, as requested: ",
                       row.number("horizon_s"), row.number("duration_s"));
  }
  return "";
}

/// The worst neighbour of a run that was examined.
std::string robustness(const Row& row) {
  return fmt::format(
      "robust: the worst of {} neighbours is {}, with an error of {:.2g} %; {:.3g} % is "
      "allowed",
      neighbour_count, row.text("worst_neighbour"),
      1e2 * row.number("error_neighbours_rel"),
      1e2 * neighbour_allowance * row.number("target_error_rel"));
}

/// Whether a row is of this kind and has a run.
auto run_of(std::string_view kind) {
  return [kind](const Row& row) {
    return row.text("kind") == kind && row.has("model") && row.has("error_rel");
  };
}

const Row* find(const std::vector<Row>& rows, std::string_view kind) {
  const auto found = std::ranges::find_if(rows, run_of(kind));
  return found == rows.end() ? nullptr : &*found;
}

/// Whether the search ended early.
bool cut(const Row& row) {
  return row.text("search").find("cut") != row.text("search").npos;
}

/// Advice for a search that ended early.
std::string more(const Row& row) {
  const bool by_the_clock = row.text("search").find("clock") != row.text("search").npos;
  return fmt::format(
      "the search is incomplete ({}): continue with a larger {}", row.text("search"),
      by_the_clock ? "answer_s (--set answer_s, --timeout)" : "--set search_work");
}

/// Why the file as given was not compared, if it was not.
void add_failed_given(const std::vector<Row>& rows, std::vector<std::string>& lines) {
  const auto given = std::ranges::find_if(
      rows, [](const Row& row) { return row.text("kind") == "as_given" && !row.ok(); });
  if (given == rows.end()) return;
  lines.push_back(fmt::format("your file was not compared: {}", given->text("reason")));
}

/// Whether a run that misses the target has a larger error than the file as given.
bool worse_than_given(const std::vector<Row>& rows, const Row& best) {
  const Row* given = find(rows, "as_given");
  return best.status() == "no_answer" && given != nullptr &&
         given->number("error_rel") < best.number("error_rel");
}

/// Whether the error of a run meets the target with the gap of the references.
bool near(const Row& row, double target) {
  return row.number("error_rel") + row.number("reference_gap") <= target;
}

/// What keeps a run with a small error from being an answer: the gap of the references,
/// or its neighbours. Empty where its error is above the target.
std::string doubts(const Row& row) {
  const double target = row.number("target_error_rel");
  if (row.status() != "no_answer" || !(row.number("error_rel") <= target)) return "";
  if (!near(row, target)) {
    return fmt::format(
        "this error and the gap of the references, {:.2g} %, together exceed {:.3g} %",
        1e2 * row.number("reference_gap"), 1e2 * target);
  }
  if (!row.has("worst_neighbour")) return "its neighbours were not all examined";
  return fmt::format(
      "its neighbour with {} has an error of {:.2g} %, {:.3g} % is allowed",
      row.text("worst_neighbour"), 1e2 * row.number("error_neighbours_rel"),
      1e2 * neighbour_allowance * target);
}

/// The file as given where nothing meets the target, or why it was not compared.
void add_given(const std::vector<Row>& rows, const Row& best,
               std::vector<std::string>& lines) {
  if (const Row* given = find(rows, "as_given")) {
    lines.push_back(fmt::format("your file{}: {}{}",
                                worse_than_given(rows, best) ? " is better" : "",
                                configuration_and_price(*given),
                                near(*given, best.number("target_error_rel"))
                                    ? "; its neighbours were not examined"
                                    : ""));
  } else {
    add_failed_given(rows, lines);
  }
}

/// If no run meets the target.
std::vector<std::string> best_so_far(const std::vector<Row>& rows, const Row& best) {
  const double target = 1e2 * best.number("target_error_rel");
  const std::string doubt = doubts(best);
  std::vector<std::string> lines{
      fmt::format("no run within {:.3g} %{} {}", target,
                  doubt.empty() ? "" : " with neighbours that hold",
                  cut(best) ? "so far" : "with any method tried"),
      fmt::format("best so far {}{}{}{}", limits(best), configuration_and_price(best),
                  doubt.empty() ? "" : "; ", doubt)};
  add_measure(best, lines);
  add_given(rows, best, lines);
  add_left_out(rows, lines);
  if (cut(best)) lines.push_back(more(best));
  return lines;
}

/// The file's own configuration if it is worse, else the most expensive of the replaced
/// choices, if there is one.
std::optional<std::string> what_not(const std::vector<Row>& rows, const Row& best) {
  const double target = best.number("target_error_rel");
  if (const Row* given = find(rows, "as_given")) {
    const double factor =
        given->number("wall_s_per_sim_s") / best.number("wall_s_per_sim_s");
    const bool misses = given->number("error_rel") > target;
    if (misses || factor > 1) {
      return fmt::format("your file, {}: {}{}", what(*given), price(*given),
                         misses ? fmt::format(", misses {:.3g} %", 1e2 * target)
                                : fmt::format(", {:.3g} times the time", factor));
    }
  }
  const Row* worst = nullptr;
  for (const Row& row : rows) {
    if (row.text("kind") != "without" || !row.ok()) continue;
    if (worst == nullptr || row.number("cost_factor") > worst->number("cost_factor")) {
      worst = &row;
    }
  }
  if (worst == nullptr) return {};
  return fmt::format("another {}, {}: {:.3g} times the time", worst->text("choice"),
                     what(*worst), worst->number("cost_factor"));
}

bool beats(const Row& row, const Row& other) {
  return row.ok() && row.number("wall_s_per_sim_s") < other.number("wall_s_per_sim_s") &&
         row.number("error_rel") <= other.number("error_rel");
}

/// The next best line.
std::string next_best(const Row* next) {
  if (next == nullptr) {
    return "next best: no other model or integrator was found within the target";
  }
  return fmt::format("{} {}",
                     next->text("tied") == "true" ? "tied within 10 %:" : "next best",
                     configuration_and_price(*next));
}

}  // namespace

bool may_be_written(const std::vector<Row>& rows) {
  const Row* best = advised(rows);
  return best != nullptr && best->status() != "file_differs" &&
         !worse_than_given(rows, *best);
}

const Row* advised(const std::vector<Row>& rows) {
  const Row* budget = find(rows, "budget");
  return budget != nullptr ? budget : find(rows, "winner");
}

void mark_unanswered(std::vector<Row>& rows) {
  for (Row& row : rows) {
    if (row.text("kind") != "winner" && row.text("kind") != "budget") continue;
    if (row.status() != "not_met" && row.status() != "below_reference") continue;
    row.failed("no_answer", std::string(row.text("reason")));
  }
}

void put_better_first(std::vector<Row>& rows) {
  const auto winner = std::ranges::find_if(rows, run_of("winner"));
  const auto next = std::ranges::find_if(rows, run_of("runner_up"));
  if (winner == rows.end() || next == rows.end() || !beats(*next, *winner)) return;
  std::swap(*winner, *next);
  winner->set("kind", "winner").set("rank", 1).set("tied", "").set("cost_factor", 1);
  const double factor =
      next->number("wall_s_per_sim_s") / winner->number("wall_s_per_sim_s");
  next->set("kind", "runner_up").set("rank", 1).set("tied", true);
  next->set("cost_factor", factor);
}

std::string validity(const Row& row) {
  const double valid = row.number("horizon_s"), whole = row.number("duration_s");
  return limits(row).empty()
             ? fmt::format("over the whole {:.3g} s", whole)
             : fmt::format("over the first {:.3g} s of {:.3g} s", valid, whole);
}

std::vector<std::string> advice(const std::vector<Row>& rows) {
  const Row* best = advised(rows);
  if (best == nullptr) {
    const Row& first = rows.front();
    std::vector<std::string> lines{
        first.status() == "timeout"
            ? fmt::format("out of time before the first run was compared ({}): complete "
                          "references are kept, continue with a larger --timeout",
                          first.text("reason"))
            : fmt::format("no answer: {}", first.text("reason"))};
    add_given(rows, first, lines);
    add_left_out(rows, lines);
    if (cut(first)) lines.push_back(more(first));
    return lines;
  }
  if (best->status() == "no_answer") return best_so_far(rows, *best);
  if (best->status() == "file_differs") {
    return {fmt::format("no answer: {}", best->text("reason"))};
  }
  std::vector<std::string> lines{fmt::format(
      "{}take {}, {}", limits(*best), configuration_and_price(*best), validity(*best))};
  if (best->has("worst_neighbour") && best->has("target_error_rel")) {
    lines.push_back(robustness(*best));
  }
  const Row* winner = find(rows, "winner");
  if (winner != best && winner != nullptr && !winner->ok()) winner = nullptr;
  const Row* next = best == winner ? find(rows, "runner_up") : winner;
  add_measure(*best, lines);
  lines.push_back(next_best(next));
  if (auto avoid = what_not(rows, winner == nullptr ? *best : *winner)) {
    lines.push_back(*std::move(avoid));
  }
  add_failed_given(rows, lines);
  add_left_out(rows, lines);
  if (cut(*best)) lines.push_back(more(*best));
  return lines;
}

std::vector<std::string> answers(const std::vector<Row>& rows) {
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    const bool budget = row.text("kind") == "budget";
    if (!budget && row.text("kind") != "winner") continue;
    const std::string wanted =
        budget ? fmt::format("{:.3g} ms a frame", row.number("budget_ms"))
               : fmt::format("{:.3g} %", 1e2 * row.number("target_error_rel"));
    lines.push_back(fmt::format("{}, within {}: {}", row.text("scene"), wanted,
                                row.ok()
                                    ? configuration_and_price(row) + ", " + validity(row)
                                    : fmt::format("no answer: {}", row.text("reason"))));
  }
  return lines;
}

std::string configuration_and_price(const Row& row) {
  return fmt::format("{}: {}", what(row), price(row));
}

std::string advised_text(const Scene& given, const Row& row, double rate) {
  const Configuration taken = configuration(row);
  Scene made = trial_scene(given, taken.method, taken.elements, taken.accuracy, rate);
  // Beyond, nothing is promised, and it may not run.
  if (row.text("horizon_cut") == "true") made.duration = row.number("horizon_s");
  const std::string doubt = doubts(row);
  std::vector<std::string> measure;
  add_measure(row, measure);
  return fmt::format(
      "# {} as advised for {} frames per second: {}, {}.\n{}# {}{}\n{}\n{}", given.name,
      rate, price(row), validity(row),
      measure.empty() ? "" : fmt::format("# {}.\n", measure.front()), limits(row),
      what(row), doubt.empty() ? "" : fmt::format("# No answer: {}.\n", doubt),
      scene_text(made));
}

}  // namespace tress::experiments::cost_of_accuracy
