#include "simulation/groom/fitted_groom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "contract/input_error.h"
#include "simulation/files/csv.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {
namespace {

constexpr int arc_parts = 4;  // of a segment of the file, for arc length and turning

/// Returns the number of straight edges: over a piece of length l and curvature k an
/// edge is k l^2/8 away, so parts have equal k^(1/2) l.
int edges_by_curvature(const SpaceCurve& curve, std::span<const double> turned,
                       double tolerance) {
  const std::span<const double> s = curve.arcs();
  double sum = 0;  // int k^(1/2) ds
  for (std::size_t i = 1; i < s.size(); ++i) {
    sum += std::sqrt((turned[i] - turned[i - 1]) * (s[i] - s[i - 1]));
  }
  const double n = std::ceil(sum / std::sqrt(8 * tolerance * curve.length()));
  return n > 2 ? static_cast<int>(std::min(n, 1e6)) : 2;
}

/// Half the width in the middle of each element, linear between points.
std::vector<double> radii_of(const HelixChain& chain, const SpaceCurve& curve,
                             std::span<const double> widths) {
  std::vector<double> radii;
  if (widths.empty()) return radii;
  std::size_t i = 0;
  for (std::size_t k = 0; k + 1 < chain.joint.size(); ++k) {
    const double middle = (chain.joint[k] + chain.joint[k + 1]) / 2;
    while (i + 2 < widths.size() && curve.arc_of_point(i + 1) < middle) ++i;
    const double from = curve.arc_of_point(i), to = curve.arc_of_point(i + 1);
    const double part = std::clamp((middle - from) / (to - from), 0.0, 1.0);
    radii.push_back(std::lerp(widths[i], widths[i + 1], part) / 2);
  }
  return radii;
}

/// The value below which a share of all is.
double quantile(std::vector<double> all, double share) {
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(
                                    share * static_cast<double>(all.size() - 1));
  std::ranges::nth_element(all, at);
  return *at;
}

std::string in_words(const std::vector<FittedStrand>& strands, const GroomFit& fit) {
  std::vector<double> rms, largest, elements;
  std::size_t beyond = 0, whole = 0, by_rule = 0;
  for (const FittedStrand& one : strands) {
    rms.push_back(100 * one.error.rms / one.length());
    largest.push_back(100 * one.error.largest / one.length());
    elements.push_back(one.elements());
    whole += static_cast<std::size_t>(one.elements());
    if (one.by_rule == 0) continue;
    by_rule += one.rule_holds ? 1 : 0;
    beyond += one.error.largest > fit.tolerance(one.length()) * one.length() ? 1 : 0;
  }
  std::string text = fmt::format(
      "{} strand{} fitted by {:g} to {:g} elements ({:.3g} on average); distance over "
      "the length: rms {:.2g} %, largest {:.2g} % for half of them, at most {:.2g} %",
      strands.size(), strands.size() == 1 ? "" : "s", *std::ranges::min_element(elements),
      *std::ranges::max_element(elements),
      static_cast<double>(whole) / static_cast<double>(strands.size()),
      quantile(rms, 0.5), quantile(largest, 0.5), *std::ranges::max_element(largest));
  if (!fit.has_tolerance()) return text;
  fmt::format_to(
      std::back_inserter(text),
      "; the estimate by turning gives enough elements for {:.3g} % of "
      "them",
      100.0 * static_cast<double>(by_rule) / static_cast<double>(strands.size()));
  if (beyond > 0) {
    fmt::format_to(std::back_inserter(text),
                   "; {} are beyond the tolerance: give more elements", beyond);
  }
  return text;
}

}  // namespace

double GroomFit::tolerance(double length) const {
  const double absolute = tolerance_m / length;
  if (tolerance_m > 0 && tolerance_rel > 0) return std::min(absolute, tolerance_rel);
  return tolerance_m > 0 ? absolute : tolerance_rel;
}

FittedStrand fitted(const PlacedGroom& groom, std::size_t k, const GroomFit& fit) {
  const std::span<const Vec> points = groom.lines.strand(k);
  const SpaceCurve curve(points, arc_parts, groom.file);
  const std::vector<double> turned = turning(curve);
  FittedStrand made;
  made.number = groom.lines.numbers[k];
  made.points = points.size();
  made.turning = turned.back();
  const double tolerance = fit.tolerance(curve.length());
  int n = fit.elements;
  if (tolerance > 0) {
    made.by_rule = fit.between == Between::helices
                       ? elements_by_turning(turned.back(), tolerance)
                       : edges_by_curvature(curve, turned, tolerance);
    n = std::min(n, made.by_rule);
  }
  while (true) {
    made.chain = fit_helices(curve, fit.by_turning ? cut_by_turning(curve, turned, n)
                                                   : cut_equally(curve.length(), n));
    made.error = distance(curve, made.chain, fit.between);
    if (!std::isfinite(made.error.rms)) {
      throw InputError(fmt::format("strand {} folds back on itself", made.number),
                       groom.file, "leave it out of the file, or move its points");
    }
    const bool within = made.error.largest <= tolerance * curve.length();
    if (n == made.by_rule) made.rule_holds = within;
    if (tolerance == 0 || within || n >= fit.elements) {
      made.radii = radii_of(made.chain, curve, groom.lines.widths_of(k));
      return made;
    }
    n = std::min(fit.elements, n + (n + 1) / 2);
  }
}

FittedGroom fit_groom(const PlacedGroom& groom, std::size_t count, const GroomFit& fit,
                      int threads) {
  FittedGroom made{groom.file, groom.notes, {}};
  made.strands.resize(count);
  Crew crew(threads);
  constexpr std::size_t parts_of_thread = 16;
  in_parts(crew, 0, count, parts_of_thread * static_cast<std::size_t>(threads),
           [&](std::size_t k, std::size_t) {
             made.strands[k] = fitted(groom, k * groom.lines.size() / count, fit);
           });
  made.notes.push_back(in_words(made.strands, fit));
  return made;
}

std::string fit_csv(std::span<const std::shared_ptr<const FittedGroom>> grooms) {
  static constexpr const char* columns[] = {
      "file",     "file_strand",   "points",        "length_m",         "turning_rad",
      "elements", "elements_rule", "error_rms_rel", "error_largest_rel"};
  std::string text =
      csv_line(std::vector<std::string>(std::begin(columns), std::end(columns)));
  for (const auto& groom : grooms) {
    for (const FittedStrand& one : groom->strands) {
      Row row;
      row.set(columns[0], std::filesystem::path(groom->file).filename().string())
          .set(columns[1], one.number)
          .set(columns[2], one.points)
          .set(columns[3], one.length())
          .set(columns[4], one.turning)
          .set(columns[5], one.elements())
          .set(columns[6], one.by_rule)
          .set(columns[7], one.error.rms / one.length())
          .set(columns[8], one.error.largest / one.length());
      std::vector<std::string> cells;
      for (const auto& [name, cell] : row.cells()) cells.push_back(cell);
      text += csv_line(cells);
    }
  }
  return text;
}

}  // namespace tress::simulation
