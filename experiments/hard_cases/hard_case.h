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
#include "simulation/run/simulation.h"

namespace tress::experiments::hard_cases {

/// A model with the words that make it a variant.
struct Subject {
  const ModelEntry* model;
  ModelSettings settings;
  std::string words;  // "stretch=inextensible tangent=stiff"; empty: as it comes
};

/// A case as one model has it.
struct Situation {
  Parameters parameters;  // the model's, with the case's
  Strand strand;          // no segments: a system of particles
  Effects effects;
  double length;  // m
  double mass;    // kg
  std::unique_ptr<System> system;
  State start;
};

/// What a case looks at beyond the bounds of every run; sees every step.
class Gauge {
 public:
  virtual ~Gauge() = default;
  virtual void see(double t, In q, In v) = 0;
  /// After the run: the case is passed up to HardCase::limit.
  virtual double measure() const = 0;
  /// Accuracy, where it is not that of the tip: the case is accurate up to
  /// largest_error.
  virtual std::optional<double> error() const { return {}; }
};

/// Accurate: the tip's root mean square distance from the reference over the horizon is
/// at most so much of the length (HardCase::error_scale). 5 mm of a hair of 10 cm is
/// what can be seen of a moving one.
inline constexpr double largest_error = 0.05;

/// When a Tether of a case lets go, s.
inline constexpr double never_off = 1e6;

/// One situation that a simulator of strands should survive. What is not set is a hair of
/// 10 cm, 40 um radius and 20 elements (EI = 6e-9 N m^2, 6.5e-7 kg), and gravity.
struct HardCase {
  std::string_view name;
  std::string_view why;        // it is hard
  std::string_view measure;    // what is measured, with its unit
  std::string_view criterion;  // what passes, and why a right simulator must
  double limit = 1;            // of the measure

  ModelSettings settings = {};
  double t_end = 0.25;  // s
  long count = 0;       // not 0: this many steps, however long
  /// Accuracy is judged until here, s: beyond it an undamped strand is chaotic, or what
  /// is left is too small to compare. 0: the gauge says.
  double horizon = 0.25;
  double reference_step = 2.5e-4;  // s, of the reference; its gap says how good it is
  int rod_elements = 0;     // reference: so many of super_helix; 0: the same model's
  double further_step = 0;  // s, tried beside the usual ones; 0: none
  /// Why no model of a strand can have it; empty: they can.
  std::string_view not_for_strands = {};
  std::vector<std::pair<std::string_view, ModelSettings>> particles =
      {};  // others, for it

  StabilityBounds (*bounds)(const Situation&, double t_end) = nullptr;
  /// None: the largest part of a bound that is used up.
  std::unique_ptr<Gauge> (*gauge)(const Situation&) = nullptr;
  void (*shape)(Strand&) = nullptr;
  void (*act)(const Strand&, Effects&) = nullptr;
  void (*displace)(const Situation&, State&) = nullptr;
  /// Why this system cannot be in this situation; none or empty: it can.
  std::string (*objection)(System&) = nullptr;
  /// When steps end; none: all of them are as long as asked for.
  std::vector<double> (*stops)(double dt, double t_end) = nullptr;
  double (*error_scale)(const Situation&) = nullptr;  // m; none: the length
};

/// All of them.
std::span<const HardCase> hard_case_catalogue();

// By what makes them hard.
std::vector<HardCase> extreme_cases();     // sizes, stiffness, numbers of elements
std::vector<HardCase> motion_cases();      // roots, steps, instabilities
std::vector<HardCase> contact_cases();     // bodies, and the strand itself
std::vector<HardCase> constraint_cases();  // redundant, violated, nearly rigid

/// The case on this model: throws InputError, in the library's words, where the model
/// cannot have it. Rates start off by up to a thousandth of their size
/// (perturbed_start).
Situation situation(const HardCase& hard, const Subject& subject,
                    const Parameters& defaults);

// ---- bounds that several cases share

/// Energy (J) that the situation can turn into motion: that of the start above the strand
/// hanging straight and unloaded.
double energy_scale(const Situation& situation);
/// No more than 1 % of it may be gained.
StabilityBounds passive_bounds(const Situation& situation, double t_end);
/// The tip stays within the length of the root, and below the speed that the root's
/// motion can give it (strand_speed_bound).
StabilityBounds driven_bounds(const Situation& situation, double t_end);
/// Only finite numbers: the gauge says the rest.
StabilityBounds no_bounds(const Situation& situation, double t_end);

}  // namespace tress::experiments::hard_cases
