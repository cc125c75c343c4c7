#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contract/forms/driven_bodies.h"
#include "contract/forms/energetics.h"
#include "contract/forms/material_points.h"
#include "contract/forms/support_forces.h"
#include "simulation/run/energy_account.h"
#include "simulation/run/guarded_strand.h"
#include "simulation/run/method_dissipation.h"
#include "simulation/run/simulation.h"

namespace tress::simulation {

/// A physically impossible state found by a guard.
struct Breach {
  /// Bound that is broken: `not_finite` numbers, `stretch`, `speed` or `energy`.
  enum class Kind { not_finite, stretch, speed, energy };
  Kind kind;          // which bound
  std::string what;   // "a piece is stretched by 6.6 of its length (at most 0.5)"
  std::string where;  // "strand 0, element 7"; empty: the system as a whole
  double t;           // s

  /// Returns what, where and when in one line.
  std::string message() const;
};

/// Checks one system for physically impossible states, so that no run ends "ok" with
/// invalid results. Impossible are numbers that are not finite, and a segment stretched
/// or compressed by more than half of its length. So are more energy than the initial
/// energy plus the work done, and a point faster than that energy permits.
///
/// Energy and speed are bounded as in EnergyAccount, with the slack m g L + E_0/10. m g L
/// is the energy gained by hanging down. A tenth of E_0, the initial kinetic and elastic
/// energy, allows for the error of coarse but sound steps. Mechanisms have no m g L:
/// their typical kinetic energy (System::scale) replaces it, and P is Energetics::power.
///
/// An error of the energy up to m g L ends no run: coarse but sound steps may have one
/// while the strand falls. MethodDissipation shows it, as far as its quadrature decides.
///
/// Checks every fourth step, all steps longer than 2 ms, and the last; each check costs
/// about two evaluations of the loads.
class Guard {
 public:
  /// `strands`: the strands of the system in order, empty for a mechanism; `first`: the
  /// number of the first in messages.
  Guard(System& system, std::vector<GuardedStrand> strands, std::size_t first = 0);

  /// Sets the state with which later states are compared.
  void start(double t, In q, In v);
  /// Call after every accepted step. False: breach() describes the violation.
  bool operator()(double t, In q, In v);
  /// Checks this state unconditionally.
  bool judge(double t, In q, In v);
  /// Goes on from the state after a teleport; the last one that was judged is the state
  /// before it.
  void teleported(double t, In q, In v);
  /// Returns the first violation; none if all states were possible.
  const std::optional<Breach>& breach() const { return breach_; }
  /// Returns the dissipation of the method until the last check. Meaningless where
  /// impulses or other strands act.
  MethodDissipation dissipation() const;
  /// Returns the energy that no work explains, at most until the last check.
  Excess excess() const { return account_.excess(); }

  /// All data gathered since start(); recall() lets another guard of an identically
  /// constructed system continue from there.
  static constexpr std::size_t remembered =  // numbers
      EnergyAccount::remembered + DissipationMeter::remembered + 3;
  /// Numbers of a guard.
  using Memory = std::array<double, remembered>;
  /// Returns all data gathered since start().
  Memory memory() const;
  /// Restores what memory() returned at time t and these places.
  void recall(In memory, double t, In q);

 private:
  /// Work of natural strains since the last check, J.
  struct Natural {
    double put_in = 0, work = 0, uncertain = 0;
  };
  /// Energy of the strands and its rate, without the bodies that they drive.
  struct Seen {
    Energy energy;
    double power = 0, to_bodies = 0;  // W; to_bodies: into the bodies
  };
  Seen look(double t, In q, In v);
  EnergyMeasure measure(double t, In q, In v, const Seen& seen);
  double power_of(double t, In q, In v);
  void remember(double t, In q);
  void gather_natural(double t, In q);
  double sampled(double power, double t, In q);
  Points points_of(const GuardedStrand& strand, std::size_t first);
  void move_with(double t, const GuardedStrand& strand, const Points& p,
                 std::size_t first, EnergyMeasure& now);
  double slack(double t, In q, In v, const EnergyMeasure& begin);
  bool stretched(double t, In q);
  bool gained(double t, const EnergyMeasure& now);
  bool too_fast(double t);
  std::string fastest() const;
  std::string place(std::size_t point, std::string_view what) const;
  bool broken(Breach::Kind kind, std::string what, std::string where, double t);

  System& system_;
  Energetics* energetics_;
  MaterialPoints* points_;
  std::vector<GuardedStrand> strands_;
  std::size_t first_;
  std::vector<int> before_;                     // each point along its strand, -1: none
  std::vector<double> x_, u_, tangent_, load_;  // (3 points); u_: relative to the frame
  SupportForces* supports_;                     // null: none
  DrivenBodies* bodies_;                        // null: none
  bool natural_moves_;                          // natural strains do
  Natural natural_;
  double t_before_ = 0;           // s, at the last step, if natural strains move
  std::vector<double> q_before_;  // places at that time
  int steps_ = 0;                 // since judged
  EnergyAccount account_;
  EnergyMeasure judged_;  // last
  DissipationMeter meter_;
  std::optional<Breach> breach_;
};

/// Checks the end of a run watched by `guard`; a breach makes the run fail.
void conclude(Guard& guard, std::string_view integrator, const Options& options,
              Simulation& run);

/// simulate() with `guard`; a breach makes the run fail.
Simulation simulate_guarded(Guard& guard, std::string_view integrator, System& system,
                            const Options& options, const State& start, double t_end,
                            const Observer& each_step = {});

}  // namespace tress::simulation
