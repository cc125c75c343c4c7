#pragma once

#include <memory>

#include "contract/block.h"
#include "contract/lane_vector.h"
#include "integrators/block/block_method.h"

namespace tress::integrators {

/// Start of Newton's iteration: the `guess`, `zero` acceleration, or the acceleration
/// that ends all motion (`standstill`).
enum class NewtonStart { guess, zero, standstill };

/// The equations of a stage (BlockStage) of the strands in the lanes of a Block.
template <class N>
class BlockWork {
 public:
  /// `block` and `method` must outlive it.
  BlockWork(Block<N>& block, const BlockMethod& method);

  /// Returns the equations of the block.
  Block<N>& block() { return block_; }
  static constexpr std::size_t now = 0, renewed = 1;  // blocks of `strands`
  /// The strands in lanes, and the same strands as a step has changed them.
  std::unique_ptr<StrandMemory> strands;

  // At t_n what is known of the strands, as far as the method keeps it: q, v, the
  // acceleration a_0 of the last step and the one before, a_1; the lengths of both steps,
  // 0: none. `after`: once the stage is solved.
  LaneVector<N> state, after;       // state at t_n, and after the step
  LaneVector<N> q_bar, q, v, step;  // q, v: at a
  LaneVector<N> size;               // of the step, per lane
  Weights weights;  // Weights of the unknowns in the equations of the stage.

  /// Returns the number of lanes.
  int lanes() const { return lanes_; }
  std::size_t numbers() const { return numbers_; }  // of a vector: unknowns times lanes
  /// Returns the accelerations, the unknowns of the stage.
  N* a() { return a_.data(); }
  /// Lengths of the last two steps, of the strands at `from`.
  N* lengths(LaneVector<N>& from) const { return from.data() + 4 * numbers_; }

  /// Sets the equations of a stage of a step of h, and computes the stage's loads for
  /// gamma h = `loads` (s). Lanes in `starts` need a guess of a and start from `from`;
  /// the other lanes continue.
  void begin(std::size_t stage, double h, double loads, Lanes starts, NewtonStart from);
  /// Writes the state at the end of the stage to `after`.
  void end();
  /// After end() of the last stage, of the method's estimate.
  void difference(N* dq, N* dv) const;

  /// The size of corrections that are rounding errors of places.
  double resolved(int lane) const { return block_.resolved(weights, lane); }
  /// step = S^-1 r, and `size`. Where corrections are `whole`, the stresses that the last
  /// one has found serve this one; at first those at the start of the step.
  void newton(bool whole);
  /// Computes step and size as newton() does, with the matrix of the last newton().
  void again();
  /// Subtracts `by` from the acceleration a.
  void move(const N* by);
  /// Subtracts the fraction `part` (one per lane) of `by` from the acceleration a.
  void move(const N* part, const N* by);

 private:
  void guess(Lanes starts);
  void start_from(NewtonStart from, Lanes starts);
  void place();

  Block<N>& block_;
  const BlockMethod& method_;
  int lanes_;
  std::size_t size_, numbers_, stage_ = 0;
  double h_ = 0;
  LaneVector<N> v_bar_, a_, guess_;
};

extern template class BlockWork<double>;
extern template class BlockWork<float>;

}  // namespace tress::integrators
