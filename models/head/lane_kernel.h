#pragma once

#include <memory>
#include <span>
#include <variant>

#include "contract/block.h"
#include "contract/jacobian_choice.h"
#include "models/head/head.h"

namespace tress::models {

/// Model of strands in lanes: makes their memory and Blocks, and reads their states. q
/// and v are those of a block, in the block's units; all else is SI. `strands`: number of
/// lanes to read. Safe for several threads once all strands are added.
template <class N>
class LaneKernel {
 public:
  virtual ~LaneKernel() = default;

  /// Returns the number of lanes.
  virtual int lanes() const = 0;
  virtual std::size_t elements() const = 0;  // of a strand
  virtual std::size_t unknowns() const = 0;  // of a strand
  /// Returns an empty memory for strands.
  virtual std::unique_ptr<StrandMemory> memory() const = 0;
  /// Makes a block for one thread; the kernel must outlive it.
  virtual std::unique_ptr<Block<N>> block() const = 0;

  /// Throws InputError on a strand or effects that it cannot have, as Head::add(); else
  /// the strand counts from now on.
  virtual void admit(const Strand& strand, const Effects& own) = 0;
  /// Writes a strand that was admitted into a lane.
  virtual void describe(const Strand& strand, LanePlace to, StrandMemory& memory, N* q,
                        N* v) const = 0;

  /// Computes positions as Head::positions(); the next two as motion() and ahead().
  virtual void positions(const StrandMemory& memory, std::size_t block, double t,
                         const N* q, std::size_t strands, std::span<double> x) const = 0;
  /// Computes velocities as Head::motion().
  virtual void velocities(const StrandMemory& memory, std::size_t block, double t,
                          const N* q, const N* v, std::size_t strands,
                          std::span<double> u) const = 0;
  /// Predicts points as Head::ahead().
  virtual void ahead(const StrandMemory& memory, std::size_t block, double t, double h,
                     const N* q, const N* v, std::size_t strands, std::span<double> x,
                     std::span<double> bulge) const = 0;
  /// Computes coordinates and rates of a lane in SI units.
  virtual void state(int lane, const N* q, const N* v, std::span<double> in_q,
                     std::span<double> in_v) const = 0;
  /// Computes energies as Head::energies().
  virtual void energies(const StrandMemory& memory, std::size_t block, double t,
                        const N* q, const N* v, std::size_t strands,
                        std::span<HeadEnergy> each) const = 0;
};

/// Kernel of either number type.
using AnyLaneKernel =
    std::variant<std::unique_ptr<LaneKernel<double>>, std::unique_ptr<LaneKernel<float>>>;

/// Kernels of the models below, in the numbers of a pack; `stiff` serves methods of one
/// linear solve from zero acceleration, `exact` all others. They throw InputError if the
/// options or the pack make no sense.
///
/// Super-helices (models/head/exact/exact_kernel.h) and chains of rigid links, exact:
/// with gravity, linear drag and bodies.
AnyLaneKernel helix_lanes(const LaneOptions& options, const HeadPack& pack);
/// Makes a kernel of chains of rigid links.
AnyLaneKernel chain_lanes(const LaneOptions& options, const HeadPack& pack);
/// Makes a kernel of super-clothoids.
AnyLaneKernel clothoid_lanes(const LaneOptions& options, const HeadPack& pack);
/// Makes a kernel of discrete elastic rods, in double or single precision.
AnyLaneKernel der_lanes(const LaneOptions& options, const HeadPack& pack,
                        Jacobian jacobian);
/// Makes a kernel of point masses and springs, with bodies, in double precision.
AnyLaneKernel spring_lanes(const LaneOptions& options, const HeadPack& pack,
                           Jacobian jacobian);
/// Rods of quaternions, corde and xpbd_cosserat, exact: with gravity, linear drag and
/// bodies.
AnyLaneKernel corde_lanes(const LaneOptions& options, const HeadPack& pack);
/// Makes a kernel of xpbd_cosserat.
AnyLaneKernel cosserat_lanes(const LaneOptions& options, const HeadPack& pack);

}  // namespace tress::models
