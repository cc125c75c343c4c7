#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>

#include "experiments/family/family.h"

namespace tress::experiments::family {
namespace {

constexpr Column columns[] = {
    {"study", "study of the claim"},
    {"claim", "name of the statement"},
    {"family", "hair, or rods of other materials"},
    {"model", "model, where the claim is about one"},
    {"integrator", "method, where the claim is about one"},
    {"range", "gravito-bending numbers of the rods that are counted"},
    {"statement", "claim about every rod"},
    {"value", "quantity of the quantiles"},
    {"hairs", "rods that answered"},
    {"no_answer", "rods that did not answer"},
    {"reasons",
     "number of rods without an answer by status: no_reference, unresolved, ..."},
    {"holds_share", "share of the rods that answered for which the claim is true"},
    {"decile_1", "first decile of the values"},
    {"median", "median of the values"},
    {"decile_9", "ninth decile of the values"},
    {"correlated_with", "parameter with the largest rank correlation with the value"},
    {"rank_correlation", "Spearman's rank correlation of these two"},
    {"decided_by", "parameter whose one threshold best predicts where the claim is true"},
    {"threshold", "threshold of that parameter"},
    {"share_below", "share of the rods below the threshold for which the claim is true"},
    {"share_above", "share of the rods above the threshold for which the claim is true"},
    {"told_right_share", "share of the rods that the threshold predicts correctly"},
};

// Minimum on either side of a threshold: fewer rods are separated by chance.
constexpr std::size_t least_hairs = 4;

constexpr std::string_view numbers_of_a_rod[] = {"gravito_bending",
                                                 "winding_rad",
                                                 "damping_time_s",
                                                 "drag_kg_m_s",
                                                 "ellipticity",
                                                 "length_m",
                                                 "radius_m",
                                                 "youngs_modulus_pa",
                                                 "drive_level",
                                                 "frequency_hz",
                                                 "natural_curvature_per_m"};

/// Ranks of the values in ascending order; ties share their mean.
std::vector<double> ranks_of(std::span<const double> x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [x](std::size_t i) { return x[i]; });
  std::vector<double> ranks(x.size());
  for (std::size_t from = 0; from < order.size();) {
    std::size_t to = from;
    while (to < order.size() && x[order[to]] == x[order[from]]) ++to;
    const double mean = static_cast<double>(from + to - 1) / 2;
    for (; from < to; ++from) ranks[order[from]] = mean;
  }
  return ranks;
}

/// A parameter of all rods, or one value of the drive as 0 or 1.
struct Predictor {
  std::string name;
  std::vector<double> x;
};

std::vector<Predictor> predictors_of(const std::vector<const Row*>& rows) {
  std::vector<Predictor> all;
  const auto add = [&](std::string name, auto value_of) {
    Predictor p{std::move(name), {}};
    for (const Row* row : rows) p.x.push_back(value_of(*row));
    all.push_back(std::move(p));
  };
  for (const std::string_view column : numbers_of_a_rod) {
    add(std::string(column), [&](const Row& row) { return row.number(column); });
  }
  for (int i = 0; i < drives; ++i) {
    const std::string_view word = name(static_cast<Drive>(i));
    add("drive is " + std::string(word),
        [&](const Row& row) { return row.text("drive") == word ? 1.0 : 0.0; });
  }
  return all;
}

void describe_decision(const std::vector<const Row*>& rows,
                       const std::vector<double>& values, const std::vector<bool>& holds,
                       Row& summary) {
  double closest = 0, best = 0;  // of the rules so far
  for (const Predictor& p : predictors_of(rows)) {
    const double correlation = rank_correlation(p.x, values);
    if (std::abs(correlation) > std::abs(closest)) {
      closest = correlation;
      summary.set("correlated_with", p.name).set("rank_correlation", correlation);
    }
    const Stump stump = best_stump(p.x, holds, least_hairs);
    if (!stump.found || stump.right <= best) continue;
    best = stump.right;
    summary.set("decided_by", p.name).set("threshold", stump.threshold);
    summary.set("share_below", stump.share_below).set("share_above", stump.share_above);
    summary.set("told_right_share", stump.right);
  }
}

/// What a claim is about.
struct Subject {
  std::string_view family, model, integrator;  // no model: it compares its own
  bool operator==(const Subject&) const = default;
};

Subject subject_of(const Row& row) {
  return {row.text("family"), row.text("model"), row.text("integrator")};
}

/// Gravito-bending numbers from `low` to below `high`.
struct Numbers {
  std::string_view name;
  double low, high;
};
constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr Numbers everything{"all", 0, unbounded};
constexpr Numbers ranges[] = {everything,
                              {"below 10", 0, 10},
                              {"10 to 100", 10, 100},
                              {"100 to 1000", 100, 1000},
                              {"above 1000", 1000, unbounded}};

bool contains(const Numbers& range, const Row& row) {
  const double number = row.number("gravito_bending");
  return range.low <= number && number < range.high;
}

/// In the order of their first rows; one without a name if there are no rows.
std::vector<Subject> subjects_of(const Claim& claim, std::span<const Row> rows) {
  std::vector<Subject> all;
  for (const Row& row : rows) {
    if (row.text("claim") != claim.id) continue;
    if (std::ranges::find(all, subject_of(row)) == all.end()) {
      all.push_back(subject_of(row));
    }
  }
  if (all.empty()) all.emplace_back();
  return all;
}

/// "3 no_reference, 1 short_horizon"
std::string listed(const std::map<std::string_view, int>& reasons) {
  std::string text;
  for (const auto& [status, count] : reasons) {
    text +=
        (text.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(status);
  }
  return text;
}

Row summary_of(const Study& study, const Claim& claim, const Subject& subject,
               const Numbers& range, std::span<const Row> rows) {
  Row summary;
  summary.set("study", study.id).set("claim", claim.id).set("family", subject.family);
  summary.set("model", subject.model).set("integrator", subject.integrator);
  summary.set("range", range.name);
  summary.set("statement", claim.statement).set("value", claim.value);
  std::vector<const Row*> answered;
  std::vector<double> values;
  std::vector<bool> holds;
  int silent = 0;
  std::map<std::string_view, int> reasons;
  for (const Row& row : rows) {
    if (row.text("claim") != claim.id || subject_of(row) != subject) continue;
    if (!contains(range, row)) continue;
    if (!row.ok()) {
      ++silent;
      ++reasons[row.status()];
      continue;
    }
    answered.push_back(&row);
    values.push_back(row.number("value"));
    holds.push_back(row.text("holds") == "true");
  }
  summary.set("hairs", answered.size()).set("no_answer", silent);
  summary.set("reasons", listed(reasons));
  if (answered.empty()) return summary;
  const auto held = static_cast<double>(std::ranges::count(holds, true));
  summary.set("holds_share", held / static_cast<double>(holds.size()));
  summary.set("decile_1", quantile(values, 0.1)).set("median", quantile(values, 0.5));
  summary.set("decile_9", quantile(values, 0.9));
  if (range.name == everything.name) describe_decision(answered, values, holds, summary);
  return summary;
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

double rank_correlation(std::span<const double> x, std::span<const double> y) {
  const std::vector<double> a = ranks_of(x), b = ranks_of(y);
  const double mean = (static_cast<double>(x.size()) - 1) / 2;
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
    ab += (a[i] - mean) * (b[i] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

Stump best_stump(std::span<const double> x, const std::vector<bool>& holds,
                 std::size_t least) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [x](std::size_t i) { return x[i]; });
  const auto count = static_cast<double>(x.size());
  const auto all = static_cast<double>(std::ranges::count(holds, true));
  // A rule must classify more rods correctly than a constant.
  Stump best{.right = std::max(all, count - all) / count};
  double below = 0;  // rods below the threshold for which the claim holds
  for (std::size_t n = 1; n < order.size(); ++n) {
    below += holds[order[n - 1]] ? 1 : 0;
    const double low = x[order[n - 1]], high = x[order[n]];
    if (n < least || order.size() - n < least || low == high) continue;
    const double under = static_cast<double>(n), over = count - under;
    const double right =
        std::max(below, under - below) + std::max(all - below, over - (all - below));
    if (right <= best.right * count) continue;
    best = {true, (low + high) / 2, below / under, (all - below) / over, right / count};
  }
  return best;
}

std::vector<Row> summarize(std::span<const Row> rows) {
  std::vector<Row> all;
  for (const Study& study : studies()) {
    for (const Claim& claim : study.claims) {
      for (const Subject& subject : subjects_of(claim, rows)) {
        for (const Numbers& range : ranges) {
          all.push_back(summary_of(study, claim, subject, range, rows));
        }
      }
    }
  }
  return all;
}

std::span<const Column> summary_columns() { return columns; }

}  // namespace tress::experiments::family
