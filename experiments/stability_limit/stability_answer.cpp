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

std::string by_step(const Row& row) {
  if (!row.has("dt_max_s")) {
    return fmt::format("{}: no stable step found: {}", method(row), row.text("reason"));
  }
  const double dt = row.number("dt_max_s");
  std::string line = fmt::format("{}: stable up to {}", method(row), duration(dt));
  if (row.text("limited_by") == "cap") {
    line += ", the longest step that was tried";
  } else if (row.text("at_1_5") == "stable") {
    line += ", but stable again at 1.5 times that";
  } else if (row.text("at_1_5") == name(Broken::no_solution)) {
    line +=
        ", at 1.5 times that some step has no solution and a run takes shorter ones "
        "there";
  } else if (row.has("at_1_5")) {
    line += fmt::format(", unstable at 1.5 times that ({})", row.text("at_1_5"));
  }
  line += fmt::format("; judged over {}", duration(row.number("t_end_s")));
  if (row.has("realtime_factor")) {
    line += fmt::format("; {} per simulated second",
                        duration(1 / row.number("realtime_factor")));
  }
  return line;
}

std::string by_tolerance(const Row& row) {
  if (!row.has("tolerance_loosest")) {
    return fmt::format("{} by tolerance: none found that is stable: {}", method(row),
                       row.text("reason"));
  }
  return fmt::format("{} by tolerance: stable from {:.1g} to {:.1g}; judged over {}",
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
  for (const auto& [of, methods] : cannot) {
    lines.push_back(fmt::format("{}: not driven by {} (--list says why)", of,
                                fmt::join(methods, ", ")));
  }
  return lines;
}

}  // namespace tress::experiments::stability_limit
