#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "contract/weights.h"

/// The contract between models and integrators for many strands at once. A block is W
/// strands of equal resolution, a strand in each of W lanes: entry k of lane l lies at
/// [k W + l], in memory of contract/lane_vector.h. Every call is for all lanes and says
/// of each what came of it; lanes do not mix. Numbers are in units of the model's own in
/// which earth_gravity is 1, times in s where they are named so.
namespace tress {

/// A set of lanes: bit l is lane l.
using Lanes = std::uint32_t;

/// A strand's block and lane.
struct LanePlace {
  std::size_t block;
  int lane;
};

/// What a model knows of strands beyond coordinates and rates, in blocks: material, rest
/// shape and root, and what steps change, such as reference frames. Copies are between
/// memories of one model.
class StrandMemory {
 public:
  virtual ~StrandMemory() = default;

  virtual std::size_t blocks() const = 0;
  virtual void reserve(std::size_t blocks) = 0;
  virtual void resize(std::size_t blocks) = 0;
  virtual std::size_t bytes() const = 0;

  virtual void copy(const StrandMemory& from, LanePlace of, LanePlace to) = 0;
  virtual void copy_block(const StrandMemory& from, std::size_t of, std::size_t to) = 0;
  /// What steps change alone.
  virtual void copy_changed(const StrandMemory& from, LanePlace of, LanePlace to) = 0;

  /// The same as `kept` numbers of a strand.
  virtual std::size_t kept() const = 0;
  virtual void keep(LanePlace of, double* to) const = 0;
  virtual void recall(LanePlace of, const double* from) = 0;

  /// Length of a strand along its elements.
  virtual double length(LanePlace of) const = 0;
};

/// Times at which roots have a place: the start of a step, a stage of it, and its end.
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
  virtual std::unique_ptr<StrandMemory> memory() const = 0;

  /// The block that the calls below are about; the memory must outlive them.
  virtual void work_on(StrandMemory& of, std::size_t block) = 0;
  /// Times (s) of the ends of a step, and of a stage.
  virtual void set_step(double from, double to) = 0;
  virtual void set_stage(double t) = 0;

  /// Reference frames for a step from there: returns the lanes with new ones, whose
  /// earlier accelerations mean nothing then.
  virtual Lanes renew(Instant at, N* q, N* v) = 0;
  /// q_bar = q + h v from the start of the step on, for roots that move as they do.
  virtual void predict(Instant to, double h, const N* q, const N* v, N* q_bar) const = 0;
  /// Roots and loads there are those of newton() and again() from now on: what acts on
  /// the strands of a stage of gamma h = `h` (s), as far as it is found once, at (q, v).
  virtual void meet(Instant at, double h, const N* q, const N* v) = 0;
  /// In these lanes terms of second order of the next newton() have the stresses of q,
  /// then those that each correction has found (StressForm).
  virtual void take_stresses(const N* q, Lanes which) = 0;
  /// correction = S(w)^-1 r, and its size in each lane (W): the largest change of q or v
  /// over their typical sizes.
  virtual void newton(Weights w, const N* q, const N* v, const N* a, N* correction,
                      N* size) = 0;
  /// The same with the matrix of the last newton().
  virtual void again(Weights w, const N* q, const N* v, const N* a, N* correction,
                     N* size) = 0;
  /// Size of corrections that are rounding errors.
  virtual double resolved(Weights w, int lane) const = 0;
  /// Size of dq over typical coordinates, per lane.
  virtual void coordinate_size(const N* dq, N* size) const = 0;
  /// Points as seen from the head's position and their velocities, 3 entries each.
  virtual void positions(Instant at, const N* q, N* x) const = 0;
  virtual void velocities(Instant at, const N* q, const N* v, N* u) const = 0;
};

}  // namespace tress
