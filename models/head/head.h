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
#include "math/instructions.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"
#include "models/strand/strand.h"

namespace tress::models {

/// What acts on every strand of a head, and how strands are discretised.
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
  std::string reason, remedy;
};
std::optional<HeadRefusal> refused_by_heads(const Effect& effect);
/// Effects that the other numbers say as well, uniform accelerations and linear drag,
/// join them; the others are left.
void take_uniform_effects(LaneOptions& options);
template <std::derived_from<LaneOptions> Options>
Options with_uniform_effects(Options options) {
  take_uniform_effects(options);
  return options;
}

/// What holds the numbers of a head: strands side by side in packs. Wider packs and
/// shorter numbers are faster on machines with registers of that size; the lanes of a
/// kind of number give the same bits.
enum class HeadNumber { float64, float32 };
struct HeadPack {
  HeadNumber number = HeadNumber::float64;
  int lanes = 4;                                  // 1, 4, 8; of float32 8, 16
  std::optional<Instructions> instructions = {};  // none: the widest of the machine
};
/// As many lanes as the machine's registers have.
inline HeadPack widest_pack(HeadNumber number) {
  const bool wide = widest_instructions() == Instructions::avx512;
  if (number == HeadNumber::float64) return {number, wide ? 8 : 4};
  return {number, wide ? 16 : 8};
}

/// A strand without a solution: it stays where it was, the others go on.
struct HeadLoss {
  std::size_t strand;
  long step;    // of its head, the first is 1
  double time;  // at which the step starts, s
  std::string_view reason;
};

using HeadWork = NewtonWork;

/// Of a strand at one instant.
struct HeadEnergy {
  double kinetic = 0, elastic = 0;  // J
  double gravity = 0;               // J, its potential, 0 at the origin of the world
  double fastest = 0;               // m/s, of the root and the tips of elements
  Vec tip;                          // m
  double mass = 0;                  // kg
};

class HelixSource;

/// Many strands of equal discretisation whose roots move with one head: blocks of
/// strands, each advanced by itself, by as many threads as there are. In SIMD lanes a
/// strand takes its state, its rest shape and some twenty numbers of memory; replicated,
/// a System and an Integrator. Units of all that goes in and out are SI.
class Head {
 public:
  virtual ~Head() = default;

  /// Memory for so many strands.
  virtual void reserve(std::size_t strands) = 0;
  /// `own`: effects on this strand alone, as StrandInteraction::effect(k); they must not
  /// be shared, as blocks advance on several threads. Throws InputError unless the strand
  /// has `elements` segments of equal length and section, one after the other, and no
  /// free root, and on effects as LaneOptions says. Its own root motion is not read but
  /// for `position` and `frame` at rest.
  virtual void add(const Strand& strand, Effects own) = 0;
  void add(const Strand& strand) { add(strand, {}); }

  virtual std::size_t strands() const = 0;
  virtual std::size_t blocks() const = 0;
  virtual std::size_t bytes() const = 0;  // of all strands

  /// Memory of one thread.
  class Scratch {
   public:
    virtual ~Scratch() = default;
    HeadWork work;  // done with it
  };
  virtual std::unique_ptr<Scratch> scratch() const = 0;

  /// One step of a block, from t to t + h (s), with a tolerance as many as each strand
  /// needs, one at least. A strand without a solution, or whose
  /// result is not finite, stays as it was, at rest, from then on; others are the same
  /// bits with and without it. Effects cost where they reach: a body a test for each
  /// block, then one for each element, before any point is looked at. Safe for different
  /// blocks at once, each thread with its own scratch.
  virtual void step(std::size_t block, double t, double h, Scratch& scratch) = 0;
  /// The same of blocks first to last - 1: methods that iterate fill the lanes of strands
  /// that are done with the next strands, and so waste less on many blocks than on one.
  /// The results are the same bits.
  virtual void step(std::size_t first, std::size_t last, double t, double h,
                    Scratch& scratch) {
    for (std::size_t block = first; block < last; ++block) step(block, t, h, scratch);
  }
  /// With so many blocks in a call few lanes are without a strand.
  virtual std::size_t blocks_at_once() const { return 12; }
  virtual bool lost(std::size_t strand) const = 0;
  /// All but the first `known` that were found, by strand.
  virtual std::vector<HeadLoss> losses(std::size_t known) const = 0;
  std::vector<HeadLoss> losses() const { return losses(0); }
  /// The same for a strand whose state somebody else takes for impossible.
  virtual void lose(std::size_t strand) = 0;

  /// Of the strands of a block: root and tips of elements (m), strand after strand,
  /// `numbers` each = 3 (elements + 1).
  virtual std::size_t numbers() const = 0;
  virtual std::size_t strands_of(std::size_t block) const = 0;
  virtual void positions(std::size_t block, double t, std::span<double> x) const = 0;
  /// The same with their velocities (m/s).
  virtual void motion(std::size_t block, double t, std::span<double> x,
                      std::span<double> v) const = 0;
  /// Where the step from t to t + h looks for what touches the strands, beyond which it
  /// does not: the same points when coordinates have gone on by h times their rates, and
  /// of each strand how far points between them are from the straight lines that join
  /// them at most (m).
  virtual void ahead(std::size_t block, double t, double h, std::span<double> x,
                     std::span<double> bulge) const = 0;
  /// Coordinates and their rates of a strand, in the order of its elements: see the
  /// functions below.
  virtual void state(std::size_t strand, std::span<double> q,
                     std::span<double> v) const = 0;
  /// Of the bits of all strands' states, in their order (StateHash); equal for all
  /// numbers of lanes.
  std::size_t hash() const;

  /// Of each strand of a block: as Energetics of the strand by itself. O(elements
  /// points).
  virtual void energies(std::size_t block, double t,
                        std::span<HeadEnergy> each) const = 0;

  /// What steps change of the strands of a block, `kept` numbers each: exact, in units of
  /// the head's own. A head of the same strands that recalls them goes on with the same
  /// bits, for any number of lanes.
  virtual std::size_t kept() const = 0;
  /// So many of these, the first, are its coordinates and rates.
  virtual std::size_t kept_of_state() const = 0;
  virtual void keep(std::size_t block, std::span<double> x) const = 0;
  virtual void recall(std::size_t block, std::span<const double> x) = 0;

  /// What a device needs to take its steps (models/head/helix_source.h); null: there is
  /// no such code.
  virtual const HelixSource* source() const { return nullptr; }
};

/// Heads of super-helices (models/head/helix_strand.h) and of chains of rigid links
/// (models/head/chain_strand.h) whose steps are one linear solve with the stiff tangent,
/// fused with the motion of the strand. Coordinates are Darboux vectors (1/m), or the
/// rotation vectors of joints (rad), 3 per element. They throw InputError if the options
/// or the pack make no sense.
std::unique_ptr<Head> stiff_helix_head(const LaneOptions& options, const HeadPack& pack);
std::unique_ptr<Head> stiff_chain_head(const LaneOptions& options, const HeadPack& pack);

}  // namespace tress::models
