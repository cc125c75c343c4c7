#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/run/energy_account.h"
#include "simulation/run/guarded_strand.h"
#include "simulation/run/simulation.h"

namespace tress::simulation {

/// A physically impossible state found by a guard.
struct Breach {
  enum class Kind { not_finite, stretch, speed, energy };
  Kind kind;
  std::string what;   // "a piece is stretched by 6.6 of its length (at most 0.5)"
  std::string where;  // "strand 0, element 7"; empty: the system as a whole
  double t;           // s

  std::string message() const;
};

/// Suggests what to try instead of this method at this step (s); `limit`: the bound that
/// ended the run, if any.
std::string remedy(std::string_view integrator, const Options& options,
                   Limit limit = Limit::none);

/// Checks one system for physically impossible states, so that no run ends "ok" with
/// invalid results: numbers that are not finite; a segment stretched or compressed by
/// more than half of its length; more energy than the initial energy plus the work done;
/// a point faster than that energy permits.
///
/// Energy: in a frame that moves with the clamp, the clamp does no work. With x the
/// position and v the velocity of a point of mass m, w = V + omega x r that of the frame
/// there, u = v - w, f the loads of all effects, P the power (in the world's frame) of
/// their non-potential part, V_p the potential of the rest, and a_w = A + alpha x r +
/// omega x (omega x r) (the Coriolis term does no work),
///
///     E = sum m u^2/2 + V_p,   dE/dt <= P - sum (f.w + m a_w.u),
///
/// where internal friction only decreases E. The work W is the sum of the positive parts
/// of the right-hand side, taking the larger of the two ends of each interval. A motion
/// satisfies
///
///     E <= E(0) + m g L + E_0/10 + W + largest sum m w^2/2:
///
/// m g L is the energy gained by hanging down; a tenth of E_0, the initial kinetic and
/// elastic energy, allows for the error of coarse but sound steps; the last term allows
/// for sums over lumped masses. A root at rest has w = 0. Mechanisms have no m g L: their
/// typical kinetic energy (System::scale) replaces it, and P is Energetics::power.
///
/// Speed: E minus the lowest potential so far bounds the kinetic energy. If a tenth of
/// the strand has all of it and turns about its own start, its tip moves at sqrt(30)
/// times the root mean square speed.
///
/// An error of the energy up to m g L ends no run: coarse but sound steps may have one
/// while the strand falls. EnergyAccount, which is exact up to the trapezoidal rule,
/// shows it.
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
  const std::optional<Breach>& breach() const { return breach_; }
  /// Until the last check. Without meaning where impulses or other strands act.
  EnergyAccount account() const { return meter_.account(); }

  /// All data gathered since start(); recall() lets another guard of an identically
  /// constructed system continue from there.
  static constexpr std::size_t remembered = 8 + EnergyMeter::remembered;  // numbers
  using Memory = std::array<double, remembered>;
  Memory memory() const;
  void recall(In memory);

 private:
  struct Measure {
    double kinetic = 0, potential = 0;  // J, in the moving frame
    double power = 0;                   // W, into it
    double frame = 0;                   // J, of the frame's own motion
  };
  /// Data gathered so far.
  struct Record {
    double t = 0, energy = 0, slack = 0;  // at the start
    double seen = 0, power = 0;           // when last judged
    double work = 0, frame = 0, lowest = 0;
  };

  Measure measure(double t, In q, In v, const Energy& energy);
  Points points_of(const GuardedStrand& strand, std::size_t first);
  void move_with(double t, const GuardedStrand& strand, const Points& p,
                 std::size_t first, Measure& now);
  double slack(double t, In q, In v, const Measure& begin);
  void gather(double t, const Measure& now);
  bool stretched(double t, In q);
  bool gained(double t, const Measure& now);
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
  int steps_ = 0;                               // since judged
  Record record_;
  EnergyMeter meter_;
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
