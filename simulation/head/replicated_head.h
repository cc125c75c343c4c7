#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/head/head_losses.h"
#include "simulation/head/head_guard.h"
#include "simulation/run/strand_maker.h"

namespace tress::simulation {

/// Batch whose strands are systems of their own, each with the integrator and guard of a
/// single strand. Supports every model of strands, plug-ins included, with every
/// integrator, effect and option. A block is one strand. Numbers have double precision.
///
/// A strand takes the steps that it takes as a single strand of a World. It is
/// bit-identical alone and with others if they do not touch. Memory is that of systems:
/// see bytes(). Integrators that remember earlier steps restart at recall(), as World
/// does.
class ReplicatedHead final : public models::Head {
 public:
  /// Constructs a batch of strands with `elements` elements each; keeps no reference to
  /// the scene.
  ReplicatedHead(const Scene& scene, int elements);

  void reserve(std::size_t strands) override { strands_.reserve(strands); }
  /// The calls of the base class too.
  using Head::add;
  void add(const Strand& strand, Effects own) override {
    add({strand, std::move(own)}, strands_.size());
  }
  /// `number`: in messages. Throws InputError on other numbers of elements, and on a
  /// model without material points at their ends.
  void add(const StrandToMake& strand, std::size_t number);
  /// Judges strands by the guards that they have, which also judge every step; reads the
  /// potentials of effects where the models have them act. Must not outlive this.
  std::unique_ptr<HeadGuard> guard();

  /// Returns the number of strands.
  std::size_t strands() const override { return strands_.size(); }
  /// Returns the number of strands: each is a block.
  std::size_t blocks() const override { return strands_.size(); }
  std::size_t bytes() const override { return bytes_; }
  /// Returns memory for the calls of one thread.
  std::unique_ptr<Scratch> scratch() const override;
  /// Advances to t + h, in the number of steps that the integrator needs.
  void step(std::size_t block, double t, double h, Scratch& scratch) override;
  std::size_t blocks_at_once() const override { return 1; }
  /// Returns true if the strand has failed.
  bool lost(std::size_t strand) const override { return strands_[strand].run.stays(); }
  std::vector<models::HeadLoss> losses(std::size_t known) const override {
    return losses_.after(known);
  }
  void lose(std::size_t strand) override;

  std::size_t numbers() const override { return 3 * (elements_ + 1); }
  /// Returns 1 for every block.
  std::size_t strands_of(std::size_t /*block*/) const override { return 1; }
  /// Computes root and tips of a strand, m.
  void positions(std::size_t block, double t, std::span<double> x) const override;
  void motion(std::size_t block, double t, std::span<double> x,
              std::span<double> v) const override;
  void ahead(std::size_t block, double t, double h, std::span<double> x,
             std::span<double> bulge) const override;
  void state(std::size_t strand, std::span<double> q, std::span<double> v) const override;
  void energies(std::size_t block, double t,
                std::span<models::HeadEnergy> each) const override;

  std::size_t kept() const override;
  std::size_t kept_of_state() const override { return 2 * coordinates_; }
  /// Writes the state of a strand.
  void keep(std::size_t block, std::span<double> x) const override;
  /// Restores what keep() wrote; integrators start again.
  void recall(std::size_t block, std::span<const double> x) override;

 private:
  class Judge;
  struct OfStrand {
    SteppedSystem run;
    double mass = 0;                         // kg
    std::vector<double> lengths;             // m, of elements
    std::string failure = {}, verdict = {};  // of its step, of Judge; empty: none
    bool known = false;                      // it is among losses_, or was lost before
  };

  /// Reports a strand that stays, in the step from t to t + h.
  void report(std::size_t strand, double t, double h);

  StrandMaker maker_;
  std::size_t elements_;
  bool touching_;                             // strands act on each other
  std::size_t coordinates_ = 0, memory_ = 0;  // numbers of a strand
  std::size_t bytes_ = 0;
  std::vector<OfStrand> strands_;
  models::HeadLosses losses_;
};

}  // namespace tress::simulation
