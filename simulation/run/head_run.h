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

  /// From t to t + h (s). Methods that iterate get blocks by the dozen, so that their
  /// lanes find strands to go on with.
  void step(double t, double h);
  /// Root and tips of elements (m) of every strand, strand after strand.
  void positions(double t, std::vector<double>& x);
  const Head& head() const { return *head_; }
  /// Newton's iterations of all steps so far.
  HeadWork work() const;

 private:
  /// use(first, last, scratch) for the blocks of each part.
  template <class Use>
  void share(Use use);

  std::unique_ptr<Head> head_;
  Crew crew_;
  std::vector<std::unique_ptr<Head::Scratch>> scratch_;  // of parts of the head
};

}  // namespace tress::simulation
