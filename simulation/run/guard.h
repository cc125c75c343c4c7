#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/run/guarded_strand.h"
#include "simulation/run/simulation.h"

namespace tress::simulation {

/// What no motion of the system does, as a guard found it.
struct Breach {
  enum class Kind { not_finite, stretch, speed, energy };
  Kind kind;
  std::string what;   // "a piece is stretched by 6.6 of its length (at most 0.5)"
  std::string where;  // "strand 0, element 7"; empty: the system as a whole
  double t;           // s

  std::string message() const;
};

/// What to try instead of this method at this step (s), in words; `limit`: the bound that
/// ended the run, if one did.
std::string remedy(std::string_view integrator, const Options& options,
                   Limit limit = Limit::none);

/// Watches one system for what physics rules out, so that no run ends "ok" with nonsense
/// in it: numbers that are not finite; a piece stretched or compressed by more than half
/// of its length; more energy than there was and has been put in; a point faster than all
/// of that energy can make it.
///
/// Energy: seen from a frame that moves as the clamp does the clamp does no work. There,
/// with x the place, v the velocity of a point of mass m, w = V + omega x r that of the
/// frame there, u = v - w, f the loads of all effects, P the power (in the world's frame)
/// of the part of them that has no potential, V_p the potential of all that has one, and
/// a_w = A + alpha x r + omega x (omega x r), whose Coriolis companion does no work,
///
///     E = sum m u^2/2 + V_p,   dE/dt <= P - sum (f.w + m a_w.u),
///
/// internal friction making it less. Positive parts of the right-hand side, the larger of
/// those at both ends of an interval, add up to the work W. A motion keeps
///
///     E <= E(0) + m g L + E_0/10 + W + largest sum m w^2/2:
///
/// m g L is what hanging down gives, a tenth of E_0, the kinetic and elastic energy of
/// the start, is what a coarse but sound step makes of it, and the last makes up for sums
/// over lumped masses. A root at rest has w = 0. Mechanisms have no m g L: their typical
/// kinetic energy (System::scale) stands for it, P is Energetics::power.
///
/// Speed: E less the lowest potential met is all that can move. A tenth of the strand
/// that has all of it and turns about its own start moves its tip at sqrt(30) times the
/// root mean square speed.
///
/// Every fourth step is judged, all that are longer than 2 ms, and the last; each costs
/// about an evaluation of the loads.
class Guard {
 public:
  /// `strands`: those of the system in their order, none for a mechanism; `first`: the
  /// number of the first in messages.
  Guard(System& system, std::vector<GuardedStrand> strands, std::size_t first = 0);

  /// What comes is compared with this state.
  void start(double t, In q, In v);
  /// Of an accepted step. False: breach() says what is wrong.
  bool operator()(double t, In q, In v);
  /// The same, whatever was judged before.
  bool judge(double t, In q, In v);
  const std::optional<Breach>& breach() const { return breach_; }

  /// All that start() and judging have gathered; recall() lets another guard of a system
  /// made alike go on from there.
  static constexpr std::size_t remembered = 8;  // numbers
  using Memory = std::array<double, remembered>;
  Memory memory() const;
  void recall(In memory);

 private:
  struct Measure {
    double kinetic = 0, potential = 0;  // J, seen from the frame
    double power = 0;                   // W, into it
    double frame = 0;                   // J, of the frame's own motion
  };
  /// What has been gathered so far.
  struct Record {
    double t = 0, energy = 0, slack = 0;  // at the start
    double seen = 0, power = 0;           // when last judged
    double work = 0, frame = 0, lowest = 0;
  };

  Measure measure(double t, In q, In v);
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
  std::vector<double> x_, u_, tangent_, load_;  // (3 points); u_: relative to the frame
  int steps_ = 0;                               // since judged
  Record record_;
  std::optional<Breach> breach_;
};

/// After a run that `guard` has watched: judges its end; a breach is its failure.
void conclude(Guard& guard, std::string_view integrator, const Options& options,
              Simulation& run);

/// simulate(), watched; a breach is its failure.
Simulation simulate_guarded(Guard& guard, std::string_view integrator, System& system,
                            const Options& options, const State& start, double t_end,
                            const Observer& each_step = {});

}  // namespace tress::simulation
