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

/// The population that a rod is drawn from.
enum class Family { hair, rods };
std::string_view name(Family family);

/// Excitation of a rod. By `level` in [0, 1]:
/// - shake by 1 to 5 cm, as the head of a person who walks or runs;
/// - a head that turns by 0.2 to 0.83 rad, 10 cm behind the root;
/// - none (released horizontally);
/// - a sideways wind of 0.5 to 10 m/s at its peak (logarithmic), a sine in time.
enum class Drive { shake, turning_head, release, wind };
inline constexpr int drives = 4;
std::string_view name(Drive drive);

/// One member of a family: a hair, or a rod of another material.
struct Rod {
  Family family = Family::hair;
  int number = 1;                // 1, 2, ... within its family
  std::string_view kind = {};    // of hair: straight, wavy or coily; else the material
  std::string_view state = {};   // of hair: dry or wet
  double length;                 // m
  double radius;                 // m; of an ellipse the geometric mean
  double youngs_modulus;         // Pa
  double shear_modulus;          // Pa
  double density;                // kg/m^3
  double ellipticity = 1;        // half-axis along e1 over half-axis along e2
  double natural_curvature = 0;  // 1/m
  double natural_twist = 0;      // 1/m
  double internal_friction = 0;  // kg m^3/s
  double drag = 0;               // of air, linear, per length, kg/(m s)
  Drive drive;
  double level;      // of the drive, in [0, 1]
  double frequency;  // of the drive, 1/s

  double mass_per_length() const;    // kg/m
  double bending_stiffness() const;  // E I of the round section of the same area, N m^2
  /// rho A g L^3/(EI) of that section: how far gravity bends the rod.
  double gravito_bending() const;
  /// Angle by which the natural shape turns from root to tip (rad).
  double winding() const;
  /// Returns the typical speed of the rod relative to the air (m/s). It is that of the
  /// wind at its peak, of the root (with a head, of the middle of the rod), or of a fall
  /// by half the length.
  double air_speed() const;

  /// Sets the columns that describe the rod.
  void describe(Row& row) const;
};

/// Columns that `describe` sets.
std::vector<Column> rod_columns();

/// Force of still air per length and speed (kg/(m s)) on a cylinder that crosses it at
/// this speed: models::CylinderDrag. Of a hair of 36 um 8e-5 at 0.1 m/s, 5e-4 at 5 m/s.
double air_drag(double radius, double speed);

/// A Latin hypercube [McKay, Beckman & Conover 1979]: every coordinate is divided into
/// `count` equal parts, and each part holds exactly one rod. A coordinate is a quantile
/// of the distribution of its parameter. Equal seeds give equal rods on every machine.
///
/// Hair: measured distributions of human hair, dry and wet, in three groups (hair.cpp).
/// Rods: fifteen other materials, each with an equal share where `count` is a multiple of
/// fifteen (materials.cpp). Drives in equal shares. Frequency of a shake 2 to 3.2 1/s
/// (walking, running), of others 1 to 2.6 1/s.
std::vector<Rod> latin_hypercube(Family family, int count, std::uint64_t seed);

/// The rod with its natural shape straightened, its section and material kept.
Rod straightened(Rod rod);

/// Elements that follow its natural shape: at least 20, and no more than 1.5 rad of
/// winding in each, for those of der must stay below half a circle.
int elements_of(const Rod& rod);

/// Parameters of `model` for this rod.
Parameters parameters_of(const Rod& rod, std::string_view model, int elements);

/// The model of the rod, under gravity and its drive. `modes`: "bend_twist" or "bend",
/// for the models with that option (super_helix, articulated_chain).
std::unique_ptr<System> make_system(const Rod& rod, std::string_view model, int elements,
                                    std::string_view modes = "bend_twist");
/// Guard of that system; its strand is complete, with bending and twist.
Guard make_guard(const Rod& rod, std::string_view model, int elements, System& system);

/// Peak of the wind (m/s) at this level.
double wind_speed(const Rod& rod);
/// Greatest speed (m/s) at which the root moves, or a turning head moves the tip.
double root_speed(const Rod& rod);

/// A statement of the README about one rod, to be tested on all.
struct Claim {
  std::string_view id;
  std::string_view statement;  // a sentence, true of a rod where the claim holds
  std::string_view value;      // meaning of the column `value`, with unit
};

/// One computation on one rod that answers one or more claims. Bounded by numbers of
/// steps, never by time.
struct Study {
  std::string_view id;
  std::span<const Claim> claims;
  /// Rows in the order of `claims`, once for each integrator that they are about. `row`:
  /// identity and rod are set; with `models`, `model`, `tolerance` and `most_calls` too.
  std::vector<Row> (*run)(const Rod& rod, const Row& row);
  /// A piece of work on each of these models; empty: one on the rod.
  std::span<const std::string_view> models = {};
  /// The part that --quick runs.
  struct Quick {
    int stride = 1;          // the first rod and every n-th after it
    std::size_t models = 0;  // the first n
  } quick = {};
  /// Runs only where it is named.
  bool apart = false;
};

std::span<const Study> studies();

/// Options::max_work of a run: ten times the work of Newton's method with five iterations
/// in every step. A run beyond it counts as without an answer.
double enough_work(System& system, double t_end, double dt);

/// A row that answers `claim`: its value, and whether the claim holds for this rod.
Row answer(Row row, const Claim& claim, double value, bool holds);

/// A row without an answer, with the reason.
Row no_answer(Row row, const Claim& claim, std::string_view status,
              std::string_view reason);

/// Answers `claim` of a run that is within its tolerance up to the last of `agreed` out
/// of `samples` times at which its references agree. The claim holds, or is inconclusive
/// where they agree on less than half of the time.
Row within_tolerance(Row row, const Claim& claim, double error, int agreed, int samples);

extern const Study stable_steps, twist, bdf_order, equal_accuracy, tolerance, sweeps,
    tolerances_study;

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
  double share_below = 0, share_above = 0;  // of the claim among rods on either side
  double right = 0;                         // share of all rods that the rule classifies
                                            // correctly
};

/// The threshold on x that best predicts `holds`, with at least `least` rods on either
/// side.
Stump best_stump(std::span<const double> x, const std::vector<bool>& holds,
                 std::size_t least);

/// Returns one row per claim, family, model, integrator and range of the gravito-bending
/// number over the rods that answered it. Its columns are their number, the share for
/// which the claim holds, and quantiles of the value. Rods without an answer are counted
/// by reason. The row over all numbers also has the parameter with the strongest rank
/// correlation with the value, and the one that best predicts by one threshold whether
/// the claim holds.
std::vector<Row> summarize(std::span<const Row> rows);

std::span<const Column> summary_columns();

}  // namespace tress::experiments::family
