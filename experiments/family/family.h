#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/parameters.h"
#include "contract/system.h"
#include "simulation/files/row.h"
#include "simulation/run/guard.h"

namespace tress::experiments::family {

/// The excitation of a hair. By `level` in [0, 1]: shake by 1 to 5 cm; a head that turns
/// by 0.2 to 0.8 rad, 10 cm behind the root; none (released horizontally); a sideways
/// wind of 0.5 to 5 m/s at its peak, a sine in time, with linear drag of 2e-5 kg/(m s).
enum class Drive { shake, turning_head, release, wind };
inline constexpr int drives = 4;
std::string_view name(Drive drive);

/// One member of the family. Its natural twist is 0.3 times its natural curvature.
struct Hair {
  int number;                // 1, 2, ...
  double length;             // m
  double radius;             // m
  double youngs_modulus;     // Pa
  double ellipticity;        // half-axis along e1 over half-axis along e2
  double natural_curvature;  // 1/m
  double internal_friction;  // kg m^3/s
  Drive drive;
  double level;      // of the drive, in [0, 1]
  double frequency;  // of the drive, 1/s

  /// rho A g L^3/(EI) of the round section: how far gravity bends the hair.
  double gravito_bending() const;
  /// Angle by which the natural shape turns from root to tip (rad).
  double winding() const;

  /// Sets the columns that describe the hair.
  void describe(Row& row) const;
};

/// Columns that `describe` sets.
std::vector<Column> hair_columns();

/// A Latin hypercube [McKay, Beckman & Conover 1979]: every parameter's range is divided
/// into `count` equal parts, and each part holds exactly one hair. Length 3 to 40 cm,
/// radius 20 to 60 um, Young's modulus 1e6 to 4e9 Pa (logarithmic), ellipticity 1 to 1.6,
/// natural curvature 0 to 300 1/m, internal friction 0 for a quarter of the hairs and
/// 1e-13 to 1e-10 kg m^3/s (logarithmic) for the others, drives in equal shares,
/// frequency 1 to 4 1/s. Equal seeds give equal hairs on every machine.
std::vector<Hair> latin_hypercube(int count, std::uint64_t seed);

/// The hair with its natural shape straightened, its section and material kept.
Hair straightened(Hair hair);

/// Elements that follow its natural shape: at least 20, and no more than 1.5 rad of
/// winding in each, for those of der must stay below half a circle.
int elements_of(const Hair& hair);

/// Parameters of `model` for this hair.
Parameters parameters_of(const Hair& hair, std::string_view model, int elements);

/// The model of the hair, under gravity and its drive. `modes`: "bend_twist" or "bend",
/// for the models with that option (super_helix, articulated_chain).
std::unique_ptr<System> make_system(const Hair& hair, std::string_view model,
                                    int elements, std::string_view modes = "bend_twist");
/// Guard of that system; its hair is complete, with bending and twist.
Guard make_guard(const Hair& hair, std::string_view model, int elements, System& system);

/// Peak of the wind (m/s) at this level.
double wind_speed(const Hair& hair);
inline constexpr double wind_drag = 2e-5;  // kg/(m s), linear drag per length

/// A statement of the README about one hair, to be tested on all.
struct Claim {
  std::string_view id;
  std::string_view statement;  // a sentence, true of a hair where the claim holds
  std::string_view value;      // meaning of the column `value`, with unit
};

/// One computation on one hair that answers one or more claims. Bounded by numbers of
/// steps, never by time.
struct Study {
  std::string_view id;
  std::span<const Claim> claims;
  /// Rows in the order of `claims`, once for each integrator that they are about. `row`:
  /// identity and hair are set; with `models`, `model`, `tolerance` and `most_calls` too.
  std::vector<Row> (*run)(const Hair& hair, const Row& row);
  /// A piece of work on each of these models; empty: one on the hair.
  std::span<const std::string_view> models = {};
  /// What --quick leaves of it.
  struct Quick {
    int stride = 1;          // the first hair and every so manieth after it
    std::size_t models = 0;  // the first so many
  } quick = {};
};

std::span<const Study> studies();

/// Options::max_work of a run: ten times the work of Newton's method with five iterations
/// in every step. A run beyond it counts as without an answer.
double enough_work(System& system, double t_end, double dt);

/// A row that answers `claim`: its value, and whether the claim holds for this hair.
Row answer(Row row, const Claim& claim, double value, bool holds);

/// A row without an answer, with the reason.
Row no_answer(Row row, const Claim& claim, std::string_view status,
              std::string_view reason);

extern const Study stable_steps, twist, bdf_order, equal_accuracy, tolerance, sweeps;

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

/// One row per claim, model and integrator over the hairs that answered it: their number,
/// the share for which it holds, quantiles of the value, the hair parameter with the
/// strongest rank correlation with the value, and the one that best predicts by one
/// threshold whether the claim holds.
std::vector<Row> summarize(std::span<const Row> rows);

std::span<const Column> summary_columns();

}  // namespace tress::experiments::family
