#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/scenes/crew.h"
#include "experiments/scenes/scene.h"
#include "models/effects/strand_interaction.h"

namespace tress {

/// State of a scene between two steps. Worlds of the same scene that were built and given
/// the same snapshot continue alike, bit by bit.
struct Snapshot {
  struct OfStrand {
    std::vector<double> q, v, memory;  // memory: of System::accept
  };
  double t = 0;  // s
  std::vector<OfStrand> strands;
};

/// A scene built: a system and an integrator for every strand, its effects, and what
/// couples strands. Effects that the scene does not name are not built. Between steps
/// strands exchange their places; during a step each sees the others where they were at
/// its start, so strands run on several threads with the same result.
class World {
 public:
  /// Throws InputError where model, strand and effects do not fit together.
  explicit World(const Scene& scene, int threads = 1);

  void restore(const Snapshot& snapshot);
  Snapshot snapshot() const;

  /// Advances all strands to t_end. Not ok: failure() says what happened where and when.
  Status advance(double t_end);
  double time() const { return t_; }
  const std::string& failure() const { return failure_; }
  Stats stats() const;  // summed over strands

  std::size_t strands() const { return bodies_.size(); }
  System& system(std::size_t k) { return *bodies_[k].system; }
  In q(std::size_t k) const { return bodies_[k].integrator->q(); }
  In v(std::size_t k) const { return bodies_[k].integrator->v(); }
  /// Null where strands do not touch.
  const StrandInteraction* interaction() const { return interaction_.get(); }

  /// Material points of all strands, strand after strand.
  const std::vector<int>& points() const { return points_; }
  const std::vector<double>& positions();   // (3 points)
  const std::vector<double>& velocities();  // (3 points)

 private:
  struct Body {
    std::unique_ptr<System> system;
    std::unique_ptr<Integrator> integrator;
    std::size_t first_point = 0;
    Status status = Status::ok;
  };

  void look(const std::function<void(Body&, Out)>& read, std::vector<double>& to);
  void exchange();

  double step_;  // s, between two exchanges
  std::unique_ptr<StrandInteraction> interaction_;
  std::vector<Body> bodies_;
  std::vector<int> points_;
  std::vector<double> x_, u_;
  double t_ = 0;
  std::string failure_;
  Crew crew_;
};

/// The effects of a scene, made for one strand.
Effects make_effects(const Scene& scene);

}  // namespace tress
