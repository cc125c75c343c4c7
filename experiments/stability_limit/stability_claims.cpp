#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "experiments/stability_limit/stability_limit.h"

namespace tress::experiments::stability_limit {
namespace {

/// All columns that identify a row except the compared one.
std::string setting_of(const Row& row, std::string_view compared) {
  std::string key;
  for (const std::string_view column :
       {"scene", "model", "integrator", "solver", "jacobian", "modes", "elements",
        "damping", "study"}) {
    if (column != compared) key.append(row.text(column)).append("/");
  }
  return key;
}

/// A limit lies between these two; unstable is infinite at the cap.
struct Bracket {
  double stable, unstable;
  double finest;  // smallest step tested, 0 when the search completed
  bool above(const Bracket& other) const { return stable >= other.unstable; }
  /// Whether the search reached the other one's limit.
  bool reaches(const Bracket& other) const { return finest <= other.unstable; }
};

/// By setting, of the rows with this value in this column that have a limit.
std::map<std::string, Bracket> limits_of(const std::vector<Row>& rows,
                                         std::string_view column, std::string_view word) {
  std::map<std::string, Bracket> limits;
  for (const Row& row : rows) {
    if (row.text(column) != word || !row.ok()) continue;
    const double unstable = row.has("dt_first_unstable_s")
                                ? row.number("dt_first_unstable_s")
                                : std::numeric_limits<double>::infinity();
    const double finest =
        row.text("search_done") == "false" ? row.number("dt_finest_s") : 0;
    limits[setting_of(row, column)] = {row.number("dt_max_s"), unstable, finest};
  }
  return limits;
}

struct Worst {
  double ratio = 0;  // of the two dt_max
  std::string setting;
  bool held = true;
};

/// One verdict per scene. `violated`: whether two brackets break the claim; `ratio`: how
/// close they are to doing so.
template <typename Violated, typename Ratio>
void check_pairs(const std::vector<Row>& rows, std::string_view column,
                 std::string_view first, std::string_view second,
                 const std::string& claim, Violated violated, Ratio ratio,
                 Verdicts& verdicts) {
  std::map<std::string, Worst> scenes;
  const auto others = limits_of(rows, column, second);
  for (const auto& [setting, limit] : limits_of(rows, column, first)) {
    const auto other = others.find(setting);
    if (other == others.end()) continue;
    if (!limit.reaches(other->second) || !other->second.reaches(limit)) continue;
    Worst& worst = scenes[setting.substr(0, setting.find('/'))];
    const double r = ratio(limit.stable, other->second.stable);
    if (r > worst.ratio) {
      worst.ratio = r;
      worst.setting = setting;
    }
    if (violated(limit, other->second)) worst.held = false;
  }
  if (scenes.empty()) verdicts.not_judged(claim);
  for (const auto& [scene, worst] : scenes) {
    verdicts.check(scene + ": " + claim + ", worst at " + worst.setting, worst.held,
                   worst.ratio);
  }
}

const Row* shaken(const std::vector<Row>& rows, std::string_view integrator,
                  std::string_view jacobian) {
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.text("scene") == "shake" && row.text("model") == "super_helix" &&
           row.text("integrator") == integrator && row.text("solver") == "recursive" &&
           row.text("jacobian") == jacobian && row.text("modes") == "bend_twist" &&
           row.text("elements") == "20" && row.text("damping") == "none";
  });
  return found == rows.end() ? nullptr : &*found;
}

/// Error control rejects the steps that would make a run unstable.
void check_tolerances(const std::vector<Row>& rows, Verdicts& verdicts) {
  std::ptrdiff_t judged = 0, unstable = 0;
  for (const Row& row : rows) {
    if (row.text("study") != "tolerance" || row.text("model") != "super_helix") continue;
    if (row.text("limited_by").empty()) continue;
    ++judged;
    if (row.text("limited_by") != "cap") ++unstable;
  }
  const std::string claim =
      "super_helix, adaptive: no run with a tolerance of 0.1 or less is unstable within "
      "its limit of work";
  if (judged > 0) {
    verdicts.check(claim, unstable == 0, static_cast<double>(unstable));
  } else {
    verdicts.not_judged(claim);
  }
}

/// A question about a scene file is answered if at least one method has a limit.
void check_answers(const std::vector<Row>& rows, Verdicts& verdicts) {
  std::map<std::string, int> limits;
  for (const Row& row : rows) {
    if (row.text("study") == "file") limits.try_emplace(std::string(row.text("scene")));
  }
  for (const Row& row : rows) {
    const auto of_scene = limits.find(std::string(row.text("scene")));
    if (of_scene == limits.end() || !row.ok()) continue;
    if (row.has("dt_max_s") || row.has("tolerance_loosest")) ++of_scene->second;
  }
  for (const auto& [scene, found] : limits) {
    verdicts.check(scene + ": at least one method has a stable step or tolerance",
                   found > 0, found);
  }
}

}  // namespace

void check_stability_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_pairs(
      rows, "solver", "recursive", "composite",
      "recursive and composite have the same largest step",
      [](const Bracket& a, const Bracket& b) { return a.above(b) || b.above(a); },
      [](double a, double b) { return std::max(a / b, b / a); }, verdicts);
  check_pairs(
      rows, "jacobian", "elastic_local", "elastic",
      "elastic_local allows no longer steps than elastic",
      [](const Bracket& a, const Bracket& b) { return a.above(b); },
      [](double a, double b) { return a / b; }, verdicts);

  // A row whose search found no limit has no number, so comparisons never hold.
  const auto limit = [&](std::string_view integrator, std::string_view jacobian,
                         const std::string& claim, auto holds) {
    const Row* row = shaken(rows, integrator, jacobian);
    if (row == nullptr) {
      verdicts.not_judged(claim);
      return;
    }
    const double dt = row->number("dt_max_s");
    verdicts.check(claim, row->ok() && holds(dt), dt);
  };
  limit("backward_euler", "exact",
        "shake, undamped, N = 20: backward_euler, exact Jacobian, is stable at 33 ms",
        [](double dt) { return dt >= 0.033; });
  limit("linearly_implicit_euler", "elastic",
        "shake, undamped, N = 20: linearly_implicit_euler, elastic Jacobian, needs steps "
        "below 2 ms",
        [](double dt) { return dt < 0.002; });
  check_tolerances(rows, verdicts);
  check_answers(rows, verdicts);
}

}  // namespace tress::experiments::stability_limit
