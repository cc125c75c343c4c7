#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "contract/layers.h"

namespace tress::simulation {

/// The processes that work on one head together. Every one has all strands and steps its
/// own blocks; all must make the same calls in the same order.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int rank() const = 0;  // of this process, from 0
  virtual int size() const = 0;
  bool first() const { return rank() == 0; }

  /// x: the ranks' parts one after the other, sizes[r] numbers of rank r. Each knows its
  /// own part, afterwards all know all.
  virtual void share(std::span<double> x, std::span<const std::size_t> sizes) = 0;
  /// The largest of what the ranks give.
  virtual double largest(double x) = 0;
};

/// The ranks of the job that this process belongs to: of mpirun, if it was started by
/// one, else this process alone. Throws InputError under an mpirun of which this build
/// knows nothing. Signals that threads of a program must not take have to be blocked
/// before: MPI starts threads of its own.
std::unique_ptr<Ranks> ranks_of_job();

/// Whether mpirun, or a scheduler in its place, has started this process.
bool started_as_rank();

/// One process.
class OneRank final : public Ranks {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  void share(std::span<double>, std::span<const std::size_t>) override {}
  double largest(double x) override { return x; }
};

}  // namespace tress::simulation
