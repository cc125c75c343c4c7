#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments::divided_heads {

/// Elements of a hair.
inline constexpr int elements = 10;

/// Returns the border that a region of the scalp shares with others, over the side of the
/// whole. The region is the largest of `ranks`, a power of two, made by halving a square
/// and its parts across their longer sides.
double border(double ranks);

/// Wall time of a step of n hairs, of constant density on the scalp, on R ranks
/// (processes of one thread),
///
///     T(n, R) = (n/R) e (k + c (1 - a/sqrt(n))) + G e b + l log2 R,
///
/// where e is the number of elements of a hair. The cost k of an element by itself
/// depends on the number of hairs on the machine, since its cores share their caches. The
/// cost of an element's contacts with other hairs is c. Hairs near the edge of the scalp
/// have fewer contacts, which lowers the mean by the share a/sqrt(n). Ghosts lie within a
/// depth w of a region's border. With hairs' roots a mean distance d apart,
///
///     G = border(R) (w/d) sqrt(n),  but at most all hairs of other ranks;
///
/// The cost of sending, receiving, storing and listing an element of a ghost is b. The
/// latency of the values on which all ranks agree in a step is l.
struct CostModel {
  /// Cost of a machine's kernel with this number of hairs, ascending: linear in the
  /// logarithm of the number between entries, constant beyond.
  struct Kernel {
    double strands, cost;  // cost: s
  };
  std::vector<Kernel> kernel;
  double cores = 1;     // of a machine, with a rank on each
  double contacts = 0;  // s
  double edge = 0;      // a
  double depth = 0;     // w/d
  double ghost = 0;     // s
  double latency = 0;

  double kernel_cost(double strands) const;
  /// `beside`: such heads on the machine.
  double own_cost(double strands, double ranks, double beside = 1) const;
  double ghosts(double strands, double ranks) const;
  double cost(double strands, double ranks, double beside = 1) const;
  /// Returns the share of a rank's time that its own hairs take.
  double efficiency(double strands, double ranks) const {
    return own_cost(strands, ranks) / cost(strands, ranks);
  }
};

/// A head that was measured.
struct Measurement {
  bool touch = false;  // hairs interact
  double strands = 0, ranks = 1;
  double beside = 1;  // such heads that ran at the same time
  double cores = 1;   // of the machine
  double cost = 0;    // of a step, s
  double ghosts = 0;  // of the rank that has most
};

/// Models of hairs that do not touch and of those that do. Each of their numbers is the
/// mean of single measurements, but for contacts and edge, which are a line through those
/// of one rank alone. The kernel is from measurements whose hairs do not touch, the
/// latency from two ranks whose hairs do not touch, and depth and ghost from two whose
/// hairs do. Empty if measurements for one of these are missing.
struct CostModels {
  CostModel apart, touching;
};
std::optional<CostModels> fit_cost(std::span<const Measurement> all);
/// Returns the predicted cost of a step, also where other heads run or ranks take turns
/// on fewer cores.
double predicted(const CostModels& models, const Measurement& of);

}  // namespace tress::experiments::divided_heads
