#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "integrators/control/impulse_response.h"
#include "integrators/control/impulsive.h"
#include "models/effects/strand_friction.h"
#include "models/strand/strand.h"
#include "simulation/run/strand_coupling.h"

namespace tress::simulation {

/// Coupling of strands with exact contact, each or several advanced by a method of their
/// own. They first move without contact. Impulses at the end of the step then keep them
/// from passing through each other and through obstacles (StrandFriction).
class Rubbing final : public StrandCoupling {
 public:
  /// Obstacles are found among the effects. Throws InputError on strands with branches.
  Rubbing(const std::vector<Strand>& strands, const Parameters& rubs,
          const Effects& effects);
  /// The next strands, one or several as one system (StrandBlock), and the method that
  /// steps them; both must outlive this. Throws InputError if the method cannot go on
  /// after impulses.
  void add(System& strands, Integrator& method, const Options& options) override;

  /// Takes the positions of points before a step.
  void before_step(In x, const Loop& loop) override;
  /// Need not be called: if system k touched others in the last step, finds how it
  /// responds to forces.
  void prepare(std::size_t k, double h) override;
  Status after_step(double t, double h, In x, In u, const Loop& loop) override;
  std::span<const std::size_t> moved() const override { return friction_.touching(); }
  /// Returns what ended the last after_step(); empty if it ended well.
  std::string failure() const override { return failure_; }

  /// Returns the friction between strands.
  const StrandFriction& friction() const { return friction_; }
  /// Sweeps, and steps that ended before the law held, since restore().
  Stats stats() const override { return stats_; }
  std::vector<double> memory() const override { return friction_.memory(); }
  /// Restores the multipliers; starts without any if `memory` is empty.
  void restore(In memory) override;

 private:
  /// A strand and its response to forces.
  struct Responder {
    System* system;
    std::unique_ptr<ImpulseResponse> response;
    std::size_t group;
    std::size_t coordinate;  // the first one, of those of its group
    std::vector<double> v_before, blocks, placed;
    bool touches = false;            // others, in the last step
    std::optional<Status> prepared;  // whether its matrix is that of this step
    Status status = Status::ok;
  };
  /// Strands that one method steps, and their state after it and impulses.
  struct Group {
    Integrator* method;
    Impulsive* impulsive;
    std::size_t first, strands;  // first: strand
    std::vector<double> q, v;
    Status status = Status::ok;
  };
  using Some = std::span<const std::size_t>;  // strands
  Status each(Some strands, double t, const Loop& loop,
              const std::function<Status(std::size_t)>& act);
  static Status prepare(Responder& responder, double h);
  Status give_compliance(std::size_t k, double h);
  Status respond(std::size_t k, double t);
  Status go_on(double t, const Loop& loop);

  StrandFriction friction_;
  std::vector<Responder> responders_;  // by strand
  std::vector<Group> groups_;
  std::vector<double> x_before_;
  Stats stats_;
  std::string failure_;
};

}  // namespace tress::simulation
