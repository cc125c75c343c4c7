#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/files/row.h"

namespace tress::experiments::family {

/// Linear interpolation between order statistics [Hyndman & Fan 1996, type 7];
/// `share` in [0, 1], `values` not empty.
double quantile(std::vector<double> values, double share);

/// Spearman's rank correlation; ties share the mean of their ranks. 0 when all entries of
/// either are equal.
double rank_correlation(std::span<const double> x, std::span<const double> y);

/// A rule with one threshold: the claim holds above it, or below it.
struct Stump {
  bool found = false;  // false: no threshold predicts better than a constant
  double threshold = 0;
  double share_below = 0, share_above = 0;  // of the claim among hairs on either side
  double right = 0;                         // share of all hairs that the rule classifies
                                            // correctly
};

/// The threshold on x that best predicts `holds`, with at least `least` hairs on either
/// side.
Stump best_stump(std::span<const double> x, const std::vector<bool>& holds,
                 std::size_t least);

/// One row per claim over the hairs that answered it: their number, the share for which
/// it holds, quantiles of the value, the hair parameter with the strongest rank
/// correlation with the value, and the one that best predicts by one threshold whether
/// the claim holds.
std::vector<Row> summarize(std::span<const Row> rows);

std::span<const Column> summary_columns();

}  // namespace tress::experiments::family
