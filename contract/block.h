#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "contract/weights.h"

/// Contract between models and integrators for many strands at once. A block holds W
/// strands of equal resolution, one in each of W lanes. Entry k of lane l lies at [k W +
/// l], in memory of contract/lane_vector.h. Every call acts on all lanes and returns a
/// result for each; lanes do not mix. Numbers are in units of the model in which
/// earth_gravity is 1. Times named "(s)" are in seconds.
namespace tress {

/// A set of lanes: bit l is lane l.
using Lanes = std::uint32_t;

/// A strand's block and lane.
struct LanePlace {
  std::size_t block;  // index of the block
  int lane;           // index of the lane, below Block::lanes()
};

/// Data of a model's strands, in blocks, other than coordinates and rates: material, rest
/// shape, root, and data that steps change, such as reference frames. Both sides of a
/// copy must be memories of one model.
class StrandMemory {
 public:
  virtual ~StrandMemory() = default;

  /// Returns the number of blocks.
  virtual std::size_t blocks() const = 0;
  /// Allocates memory for a number of blocks, so that resize() up to there does not.
  virtual void reserve(std::size_t blocks) = 0;
  /// Changes the number of blocks.
  virtual void resize(std::size_t blocks) = 0;
  /// Returns the size of all data, bytes.
  virtual std::size_t bytes() const = 0;

  /// Copies all data of one strand.
  virtual void copy(const StrandMemory& from, LanePlace of, LanePlace to) = 0;
  /// Copies all data of a block, lane by lane.
  virtual void copy_block(const StrandMemory& from, std::size_t of, std::size_t to) = 0;
  /// Copies only the data that steps change.
  virtual void copy_changed(const StrandMemory& from, LanePlace of, LanePlace to) = 0;

  /// Returns how many numbers keep() writes and recall() reads for one strand.
  virtual std::size_t kept() const = 0;
  /// Writes the data of a strand that steps change, kept() numbers.
  virtual void keep(LanePlace of, double* to) const = 0;
  /// Restores the data that keep() wrote.
  virtual void recall(LanePlace of, const double* from) = 0;

  /// Length of a strand along its elements.
  virtual double length(LanePlace of) const = 0;
};

/// Times at which roots have a position: `start` of a step, a `stage`, and its `end`.
enum class Instant { start, stage, end };

/// The equations of a block of strands, r(t, q, v, a) = 0, with working memory of one
/// thread. N: double or float.
template <class N>
class Block {
 public:
  virtual ~Block() = default;

  virtual int lanes() const = 0;             // W
  virtual std::size_t unknowns() const = 0;  // of a strand
  virtual std::size_t points() const = 0;    // the root and the tips of elements
  virtual double time_unit() const = 0;      // s
  /// Newton's tolerance over that of a step's error.
  virtual double newton_part() const = 0;
  /// Returns an empty memory for strands of this model.
  virtual std::unique_ptr<StrandMemory> memory() const = 0;

  /// The block that the calls below are about; the memory must outlive them.
  virtual void work_on(StrandMemory& of, std::size_t block) = 0;
  /// Times (s) of the ends of a step, and of a stage.
  virtual void set_step(double from, double to) = 0;
  /// Sets the time (s) of the stage that the next calls are about.
  virtual void set_stage(double t) = 0;

  /// Reference frames for a step from there: returns the lanes with new ones, whose
  /// earlier accelerations mean nothing then.
  virtual Lanes renew(Instant at, N* q, N* v) = 0;
  /// q_bar = q + h v from the start of the step on, for roots that move as they do.
  virtual void predict(Instant to, double h, const N* q, const N* v, N* q_bar) const = 0;
  /// Sets the roots and loads of the following newton() and again() calls. Loads that are
  /// found once per stage are evaluated at (q, v). The stage has gamma h = `h` (s).
  virtual void meet(Instant at, double h, const N* q, const N* v) = 0;
  /// Makes the second-order terms of these lanes use the stresses of q in the next
  /// newton(). After each correction they use the stresses that the correction found
  /// (StressForm).
  virtual void take_stresses(const N* q, Lanes which) = 0;
  /// correction = S(w)^-1 r, and its size in each lane (W): the largest change of q or v
  /// over their typical sizes.
  virtual void newton(Weights w, const N* q, const N* v, const N* a, N* correction,
                      N* size) = 0;
  /// Computes a correction as newton() does, with the matrix of the last newton().
  virtual void again(Weights w, const N* q, const N* v, const N* a, N* correction,
                     N* size) = 0;
  /// Size of corrections that are rounding errors.
  virtual double resolved(Weights w, int lane) const = 0;
  /// Size of dq over typical coordinates, per lane.
  virtual void coordinate_size(const N* dq, N* size) const = 0;
  /// Points as seen from the head's position and their velocities, 3 entries each.
  virtual void positions(Instant at, const N* q, N* x) const = 0;
  /// Computes the velocities of the points, 3 entries each.
  virtual void velocities(Instant at, const N* q, const N* v, N* u) const = 0;
};

}  // namespace tress
