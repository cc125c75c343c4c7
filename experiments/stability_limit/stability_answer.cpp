#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "experiments/stability_limit/stability_limit.h"

namespace tress::experiments::stability_limit {
namespace {

std::string method(const Row& row) {
  return fmt::format("{}{}", row.text("integrator"),
                     row.text("jacobian").empty()
                         ? ""
                         : fmt::format(" (jacobian {})", row.text("jacobian")));
}

std::string subject(const Row& row) {
  return fmt::format("{}, {}", row.text("scene"), row.text("model"));
}

/// "11 ms", "0.35 us"
std::string duration(double s) {
  return s >= 1      ? fmt::format("{:.3g} s", s)
         : s >= 1e-3 ? fmt::format("{:.3g} ms", 1e3 * s)
                     : fmt::format("{:.3g} us", 1e6 * s);
}

/// "stable at every one of 12 steps tried from 0.178 ms to 3.41 ms"
std::string tried_in_words(const Row& row) {
  const std::string longest = duration(row.number("dt_max_s"));
  if (row.number("runs") == 1) {
    return fmt::format("stable at {}, the only step tried", longest);
  }
  if (row.number("stable_runs") == 1) {
    return fmt::format("stable at {}, the shortest step tried", longest);
  }
  return fmt::format("stable at every one of {} steps tried from {} to {}",
                     row.text("stable_runs"), duration(row.number("dt_finest_s")),
                     longest);
}

/// Why there is no limit: a process that ended early, a search that ended, or one whose
/// work ran out.
std::string not_found(const Row& row) {
  const bool killed = row.status() == "timeout";
  if (killed || row.status() == "inconclusive") {
    return fmt::format("inconclusive: {}: raise it by {}", row.text("reason"),
                       killed ? "--timeout S" : "--set row_work=X");
  }
  if (!row.has("runs")) return fmt::format("no answer: {}", row.text("reason"));
  if (row.text("search_done") == "true") {
    return fmt::format("no stable step found: {}", row.text("reason"));
  }
  const double runs = row.number("runs");
  return fmt::format(
      "no stable step found in the work given ({} run{}, down to {}): raise it by --set "
      "row_work=X",
      runs, runs == 1 ? "" : "s", duration(row.number("dt_finest_s")));
}

std::string by_step(const Row& row) {
  if (!row.has("dt_max_s")) return fmt::format("{}: {}", method(row), not_found(row));
  std::string line = fmt::format("{}: {}", method(row), tried_in_words(row));
  if (row.text("limited_by") == "cap") {
    if (row.number("runs") > 1) line += ", the longest that was tried";
  } else if (row.text("at_1_5") == "stable") {
    line += fmt::format(", unstable at {}, but stable again at 1.5 times {}",
                        duration(row.number("dt_first_unstable_s")),
                        duration(row.number("dt_max_s")));
  } else if (row.text("at_1_5") == name(Broken::no_solution)) {
    line +=
        ", at 1.5 times that some step has no solution and a run takes shorter ones "
        "there";
  } else if (row.has("at_1_5")) {
    line += fmt::format(", unstable at 1.5 times that ({})", row.text("at_1_5"));
  }
  if (row.text("search_done") == "false") line += "; shorter steps were not checked";
  line += fmt::format("; judged over {}", duration(row.number("t_end_s")));
  if (row.number("stable_runs") > 1) line += " at the longest step";
  if (row.has("realtime_factor")) {
    line += fmt::format("; {} per simulated second",
                        duration(1 / row.number("realtime_factor")));
  }
  return line;
}

std::string by_tolerance(const Row& row) {
  if (!row.has("tolerance_loosest")) {
    const bool unstable = row.status() == "unstable";
    return fmt::format(
        "{} with a tolerance: {}", method(row),
        unstable ? fmt::format("none found that is stable: {}", row.text("reason"))
                 : not_found(row));
  }
  return fmt::format("{} with a tolerance: stable from {:.1g} to {:.1g}; judged over {}",
                     method(row), row.number("tolerance_loosest"),
                     row.number("tolerance_tightest"), duration(row.number("t_end_s")));
}

}  // namespace

std::vector<std::string> stability_answer(const std::vector<Row>& rows) {
  std::vector<const Row*> sorted;
  std::map<std::string, std::vector<std::string>> cannot;  // drive a scene's model
  for (const Row& row : rows) {
    if (row.status() == "refused") {
      cannot[subject(row)].push_back(method(row));
    } else {
      sorted.push_back(&row);
    }
  }
  const auto step = [](const Row* row) {
    const bool known = row->text("study") != "tolerance" && row->has("dt_max_s");
    return known ? row->number("dt_max_s") : 0;
  };
  std::ranges::stable_sort(sorted, [&](const Row* a, const Row* b) {
    if (a->text("scene") != b->text("scene")) return a->text("scene") < b->text("scene");
    return step(a) > step(b);
  });
  std::vector<std::string> lines;
  for (const Row* row : sorted) {
    const std::string line =
        row->text("study") == "tolerance" ? by_tolerance(*row) : by_step(*row);
    lines.push_back(fmt::format("{}: {}", subject(*row), line));
  }
  const bool steps = std::ranges::any_of(sorted, [&](const Row* row) {
    return step(row) > 0 && row->number("stable_runs") > 1;
  });
  if (steps) {
    lines.emplace_back(
        "steps between those that were tried may be unstable: stability is not monotone "
        "in the step");
  }
  for (const auto& [of, methods] : cannot) {
    lines.push_back(fmt::format("{}: not driven by {} (--list prints the reason)", of,
                                fmt::join(methods, ", ")));
  }
  return lines;
}

}  // namespace tress::experiments::stability_limit
