#pragma once

#include <vector>

#include "contract/basics.h"
#include "contract/parameters.h"

namespace tress::integrators {

/// Option for the depth of AndersonMixing.
inline constexpr Parameter anderson_option{
    .name = "anderson",
    .help =
        "number of earlier sweeps that Anderson acceleration combines with each sweep, "
        "0: no acceleration",
    .number = 0,
    .min = 0,
    .max = 50,
    .whole = true};

/// Anderson acceleration of a fixed-point iteration x <- g(x). With f = g(x) - x and the
/// differences dg, df between consecutive iterations, the next iterate is
///
///     g - sum gamma_j dg_j,     gamma = argmin |f - sum gamma_j df_j|,
///
/// so that the fixed point is that of g. For linear g and all differences kept, this is
/// GMRES. An iteration whose |f| is more than `growth` times the one before discards the
/// differences. Differences that depend on later ones to rounding are left out. Cost: O(n
/// depth^2), without allocation. [Anderson 1965; Walker & Ni 2011]
class AndersonMixing {
 public:
  /// Allocates for iterates of `size` entries. The norm is that of the first entries,
  /// with the weights (sums of squares, each > 0).
  AndersonMixing(int depth, std::size_t size, std::vector<double> weights);
  /// Makes one that is not active.
  AndersonMixing() : AndersonMixing(0, 0, {}) {}

  /// Returns whether mix() does anything: depth > 0.
  bool active() const { return !columns_.empty(); }
  /// Discards all iterations.
  void restart();
  /// Replaces g(x) by the accelerated iterate; `from` is x.
  void mix(In from, InOut g);

 private:
  /// One kept difference.
  struct Column {
    std::vector<double> df, dg;  // df weighted, of the entries that the norm has
    std::vector<double> basis;   // df without its part in later columns, of length 1
    std::vector<double> along;   // of the later bases in df; last its own length
    bool independent = false;
    double gamma = 0;
  };

  void remember(In g);
  void project();

  static constexpr double growth = 2;
  static constexpr double rounding = 1e-10;  // of a difference: the rest is noise

  std::vector<double> roots_;           // of the weights
  std::vector<Column> columns_;         // a ring
  std::size_t count_ = 0, newest_ = 0;  // in the ring
  bool begun_ = false;
  std::vector<double> f_, f_last_, g_last_, rest_;
};

}  // namespace tress::integrators
