#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contract/forms/driven_bodies.h"
#include "integrators/control/point_norm.h"
#include "integrators/control/rewindable.h"
#include "integrators/control/step_control.h"
#include "models/groom/coupled_strands.h"
#include "simulation/rest/held_shape.h"
#include "simulation/run/failed_strand.h"
#include "simulation/run/rubbing.h"
#include "simulation/run/strand_coupling.h"
#include "simulation/run/strand_maker.h"
#include "simulation/scene/scene.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {

/// State of a scene between two steps. New worlds of the same scene that are given the
/// same snapshot continue identically, bit by bit.
struct Snapshot {
  /// State of one strand.
  using OfStrand = SteppedSystem::State;
  double t = 0;                   // s
  std::vector<OfStrand> strands;  // states of all strands
  std::vector<double> guards;     // their Guards::memory(); empty: they start here
  std::vector<std::vector<double>> couplings;  // StrandCoupling::memory() of each
  std::vector<FailedStrand> lost;              // strands that have failed

  /// Adds the strands of one system: parts of q and v with these numbers of coordinates,
  /// and parts of its memory.
  void add(In q, In v, In memory, const std::vector<std::size_t>& coordinates,
           const std::vector<std::size_t>& memories);
};

/// Exchanges between strands whose intervals error control chose.
struct Exchanges {
  long accepted = 0, rejected = 0;  // numbers of intervals
  StepControl::Shortest shortest;   // interval; its cause may be a strand that failed
};
/// Adds the counts, and takes the shorter of the shortest intervals.
void add_exchanges(const Exchanges& from, Exchanges& to);

/// J, of all strands; `elastic` is the potential not due to effects, for a mechanism all.
struct Energies {
  double kinetic = 0, elastic = 0;  // energies, J
  std::vector<double> effects;      // of make_effects(), in the scene's order
};

/// Constructed scene: systems and integrators of its strands, its effects, and the
/// coupling of strands. Effects that the scene does not name are not built.
///
/// Strands that touch exchange their positions between steps (coupling = lagged). During
/// a step each sees the others at their positions at its start, so strands run on several
/// threads with the same result. With a tolerance every strand takes its own steps
/// between two exchanges. It then sees the others move as in the last pass. The intervals
/// are under the same error control (world_exchange.cpp). With coupling = monolithic they
/// are one system. Exact contact between them acts by impulses at the ends of steps
/// (Rubbing). Strands of equal discretisation run four at a time if the model supports it
/// (ModelEntry::on_strands). Where failed strands stay (Scene::failed_strands), each is a
/// system of its own.
class World {
 public:
  /// Constructs a scene. Throws InputError if model, strand and effects are incompatible.
  /// `held`: that of an earlier world of the same scene, recomputed if empty.
  explicit World(const Scene& scene, int threads = 1, std::vector<HeldShape> held = {});

  /// Continues from a snapshot.
  void restore(const Snapshot& snapshot);
  /// Returns the present state.
  Snapshot snapshot();

  /// Divides every fixed step from now on into this number of equal parts, whatever the
  /// frames and teleports at which steps end.
  void divide_steps(int parts);

  /// Advances all strands to t_end, as SteppedSystem. Not ok: failure() reports what
  /// happened, where and when. Where failed strands stay, always ok: see lost().
  Status advance(double t_end);
  /// Returns the time of the state, s.
  double time() const { return t_; }
  /// Returns what ended the last advance(); empty if it ended well.
  const std::string& failure() const { return failure_; }
  /// Strands that have failed and stay where they were at the start of their last
  /// advance(), in the order in which they did. Energies leave them out.
  const std::vector<FailedStrand>& lost() const { return lost_; }
  /// Returns true if the strand has failed and stays where it is.
  bool lost(std::size_t strand) const { return stay_ && bodies_[strand].stays(); }
  /// Returns the dissipation of all strands. Empty without guards, or where energy
  /// changes by other means than power: impulses of rigid contact and of friction between
  /// strands, other strands that move.
  std::optional<MethodDissipation> dissipation() const;
  /// Returns the energy that no work explains, of the system that uses most of its slack.
  Excess excess() const;
  /// Returns the reason why dissipation() is empty; empty: it is not.
  std::string no_dissipation() const;
  /// Returns the largest depth of a strand in a body since the last call, m. Looks at the
  /// ends of steps, and at the paths of strands that passed through a body. Watches from
  /// the first call on, which returns 0.
  double take_depth();
  /// Returns the first strand that passed through a body within a step since take_depth()
  /// was first called; none: no step did.
  std::optional<StrandPassage> passed() const;
  /// Why the motion of a strand was not smooth; empty: no such event was seen.
  std::string not_smooth() const;
  /// Returns the breach that a guard found, or null.
  const Breach* breach() const;
  /// Largest of all strands so far; 0 if the method has none (ErrorIndicator).
  double error_indicator() const;
  /// Work of all strands since restore(), and its cost as defined by total_work().
  Stats stats() const;
  /// Returns the cost of stats() as defined by total_work().
  double work() const;
  /// Steps of each strand since restore(); strands of one system share theirs.
  std::vector<long> steps() const;
  /// Since restore(); none where exchanges follow the step.
  const Exchanges& exchanges() const { return exchanges_; }

  /// Returns the held shape of each strand; empty unless the scene's rest is inverse.
  const std::vector<HeldShape>& held() const { return held_; }

  /// Loads of supports on strands, (3 supports) each, strand after strand, then those of
  /// joints on their ends b. NaN of strands that have failed.
  struct SupportLoads {
    std::vector<double> forces;   // N
    std::vector<double> moments;  // N m, about the held points
    std::vector<double> places;   // of supports alone, m
  };
  /// Returns the loads of all supports and joints.
  SupportLoads support_loads();
  /// Returns the motions of bodies that strands turn.
  std::vector<DrivenBodies::Motion> body_motions() const;
  /// Returns the strands that began away from their supports, in words.
  std::vector<std::string> supported_starts() const;

  /// Returns the number of strands.
  std::size_t strands() const { return points_.size(); }
  /// Returns the number of systems; several strands may be one.
  std::size_t systems() const { return bodies_.size(); }
  /// Returns the energies of the systems' Energetics.
  Energies energies();
  /// Returns the contact forces of effects on each strand, at the points where the models
  /// have them act, by strand; without those between strands.
  std::vector<ContactForce> contact_forces();
  double stretch();  // largest |length/rest - 1|, 0 if not available
  /// Returns the largest drive of friction after the last step, with bodies and between
  /// strands, m/s: ContactForm::drive().
  double drive() const;
  /// Returns the step of the method, s.
  double step() const { return maker_.options().step; }
  // Null if the scene names none.
  /// Returns the forces between strands that touch.
  const StrandInteraction* interaction() const { return interaction_; }
  /// Returns the control mesh of a wisp.
  const ControlMesh* mesh() const { return mesh_; }
  /// Returns the friction between strands.
  const StrandFriction* friction() const { return friction_; }
  /// The point that point i is attached to, -1: none.
  const std::vector<int>& before() const { return before_; }

  /// Material points of all strands, strand after strand; read once after each advance.
  const std::vector<int>& points() const { return points_; }
  const std::vector<double>& positions();   // (3 points)
  const std::vector<double>& velocities();  // (3 points)
  /// Shares work among the threads.
  Loop loop();

 private:
  /// One strand, or several that are advanced as one system.
  struct Body : SteppedSystem {
    explicit Body(SteppedSystem made) : SteppedSystem(std::move(made)) {}

    std::size_t first = 0;  // strand
    /// Sizes of each strand's coordinates and memory.
    std::vector<std::size_t> coordinates, memory;
    std::size_t first_point = 0, points = 0;
    CoupledStrands* coupled = nullptr;  // the system, where it is one
    // Where exchanges are under error control: the start of the interval.
    Rewindable* rewindable = nullptr;
    State marked;
    double marked_t = 0;
    Guards::Memory marked_guard;
    BodyDepth::Seen marked_depth;
    PointNorm norm;
    void mark();
    void rewind();
    /// Returns its points among those of all strands.
    In part(In all) const { return all.subspan(3 * first_point, 3 * points); }
  };

  /// `block`: the system, where its strands may differ; all of its memory is stored with
  /// the first.
  void add(SteppedSystem system, std::size_t strands, const StrandBlock* block = nullptr);
  Effects effects_between(std::size_t strand) const;
  void hold(const Scene& scene);
  void build_strands(const Scene& scene, const Parameters* between);
  void build_coupled(const Scene& scene, const Parameters& between);
  void ready(const Scene& scene);
  void advance(Body& body, double t, bool last) {
    body.advance(maker_.method(), maker_.options(), t, last);
  }
  std::string name_of(const Body& body) const;
  std::string failure_of(const Body& body) const;
  void watch_depth();
  std::string remedy_of(Limit limit) const;
  /// Coordinates of all points at the present state.
  struct Read {
    std::vector<double> values;  // (3 points)
    std::vector<char> done;      // of each body: that of the present state

    void forget() { std::ranges::fill(done, 0); }
    Out of(const Body& body) {
      return Out(values).subspan(3 * body.first_point, 3 * body.points);
    }
  };
  void look(const Read& known, void (World::*read)(std::size_t, double));
  /// Reads the positions of a body's points at t, unless they are known.
  void read_positions(std::size_t k, double t);
  void read_velocities(std::size_t k, double t);
  Status couple(double h);
  double next_teleport() const;
  Status teleport(double t);
  Status advance_between_teleports(double t_end);
  Status failed();
  void exchange();

  // With a tolerance, by intervals.
  struct Difference {
    double over = 0;  // of the threshold
    const Body* body = nullptr;
  };
  void start_control();
  Status advance_controlled(double t_end);
  Status next_interval(double t_end);
  bool pass(double begin, double end, const std::function<void(Body&)>& run);
  Difference difference(In y, In w);
  Status reject(const StepControl::Trial& failed, const Difference* found);

  const StrandMaker maker_;
  const bool stay_;  // failed strands do
  std::vector<std::unique_ptr<StrandCoupling>> couplings_;
  // Parts of couplings, or null.
  StrandInteraction* interaction_ = nullptr;
  ControlMesh* mesh_ = nullptr;
  const StrandFriction* friction_ = nullptr;
  std::vector<HeldShape> held_;
  int parts_ = 1;                       // of each interval between exchanges
  std::optional<StepControl> control_;  // of the exchanges, with a tolerance
  Exchanges exchanges_;
  std::vector<Body> bodies_;
  std::vector<int> points_, before_;
  Read x_, u_;
  double t_ = 0;
  std::string failure_;
  std::string overlap_;  // of strands at the start, in words
  bool depth_watched_ = false;
  std::vector<FailedStrand> lost_;
  Crew crew_;
};

}  // namespace tress::simulation
