#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/instructions.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"
#include "models/strand/strand.h"

namespace tress::models {

/// How a step is computed, by the names of the integrators' catalogue: the equations are
/// theirs (models/head/stepping/lane_method.h).
enum class HeadMethod {
  semi_implicit_euler,
  linearly_implicit_midpoint,
  backward_euler,
  tr_bdf2
};

/// What acts on every strand of a head, and how strands are discretised.
struct HeadOptions {
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
  HeadMethod method = HeadMethod::semi_implicit_euler;
  // As Options::newton_tolerance, at least what numbers resolve, and newton_iterations.
  double newton_tolerance = 1e-10;
  int newton_iterations = 20;
  /// By tr_bdf2 every strand takes steps of its own, as long as its own error allows, as
  /// Options::tolerance; 0: equal steps. Newton's tolerance follows from it. See
  /// models/head/stepping/controlled_steps.h.
  double tolerance = 0;
  double min_step = 0;  // s, with a tolerance: strands that need less are lost
  /// On every strand, in addition: gravity and linear drag join the numbers above, bodies
  /// are computed for all lanes at once, others strand by strand. Refused: effects that
  /// couple points (self_contact) or hold contact forces (friction_law = exact).
  Effects effects = {};
};

/// Why a head cannot have an effect, and what would help; nothing if it can.
struct HeadRefusal {
  std::string reason, remedy;
};
std::optional<HeadRefusal> refused_by_heads(const Effect& effect);
/// Effects that the other numbers say as well, uniform accelerations and linear drag,
/// join them; the others are left.
HeadOptions with_uniform_effects(HeadOptions options);

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

/// Whether numbers are long enough for strands that choose their steps by this tolerance.
bool resolve(HeadNumber number, double tolerance);

/// A strand without a solution: it stays where it was, the others go on.
struct HeadLoss {
  std::size_t strand;
  long step;    // of its head, the first is 1
  double time;  // at which the step starts, s
  std::string_view reason;
};

/// Newton's iterations of steps: of strands, and of lanes, those without a strand
/// included.
struct HeadWork {
  long steps = 0;                              // of strands
  long iterations = 0, lanes = 0;              // whole corrections, strands side by side
  long retried = 0;                            // steps of strands on which they failed
  long again_iterations = 0, again_lanes = 0;  // of these, damped
  long in_parts = 0;                           // of the last, iterations of shorter steps
  long shortened = 0;                          // steps of strands taken in shorter ones
  // With a tolerance, steps of strands that were tried again with shorter ones.
  long rejected_by_error = 0, rejected_by_newton = 0;

  HeadWork& operator+=(const HeadWork& more) {
    steps += more.steps;
    iterations += more.iterations;
    lanes += more.lanes;
    retried += more.retried;
    again_iterations += more.again_iterations;
    again_lanes += more.again_lanes;
    in_parts += more.in_parts;
    shortened += more.shortened;
    rejected_by_error += more.rejected_by_error;
    rejected_by_newton += more.rejected_by_newton;
    return *this;
  }
};

/// Of a strand at one instant.
struct HeadEnergy {
  double kinetic = 0, elastic = 0;  // J
  double gravity = 0;               // J, its potential, 0 at the origin of the world
  double fastest = 0;               // m/s, of the root and the tips of elements
  Vec tip;                          // m
  double mass = 0;                  // kg
};

class HelixSource;

/// Many clamped strands of equal discretisation whose roots move with one head: blocks of
/// strands, each advanced by itself, by as many threads as there are. A strand takes its
/// state, its rest shape and some twenty numbers of memory, nothing else. Units of all
/// that goes in and out are SI.
class Head {
 public:
  virtual ~Head() = default;

  /// Memory for so many strands.
  virtual void reserve(std::size_t strands) = 0;
  /// `own`: effects on this strand alone, as StrandInteraction::effect(k); they must not
  /// be shared, as blocks advance on several threads. Throws InputError unless the strand
  /// has `elements` segments of equal length and section, one after the other, and no
  /// free root, and on effects as HeadOptions says. Its own root motion is not read but
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

/// A head of super-helices (models/head/helix_strand.h); coordinates are Darboux vectors
/// (1/m), 3 per element; semi_implicit_euler with the stiff tangent, or the other methods
/// with the exact one (models/head/exact/exact_kernel.h), which have gravity, linear drag
/// and bodies. tr_bdf2 starts from the acceleration at the start, so that twist must have
/// inertia. Throws InputError if the options or the pack make no sense.
std::unique_ptr<Head> helix_head(const HeadOptions& options, const HeadPack& pack);

/// A head of chains of rigid links (models/head/chain_strand.h); coordinates are the
/// rotation vectors of the joints (rad), 3 per link; methods as above, but
/// linearly_implicit_midpoint needs numbers of 64 bits; `points` are those of a link at
/// which effects act. Throws InputError as above.
std::unique_ptr<Head> chain_head(const HeadOptions& options, const HeadPack& pack);

/// A head of discrete elastic rods (models/head/maximal/der_strand.h), `elements` edges
/// each: semi_implicit_euler with the stiff tangent, or the other methods with the exact
/// one but for slopes of friction, linearly_implicit_midpoint in 64 bits. Coordinates
/// are, per edge, the vector along it (m, world axes) and the angle of its frame; the
/// rate of the first edge is the velocity of its end. Without rotary_inertia angles have
/// no inertia, and there is no tr_bdf2; `points` is not read. Throws InputError as above.
std::unique_ptr<Head> der_head(const HeadOptions& options, const HeadPack& pack);

/// A head of point masses and springs (models/head/maximal/spring_strand.h), `elements`
/// edges each: mass_spring with angular bending, without torsion, by semi_implicit_euler
/// with the filtered tangent, or by the other methods with the exact one; of effects
/// beyond gravity and linear drag it has bodies. Coordinates are the vectors along the
/// edges (m, world axes); the rate of the first is the velocity of its end. `points`,
/// `twist` and `rotary_inertia` are not read. Numbers have 64 bits: 32 do not resolve
/// strains of some 1e-6. Throws InputError as above.
std::unique_ptr<Head> spring_head(const HeadOptions& options, const HeadPack& pack);

}  // namespace tress::models
