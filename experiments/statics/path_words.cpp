#include "experiments/statics/path_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace tress::experiments::statics {
namespace {

using simulation::Row;
using Rows = std::vector<const Row*>;

bool is_event(const Row& row, std::string_view name) { return row.text("event") == name; }

bool is_critical(const Row& row) {
  return is_event(row, "limit_point") || is_event(row, "bifurcation");
}

std::string value_of(const Row& row) {
  const std::string_view unit = row.text("unit");
  std::string text =
      fmt::format("{} = {:.6g}", row.text("over"), row.number("parameter"));
  if (unit != "1") text += fmt::format(" {}", unit);
  if (row.has("force_n")) text += fmt::format(" (force {:.6g} N)", row.number("force_n"));
  return text;
}

std::string count_of(std::size_t n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

/// Displacement at which the path, after row `from`, is stable at the same parameter.
std::optional<double> stable_again(const Rows& rows, std::size_t from) {
  const double value = rows[from]->number("parameter");
  for (std::size_t k = from + 1; k + 1 < rows.size(); ++k) {
    const Row &a = *rows[k], &b = *rows[k + 1];
    if (a.text("stability") == "unstable" || b.text("stability") == "unstable") continue;
    if (!b.ok() || is_critical(a)) continue;
    const double before = a.number("parameter") - value;
    const double after = b.number("parameter") - value;
    if (before * after > 0 || before == after) continue;
    const double part = before / (before - after);
    return (1 - part) * a.number("displacement_m") + part * b.number("displacement_m");
  }
  return {};
}

std::string stability_near(const Rows& rows, std::size_t k, int side) {
  for (auto i = static_cast<std::ptrdiff_t>(k) + side; i >= 0 && i < std::ssize(rows);
       i += side) {
    const Row& row = *rows[static_cast<std::size_t>(i)];
    if (!is_critical(row)) return std::string(row.text("stability"));
  }
  return "";
}

/// Whether a load between two points makes neutral modes unstable.
bool topples(const Row& before, const Row& after) {
  return !is_critical(before) && !is_critical(after) && before.has("neutral_modes") &&
         after.has("neutral_modes") &&
         after.number("neutral_modes") < before.number("neutral_modes") &&
         before.text("stability") == "stable" && after.text("stability") == "unstable";
}

std::string in_words(const Rows& rows, std::size_t k) {
  const Row& row = *rows[k];
  const bool limit = is_event(row, "limit_point");
  std::string text = fmt::format("  {}: {}, displacement {:.6g} m",
                                 limit ? "limit point" : "bifurcation", value_of(row),
                                 row.number("displacement_m"));
  if (!limit && row.number("crossing") > 1) {
    text += fmt::format(", {} modes at once", row.text("crossing"));
  }
  const std::string before = stability_near(rows, k, -1),
                    after = stability_near(rows, k, 1);
  // Of several in one step, the one next to the stable side changes the stability.
  const bool changes = before == "stable"
                           ? k > 0 && !is_critical(*rows[k - 1])
                           : k + 1 < rows.size() && !is_critical(*rows[k + 1]);
  if (before != after && !before.empty() && !after.empty() && changes) {
    text += fmt::format("; {} before, {} after", before, after);
  }
  const bool held = row.text("over") == "supports";  // its place is given
  if (limit && !held && before == "stable" && after == "unstable") {
    const std::optional<double> next = stable_again(rows, k);
    text += next ? fmt::format(
                       "; the path is stable again at this load at displacement "
                       "{:.6g} m",
                       *next)
                 : "; the path has no other stable point at this load";
  }
  return text;
}

double largest(const Rows& rows, std::string_view column) {
  double most = 0;
  for (const Row* row : rows) {
    if (row->has(column)) most = std::max(most, row->number(column));
  }
  return most;
}

std::string validity(const Rows& rows) {
  const auto bad = static_cast<std::size_t>(
      std::ranges::count_if(rows, [](const Row* row) { return !row->ok(); }));
  std::string text = fmt::format(
      "  verified: {} of {} points; largest residual {:.1e} of EI/L, gap {:.1e} of the "
      "length, last correction {:.1e}",
      rows.size() - bad, rows.size(), largest(rows, "residual_rel"),
      largest(rows, "gap_rel"), largest(rows, "correction_rel"));
  const bool follows = std::ranges::any_of(
      rows, [](const Row* row) { return row->text("symmetric") == "false"; });
  if (follows) {
    text +=
        "; the stiffness is unsymmetric: stability is that of small motions without "
        "friction";
  }
  return text;
}

/// Largest relative difference of the events of two paths; empty: they differ in number.
std::optional<double> difference(const Rows& a, const Rows& b) {
  std::vector<double> of_a, of_b;
  for (const auto& [rows, values] : {std::pair{&a, &of_a}, std::pair{&b, &of_b}}) {
    for (const Row* row : *rows) {
      if (is_critical(*row)) values->push_back(row->number("parameter"));
    }
  }
  if (of_a.size() != of_b.size() || of_a.empty()) return {};
  double most = 0;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    most = std::max(most, std::abs(of_a[i] / of_b[i] - 1));
  }
  return most;
}

void describe(const Rows& rows, std::vector<std::string>& lines) {
  const Row& first = *rows.front();
  const auto count = [&](std::string_view event) {
    return static_cast<std::size_t>(std::ranges::count_if(
        rows, [&](const Row* row) { return is_event(*row, event); }));
  };
  lines.push_back(
      fmt::format("{}: {}, {} elements, over {}: {}, {}, {}", first.text("scene"),
                  first.text("model"), first.text("elements"), first.text("over"),
                  count_of(rows.size(), "point", "points"),
                  count_of(count("limit_point"), "limit point", "limit points"),
                  count_of(count("bifurcation"), "bifurcation", "bifurcations")));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (is_critical(*rows[k])) lines.push_back(in_words(rows, k));
    if (k > 0 && topples(*rows[k - 1], *rows[k])) {
      lines.push_back(fmt::format(
          "  unstable as soon as the load acts: at {}, displacements that were neutral "
          "at the start have negative stiffness",
          value_of(*rows[k])));
    }
  }
  const Row& last = *rows.back();
  if (!last.ok()) {
    lines.push_back(fmt::format("  ends at {}: {}", value_of(last), last.text("reason")));
  } else {
    lines.push_back(fmt::format("  {} at {}, displacement {:.6g} m, {}",
                                is_event(last, "closed") ? "closes" : "ends",
                                value_of(last), last.number("displacement_m"),
                                last.text("stability")));
  }
  lines.push_back(validity(rows));
}

}  // namespace

std::vector<std::string> in_words(const std::vector<Row>& rows) {
  // By scene, model and parameter; then by number of elements.
  std::map<std::string, std::map<int, Rows>> all;
  std::vector<std::string> order;
  for (const Row& row : rows) {
    const std::string path = joined(row, {"scene", "model", "strand", "over"});
    if (!all.contains(path)) order.push_back(path);
    all[path][static_cast<int>(row.number("elements"))].push_back(&row);
  }
  std::vector<std::string> lines;
  for (const std::string& path : order) {
    const Rows* before = nullptr;
    for (const auto& [elements, of] : all[path]) {
      describe(of, lines);
      if (before != nullptr) {
        if (const auto change = difference(*before, of)) {
          lines.push_back(fmt::format(
              "  elements: limit points and bifurcations differ by {:.2g} % from those "
              "with {} elements",
              1e2 * *change, before->front()->text("elements")));
        }
      }
      before = &of;
    }
    if (all[path].size() == 1) {
      const int elements = all[path].begin()->first;
      lines.push_back(fmt::format(
          "  elements: the error of {} elements is not known; --elements {},{} shows it",
          elements, elements, 2 * elements));
    }
  }
  return lines;
}

}  // namespace tress::experiments::statics
