#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "models/motion/root_motion.h"
#include "models/strand/strand.h"

namespace tress::models {

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
  RootMotion motion;           // of the head, `position` any point of it, at rest
};

/// What holds the numbers of a head: strands side by side in packs. Wider packs and
/// shorter numbers are faster on machines with registers of that size; the lanes of a
/// kind of number give the same bits.
enum class HeadNumber { float64, float32 };
struct HeadPack {
  HeadNumber number = HeadNumber::float64;
  int lanes = 4;  // 1, 4, 8; of float32 8, 16
};

/// Of a strand at one instant.
struct HeadEnergy {
  double kinetic = 0, elastic = 0;  // J
  double gravity = 0;               // J, its potential, 0 at the origin of the world
  double fastest = 0;               // m/s, of the root and the tips of elements
  Vec tip;                          // m
  double mass = 0;                  // kg
};

/// Many clamped strands of equal discretisation whose roots move with one head: blocks of
/// strands, each advanced by itself, by as many threads as there are. A strand takes its
/// state, its rest shape and some twenty numbers of memory, nothing else. Units of all
/// that goes in and out are SI.
class Head {
 public:
  virtual ~Head() = default;

  /// Memory for so many strands.
  virtual void reserve(std::size_t strands) = 0;
  /// Throws InputError unless the strand has `elements` segments of equal length and
  /// section, one after the other, and no free root. Its own root motion is not read but
  /// for `position` and `frame` at rest.
  virtual void add(const Strand& strand) = 0;

  virtual std::size_t strands() const = 0;
  virtual std::size_t blocks() const = 0;
  virtual std::size_t bytes() const = 0;  // of all strands

  /// Memory of one thread.
  class Scratch {
   public:
    virtual ~Scratch() = default;
  };
  virtual std::unique_ptr<Scratch> scratch() const = 0;

  /// One step of semi_implicit_euler of a block, from t to t + h (s). A strand whose
  /// result is not finite stays as it was, at rest, from then on. Safe for different
  /// blocks at once, each thread with its own scratch.
  virtual void step(std::size_t block, double t, double h, Scratch& scratch) = 0;
  virtual bool lost(std::size_t strand) const = 0;
  /// The same for a strand whose state somebody else takes for impossible.
  virtual void lose(std::size_t strand) = 0;

  /// Of the strands of a block: root and tips of elements (m), strand after strand,
  /// `numbers` each = 3 (elements + 1).
  virtual std::size_t numbers() const = 0;
  virtual std::size_t strands_of(std::size_t block) const = 0;
  virtual void positions(std::size_t block, double t, std::span<double> x) const = 0;
  /// Darboux vectors (1/m) and their rates of a strand, 3 per element.
  virtual void state(std::size_t strand, std::span<double> q,
                     std::span<double> v) const = 0;
  /// Of the bits of all strands' states, in their order; equal for all numbers of lanes.
  virtual std::size_t hash() const = 0;

  /// Of each strand of a block: as Energetics of the strand by itself. O(elements
  /// points).
  virtual void energies(std::size_t block, double t,
                        std::span<HeadEnergy> each) const = 0;

  /// What steps change of the strands of a block, `kept` numbers each: exact, in units of
  /// the head's own. A head of the same strands that recalls them goes on with the same
  /// bits, for any number of lanes.
  virtual std::size_t kept() const = 0;
  virtual void keep(std::size_t block, std::span<double> x) const = 0;
  virtual void recall(std::size_t block, std::span<const double> x) = 0;
};

/// A head of super-helices (models/head/helix_strand.h). Throws InputError if the options
/// or the pack make no sense.
std::unique_ptr<Head> helix_head(const HeadOptions& options, const HeadPack& pack);

}  // namespace tress::models
