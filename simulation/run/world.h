#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "models/effects/strand_interaction.h"
#include "models/groom/coupled_strands.h"
#include "simulation/run/crew.h"
#include "simulation/run/guard.h"
#include "simulation/run/metered.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// State of a scene between two steps. Worlds of the same scene that were built and given
/// the same snapshot continue alike, bit by bit.
struct Snapshot {
  struct OfStrand {
    std::vector<double> q, v, memory;  // memory: of System::accept
  };
  double t = 0;  // s
  std::vector<OfStrand> strands;
  std::vector<double> guards;  // what they have gathered; none: they start here
};

/// J, of all strands; `elastic` is what no effect has, of a mechanism all potential.
struct Energies {
  double kinetic = 0, elastic = 0;
  std::vector<double> effects;  // in the scene's order
};

/// A scene built: systems and integrators of its strands, its effects, and what couples
/// strands. Effects that the scene does not name are not built.
///
/// Strands that touch exchange their places between steps (coupling = lagged): during a
/// step each sees the others where they were at its start, so strands run on several
/// threads with the same result. With coupling = monolithic they are one system. Strands
/// that are cut alike run four at a time where the model can (ModelEntry::on_strands).
class World {
 public:
  /// Throws InputError where model, strand and effects do not fit together.
  explicit World(const Scene& scene, int threads = 1);

  void restore(const Snapshot& snapshot);
  Snapshot snapshot() const;

  /// Advances all strands to t_end. A step of a strand that has no solution is taken in
  /// 2, 4 ... 64 shorter ones, then the scene's step goes on: a hundred times for each
  /// strand, beyond which the step is too long for the scene. stats().rejected counts
  /// every try that failed. Not ok: failure() says what happened where and when.
  Status advance(double t_end);
  double time() const { return t_; }
  const std::string& failure() const { return failure_; }
  /// What a guard found, null while all is well.
  const Breach* breach() const;
  /// Largest of all strands so far; 0 where the method has none (ErrorIndicator).
  double error_indicator() const;
  /// What all strands have done since restore(), and what that cost as total_work()
  /// counts it.
  Stats stats() const;
  double work() const;

  std::size_t strands() const { return points_.size(); }
  std::size_t systems() const { return bodies_.size(); }
  /// As the systems count it.
  Energies energies();
  double stretch();  // largest |length/rest - 1|, 0 where models do not say
  /// Null where strands do not touch.
  const StrandInteraction* interaction() const { return interaction_.get(); }
  /// The point that point i hangs on, -1: none.
  const std::vector<int>& before() const { return before_; }

  /// Material points of all strands, strand after strand; read once after each advance.
  const std::vector<int>& points() const { return points_; }
  const std::vector<double>& positions();   // (3 points)
  const std::vector<double>& velocities();  // (3 points)

 private:
  /// One strand, or several that are advanced as one system.
  struct Body {
    std::unique_ptr<System> system;
    std::unique_ptr<Integrator> integrator;
    std::size_t first = 0;  // strand
    /// Sizes of each strand's coordinates and memory.
    std::vector<std::size_t> coordinates, memory;
    std::size_t first_point = 0, points = 0;
    /// Effects of its first strand, of the second ...
    std::vector<std::shared_ptr<const Metered>> meters;
    CoupledStrands* coupled = nullptr;  // the system, where it is one
    std::optional<Guard> guard;
    Status status = Status::ok;
    // The last state that a step led to.
    double t = 0;
    std::vector<double> q, v;
    // Of what ran until the integrator's last start.
    Stats before;
    Stats stats() const;  // with that
    double indicator = 0;
    int shortened = 0;     // steps that were taken in shorter ones, since restore()
    bool gave_up = false;  // shorter steps did not help

    bool breached() const { return guard && guard->breach(); }
    void keep(double at, In new_q, In new_v);
    Observer observer();
  };

  void add(std::unique_ptr<System> system, std::size_t strands);
  void guard(std::vector<GuardedStrand> strands);
  std::vector<GuardedStrand> guarded(const Scene& scene, std::size_t first,
                                     std::size_t count, const Effects& shared) const;
  void build_strands(const Scene& scene);
  void build_coupled(const Scene& scene);
  void ready(const Scene& scene);
  void advance(Body& body, double t, bool last);
  Status shorter_steps(Body& body, double end);
  std::string failure_of(const Body& body) const;
  /// Coordinates of all points at the present state.
  struct Read {
    std::vector<double> values;  // (3 points)
    bool done = false;
  };
  void look(const std::function<void(Body&, Out)>& read, Read& to);
  void exchange();

  const IntegratorEntry& integrator_;
  Options options_;
  std::size_t effects_;
  std::unique_ptr<StrandInteraction> interaction_;
  std::vector<Body> bodies_;
  std::vector<int> points_, before_;
  Read x_, u_;
  double t_ = 0;
  std::string failure_;
  Crew crew_;
};

}  // namespace tress::simulation
