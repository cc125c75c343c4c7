#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/numerics/stability.h"
#include "models/effects/effect.h"
#include "models/strand/strand.h"
#include "simulation/run/rubbing.h"
#include "simulation/run/simulation.h"

namespace tress::experiments::hard_cases {

/// A model with the option values that make it a variant.
struct Subject {
  const ModelEntry* model;
  ModelSettings settings;
  std::string words;  // "stretch=inextensible jacobian=elastic"; empty: default options
};

/// A case instantiated for one model.
struct Situation {
  Parameters parameters;  // the model's, with the case's
  Strand strand;          // no segments: a system of particles
  Effects effects;
  double length;  // m
  double mass;    // kg
  std::unique_ptr<System> system;
  State start;
  std::unique_ptr<Rubbing> rubbing;  // null: without impulses
};

/// The measure of a case beyond the bounds of every run; sees every step.
class Gauge {
 public:
  virtual ~Gauge() = default;
  virtual void see(double t, In q, In v) = 0;
  /// After the run: the case is passed up to HardCase::limit.
  virtual double measure() const = 0;
  /// Accuracy, unless it is that of the tip: the case is accurate up to largest_error.
  virtual std::optional<double> error() const { return {}; }
};

/// Accurate: the tip's root mean square distance from the reference over the horizon is
/// at most this fraction of the length (HardCase::error_scale). 5 mm of a hair of 10 cm
/// is what is visible on a moving one.
inline constexpr double largest_error = 0.05;

/// Release time of a Tether that never releases, s.
inline constexpr double never_off = 1e6;

/// One situation that a simulator of strands should survive. Defaults: a hair of 10 cm,
/// 40 um radius and 20 elements (EI = 6e-9 N m^2, 6.5e-7 kg), and gravity.
struct HardCase {
  std::string_view name;
  std::string_view why;        // why the case is hard
  std::string_view measure;    // the measured quantity, with its unit
  std::string_view criterion;  // what passes, and why a correct simulator must
  double limit = 1;            // of the measure

  ModelSettings settings = {};
  double t_end = 0.25;  // s
  /// Number of steps that set the simulated time, of any length; with a tolerance, of
  /// the longest allowed. 0: t_end sets the time.
  long count = 0;
  /// Accuracy is judged up to this time, s: beyond it an undamped strand is chaotic, or
  /// the remaining motion is too small to compare. 0: judged by the gauge.
  double horizon = 0.25;
  double reference_step = 2.5e-4;  // s, of the reference; its gap indicates its quality
  int rod_elements = 0;     // reference: elements of super_helix; 0: the same model
  double further_step = 0;  // s, additional step to try; 0: none
  /// Why no strand model can represent it; empty: they can.
  std::string_view not_for_strands = {};
  std::vector<std::pair<std::string_view, ModelSettings>> particles =
      {};  // particle systems to try

  StabilityBounds (*bounds)(const Situation&, double t_end) = nullptr;
  /// Null: measures the largest fraction of a bound that is used up.
  std::unique_ptr<Gauge> (*gauge)(const Situation&) = nullptr;
  void (*shape)(Strand&) = nullptr;
  void (*act)(const Strand&, Effects&) = nullptr;
  void (*displace)(const Situation&, State&) = nullptr;
  /// Why this system cannot be in this situation; null or empty: it can.
  std::string (*objection)(System&) = nullptr;
  /// Ends of the steps; null: all steps have the requested length. With a tolerance the
  /// method chooses its steps, and these are the times at which its state is read.
  std::vector<double> (*stops)(double dt, double t_end) = nullptr;
  double (*error_scale)(const Situation&) = nullptr;  // m; null: the length
  /// Contact by impulses at the ends of steps with bodies that allow it and with the
  /// strand itself, with these values of [effects.strand_friction]. References have the
  /// bodies' own forces instead.
  std::optional<ModelSettings> impulses = {};
};

std::span<const HardCase> hard_case_catalogue();

// Grouped by the source of difficulty.
std::vector<HardCase> extreme_cases();     // sizes, stiffness, numbers of elements
std::vector<HardCase> motion_cases();      // roots, steps, instabilities
std::vector<HardCase> contact_cases();     // bodies, and the strand itself
std::vector<HardCase> constraint_cases();  // redundant, violated, nearly rigid

/// The case on this model; throws the library's InputError if the model cannot represent
/// it. Rates start perturbed by up to a thousandth of their size (perturbed_start).
Situation situation(const HardCase& hard, const Subject& subject,
                    const Parameters& defaults);

// ---- bounds that several cases share

/// Energy (J) that the situation can convert to motion: that of the start above the
/// strand hanging straight and unloaded.
double energy_scale(const Situation& situation);
/// Energy gain of at most 1 % of energy_scale().
StabilityBounds passive_bounds(const Situation& situation, double t_end);
/// The tip stays within the length of the root, and below the speed that the root's
/// motion can give it (strand_speed_bound).
StabilityBounds driven_bounds(const Situation& situation, double t_end);
/// Requires finite numbers only: the gauge judges everything else.
StabilityBounds no_bounds(const Situation& situation, double t_end);

}  // namespace tress::experiments::hard_cases
