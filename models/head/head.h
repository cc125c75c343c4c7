#pragma once

#include <concepts>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/newton_work.h"
#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Effects on every strand of a batch, and discretisation of the strands.
struct LaneOptions {
  int elements = 10;           // of every strand
  int points = 4;              // Gauss-Legendre points of an element: quadrature_points()
  bool twist = true;           // false: strands bend only
  bool rotary_inertia = true;  // as ReducedOptions::rotary_inertia
  Vec gravity{0, 0, -9.81};    // m/s^2
  double drag = 0;             // LinearDrag: force per length and velocity, kg/(m s)
  double mass_damping = 0;     // force per mass and velocity, 1/s
  double longest = 0.2;        // m: sets the units of computation, any order of magnitude
  double line_density = 0;     // kg/m: the same; 0: that of the first strand
  RootMotion motion = {};      // of the head, `position` any point of it, at rest
  /// On every strand, in addition: gravity and linear drag join the numbers above, bodies
  /// are computed for all lanes at once, others strand by strand. Refused: effects that
  /// couple points (self_contact) or hold contact forces (friction_law = exact).
  Effects effects = {};
  /// Options of corde or xpbd_cosserat; none: those by default. Not read by other models.
  std::optional<Parameters> model = {};
};

/// Why a head cannot have an effect, and what would help; nothing if it can.
struct HeadRefusal {
  std::string reason, remedy;  // cause and remedy for messages
};
/// Returns why batches cannot have an effect; nothing if they can.
std::optional<HeadRefusal> refused_by_heads(const Effect& effect);
/// Effects that the other numbers say as well, uniform accelerations and linear drag,
/// join them; the others are left.
void take_uniform_effects(LaneOptions& options);
/// Returns options after take_uniform_effects().
template <std::derived_from<LaneOptions> Options>
Options with_uniform_effects(Options options) {
  take_uniform_effects(options);
  return options;
}

/// Number type of a batch, whose strands lie in SIMD lanes: `float64` or `float32`. Wider
/// packs and single precision are faster on machines with registers of that size. Results
/// are bit-identical for any number of lanes of one type.
enum class HeadNumber { float64, float32 };
/// Lanes of a batch.
struct HeadPack {
  HeadNumber number = HeadNumber::float64;  // number type
  int lanes = 4;                            // 1, 4, 8; of float32 8, 16
  bool operator==(const HeadPack&) const = default;
};
/// Returns the packs for which this build has kernels, those of float64 first, the
/// longest of each number type last.
std::span<const HeadPack> compiled_packs();
/// Returns the pack of this number type that has the width of `doubles` doubles.
inline HeadPack pack_as_long_as(int doubles, HeadNumber number) {
  return {number, number == HeadNumber::float64 ? doubles : 2 * doubles};
}
/// Returns the widest pack of this build that the machine's registers hold.
HeadPack widest_pack(HeadNumber number);
/// Returns the longest pack of this build, which also runs on machines with narrower
/// registers.
HeadPack longest_pack(HeadNumber number);

/// A strand without a solution: it stays where it was, the others go on.
struct HeadLoss {
  std::size_t strand;       // index of the strand
  long step;                // of its head, the first is 1
  double time;              // at which the step starts, s
  std::string_view reason;  // cause, for messages
};

/// Work done by steps.
using HeadWork = NewtonWork;

/// Energies of a strand at one instant.
struct HeadEnergy {
  double kinetic = 0, elastic = 0;  // J
  double gravity = 0;               // J, its potential, 0 at the origin of the world
  double fastest = 0;               // m/s, of the root and the tips of elements
  Vec tip;                          // m
  double mass = 0;                  // kg
};

class HelixSource;

/// Batch of strands of equal discretisation whose roots move with one head. Blocks of
/// strands advance independently, each by one thread at a time. In SIMD lanes a strand
/// takes the memory of its state, its rest shape and about twenty numbers; replicated,
/// that of a System and an Integrator. All inputs and outputs are in SI units.
class Head {
 public:
  virtual ~Head() = default;

  /// Reserves memory for this number of strands.
  virtual void reserve(std::size_t strands) = 0;
  /// `own`: effects on this strand alone, as StrandInteraction::effect(k); they must not
  /// be shared, as blocks advance on several threads. Throws InputError unless the strand
  /// has `elements` segments of equal length and section, one after the other, and no
  /// free root, and on effects as LaneOptions says. Its own root motion is not read but
  /// for `position` and `frame` at rest.
  virtual void add(const Strand& strand, Effects own) = 0;
  /// Adds a strand without effects of its own.
  void add(const Strand& strand) { add(strand, {}); }

  /// Returns the number of strands.
  virtual std::size_t strands() const = 0;
  /// Returns the number of blocks.
  virtual std::size_t blocks() const = 0;
  virtual std::size_t bytes() const = 0;  // of all strands

  /// Memory of one thread.
  class Scratch {
   public:
    virtual ~Scratch() = default;
    HeadWork work;  // done with it
  };
  /// Returns memory for the calls of one thread.
  virtual std::unique_ptr<Scratch> scratch() const = 0;

  /// Advances a block by one step from t to t + h (s). With a tolerance each strand takes
  /// its own number of steps, at least one. A strand without a solution, or with a result
  /// that is not finite, stays at rest in its last state from then on. Others are
  /// bit-identical with and without it. Effects cost only where they act: a body is
  /// tested against each block, then each element, before any point. Safe for different
  /// blocks at once, each thread with its own scratch.
  virtual void step(std::size_t block, double t, double h, Scratch& scratch) = 0;
  /// Advances blocks first to last - 1 by one step. Methods that iterate refill the lanes
  /// of converged strands with the next strands, which wastes less on many blocks than on
  /// one. The results are bit-identical.
  virtual void step(std::size_t first, std::size_t last, double t, double h,
                    Scratch& scratch) {
    for (std::size_t block = first; block < last; ++block) step(block, t, h, scratch);
  }
  /// Returns the number of blocks per call with which few lanes are empty.
  virtual std::size_t blocks_at_once() const { return 12; }
  /// Returns true if the strand has failed.
  virtual bool lost(std::size_t strand) const = 0;
  /// All but the first `known` that were found, by strand.
  virtual std::vector<HeadLoss> losses(std::size_t known) const = 0;
  /// Returns all that were found.
  std::vector<HeadLoss> losses() const { return losses(0); }
  /// Marks a strand as failed whose state the caller finds impossible.
  virtual void lose(std::size_t strand) = 0;

  /// Returns how many numbers positions() writes for one strand, 3 (elements + 1): root
  /// and tips of elements (m). Strands of a block follow each other.
  virtual std::size_t numbers() const = 0;
  /// Returns the number of strands of a block.
  virtual std::size_t strands_of(std::size_t block) const = 0;
  /// Computes root and tips of the strands of a block, m.
  virtual void positions(std::size_t block, double t, std::span<double> x) const = 0;
  /// Computes the positions (m) and velocities (m/s) of root and tips of elements.
  virtual void motion(std::size_t block, double t, std::span<double> x,
                      std::span<double> v) const = 0;
  /// Predicts the points at t + h: coordinates advance by h times their rates. The step
  /// looks for contacts there only. `bulge`: largest distance (m) of a strand's points
  /// from the straight lines that join its root and tips, one per strand.
  virtual void ahead(std::size_t block, double t, double h, std::span<double> x,
                     std::span<double> bulge) const = 0;
  /// Coordinates and their rates of a strand, in the order of its elements: see the
  /// functions below.
  virtual void state(std::size_t strand, std::span<double> q,
                     std::span<double> v) const = 0;
  /// Returns the hash of the bits of all strands' states in their order (StateHash);
  /// equal for all numbers of lanes.
  std::size_t hash() const;

  /// Computes the energies of each strand of a block, as Energetics does for one strand.
  /// O(elements points).
  virtual void energies(std::size_t block, double t,
                        std::span<HeadEnergy> each) const = 0;

  /// Returns how many numbers keep() writes per strand: the data that steps change,
  /// exact, in the units of the batch. A batch of the same strands that recalls them
  /// continues bit-identically, for any number of lanes.
  virtual std::size_t kept() const = 0;
  /// Returns how many of these numbers are coordinates and rates; they come first.
  virtual std::size_t kept_of_state() const = 0;
  /// Writes all that steps change, kept() numbers a strand.
  virtual void keep(std::size_t block, std::span<double> x) const = 0;
  /// Restores what keep() wrote.
  virtual void recall(std::size_t block, std::span<const double> x) = 0;

  /// Returns the data that a device needs to step the strands
  /// (models/head/helix_source.h); null: there is no device code.
  virtual const HelixSource* source() const { return nullptr; }
};

/// Heads of super-helices (models/head/helix_strand.h) and of chains of rigid links
/// (models/head/chain_strand.h) whose steps are one linear solve with the elastic
/// Jacobian, fused with the motion of the strand. Coordinates are Darboux vectors (1/m),
/// or the rotation vectors of joints (rad), 3 per element. They throw InputError if the
/// options or the pack make no sense.
std::unique_ptr<Head> stiff_helix_head(const LaneOptions& options, const HeadPack& pack);
/// Makes chains of rigid links; see stiff_helix_head().
std::unique_ptr<Head> stiff_chain_head(const LaneOptions& options, const HeadPack& pack);
/// Makes super-clothoids (models/head/clothoid_strand.h), 6 coordinates per element: the
/// mean Darboux vector and half its difference between the ends; see stiff_helix_head().
std::unique_ptr<Head> stiff_clothoid_head(const LaneOptions& options,
                                          const HeadPack& pack);

}  // namespace tress::models
