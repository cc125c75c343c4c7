#pragma once

#include <memory>
#include <vector>

#include "models/head/head.h"
#include "simulation/run/crew.h"

namespace tress::simulation {

/// A head that is advanced and read by a crew, each worker with its share of the blocks.
class HeadRun {
 public:
  HeadRun(std::unique_ptr<Head> head, int threads);

  /// From t to t + h (s).
  void step(double t, double h);
  /// Strands that the last step lost, in their order.
  const std::vector<std::size_t>& lost() const { return lost_; }
  /// Root and tips of elements (m) of every strand, strand after strand.
  void positions(double t, std::vector<double>& x);
  /// Of every strand.
  void energies(double t, std::vector<models::HeadEnergy>& each);
  const Head& head() const { return *head_; }
  /// For whoever sets its state.
  Head& head() { return *head_; }
  Crew& crew() { return crew_; }

 private:
  template <class Use>
  void share(Use use);

  std::unique_ptr<Head> head_;
  Crew crew_;
  std::vector<std::unique_ptr<Head::Scratch>> scratch_;  // of parts of the head
  std::vector<std::vector<std::size_t>> lost_of_;        // of parts
  std::vector<std::size_t> lost_;
};

}  // namespace tress::simulation
