#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "contract/basics.h"
#include "math/frame.h"
#include "math/vec3.h"
#include "models/coupling/coupling.h"
#include "models/motion/by_time.h"

namespace tress::models {

/// The material points on which an effect acts; spans that it does not need may be empty.
struct Points {
  int count = 0;  // number of points
  In x;           // (3 count) position, m
  In v;           // (3 count) velocity, m/s
  In tangent;     // (3 count) unit tangent
  In mass;        // (count) mass carried by the point, kg
  In length;      // (count) strand length carried by the point, m
  int held = 0;   // the first so many move as the root prescribes, whatever their load
  In arc{};       // (count) arc length from the root at rest, m
  double longest = 0;  // arc length of the farthest tip, m
  /// Last teleport that was carried out (s), or by_time.
  double since = by_time;
};

/// Quantities that a model must compute before it calls add_load, add_derivatives or
/// power. The model computes the union over effects. potential() always reads positions.
struct Needs {
  bool position = false;     // positions
  bool velocity = false;     // velocities
  bool tangent = false;      // tangents
  bool derivatives = false;  // add_derivatives adds something
  bool couplings = false;    // add_couplings adds something
  bool directions = false;   // add_direction_derivatives adds something

  /// Returns what either needs.
  Needs operator|(Needs other) const {
    return {position || other.position,   velocity || other.velocity,
            tangent || other.tangent,     derivatives || other.derivatives,
            couplings || other.couplings, directions || other.directions};
  }
};

class Obstacle;
struct RigidContact;

/// All places within `radius` of its centre, m.
struct Ball {
  Vec centre;         // centre of the ball
  double radius = 0;  // radius of the ball
};

/// The load -(per_length l + per_mass m) v on points of length l and mass m.
struct Viscosity {
  double per_length = 0;  // kg/(m s)
  double per_mass = 0;    // 1/s
};

/// A body for drawing.
struct Outline {
  std::string_view shape;  // "plane", "sphere", "capsule" or "ellipsoid"
  Vec half_axes;           // m; a capsule's z without the caps, a plane has none
  Vec x;                   // of its origin, m
  Frame frame;             // its axes
};

/// A rigid contact of a point.
struct RigidTouch {
  std::size_t point = 0;  // index of the point
  Vec normal;             // outwards, of length 1
  Vec velocity;           // that its laws are about (Complementarity), m/s
  Vec force;              // N
  double friction = 0;    // Coulomb's coefficient
};

/// Contact forces that an effect holds between the steps of one strand: the part of
/// ContactForm (contract/system.h) that concerns its points. Those of rigid contacts can
/// be taken out of its hands, for a Complementarity.
class Multipliers {
 public:
  virtual ~Multipliers() = default;
  /// Returns true if the surface is rigid.
  virtual bool rigid() const = 0;
  /// Adds points that hold forces or overlap to those already taken. All forces are
  /// constants until give_back().
  virtual void take(double t, const Points& p) noexcept = 0;
  /// Appends those of the points that are taken.
  virtual void touches(double t, const Points& p,
                       std::vector<RigidTouch>& to) const noexcept = 0;
  /// Sets the force on a point that is taken, N; `since` as in Points.
  virtual void set_force(double t, double since, std::size_t point, double normal,
                         const Vec& tangential) noexcept = 0;
  /// Ends take(): the effect holds the forces again.
  virtual void give_back(const Points& p) noexcept = 0;
  virtual std::size_t tracked() const noexcept = 0;  // three numbers for every point
  /// Computes the coordinates X of ContactForm::places(), m.
  virtual void places(double t, const Points& p, Out x) const noexcept = 0;
  /// Computes the slides U of ContactForm::slides(), m/s.
  virtual void slides(double t, const Points& p, Out u) const noexcept = 0;
  /// Prepares the equations of a state, as ContactForm::begin().
  virtual void begin(double t, double tau, const Points& p, In x0) noexcept = 0;
  /// Improves the multipliers, as ContactForm::improve(); returns the violation, m/s.
  virtual double improve(double t, const Points& p) noexcept = 0;
  /// Returns ContactForm::drive() of these points, m/s.
  virtual double drive() const noexcept = 0;
  /// Extrapolates the multipliers, as ContactForm::extrapolate().
  virtual void extrapolate() noexcept = 0;
  /// Returns ContactForm::approach() of these points, m/s.
  virtual double approach(double t, const Points& p) noexcept = 0;
  /// Drops the forces of an impulse, as ContactForm::release().
  virtual void release() noexcept = 0;
  /// Returns true if points may rebound.
  virtual bool rebounds() const = 0;
  /// Returns the multipliers.
  virtual InOut values() noexcept = 0;
};

/// A force on material points, independent of the degrees of freedom. Called once per
/// block of points, never per point; effects that a scene does not name are not built.
class Effect {
 public:
  virtual ~Effect() = default;
  /// Returns the id of the effect.
  virtual std::string_view name() const = 0;
  /// Returns the quantities that loads and derivatives read.
  virtual Needs needs() const = 0;
  /// f += load, (3 count) N.
  virtual void add_load(double t, const Points& p, InOut f) const noexcept = 0;
  /// Set if the load is m times the same acceleration at every point and time. Models in
  /// moving frames may then accelerate the root against it instead of calling add_load.
  virtual std::optional<Vec> uniform_acceleration() const noexcept { return {}; }
  /// Set if that is all of its load, at every point and time. Models of uniform strands
  /// may then add it to their mass instead of calling add_load.
  virtual std::optional<Viscosity> viscosity() const noexcept { return {}; }
  /// Set if its loads are those of BodyContact on a rigid body, which kernels for many
  /// strands compute by themselves.
  virtual const RigidContact* rigid_contact() const noexcept { return nullptr; }
  /// Returns whether the effect may load some point of the ball at time t. The test is
  /// cheap compared with add_load; models may omit that call for points in balls out of
  /// reach.
  virtual bool reaches(double /*t*/, const Ball& /*ball*/) const noexcept { return true; }
  /// blocks += pos df/dx + vel df/dv, (9 count) row-major 3x3 blocks.
  virtual void add_derivatives(double t, const Points& p, double pos, double vel,
                               InOut blocks) const noexcept = 0;
  /// add_load and add_derivatives at once: for effects that find both by one search and
  /// would otherwise have to remember what they found.
  virtual void add_both(double t, const Points& p, double pos, double vel, InOut f,
                        InOut blocks) const noexcept {
    add_load(t, p, f);
    add_derivatives(t, p, pos, vel, blocks);
  }
  /// Adds factor df/dt to `blocks`, for the derivative with respect to the unit tangent t
  /// at fixed x and v, (9 count) as above. The blocks are applied to changes of t, which
  /// are orthogonal to t. The model knows how t depends on its coordinates.
  virtual void add_direction_derivatives(double /*time*/, const Points& /*p*/,
                                         double /*factor*/,
                                         InOut /*blocks*/) const noexcept {}
  /// Appends the full derivative of an effect whose load on a point depends on other
  /// points. add_derivatives gives only its diagonal blocks. A model calls one or the
  /// other.
  virtual void add_couplings(double /*t*/, const Points& /*p*/,
                             std::vector<Coupling>& /*all*/) const {}
  /// J; reads the positions of the points even if needs() does not request them.
  virtual double potential(double t, const Points& p) const noexcept = 0;
  /// Power (W) of the part of the load that is not in `potential`.
  virtual double power(double t, const Points& p) const noexcept = 0;
  /// The first time after t at which the load is switched on or off, or ends to be; where
  /// it follows a root's motion, the root knows. Infinity: none.
  virtual double next_breakpoint(double /*t*/) const noexcept {
    return std::numeric_limits<double>::infinity();
  }
  /// Largest depth (m) of the strand's surface in the body over the points at `x` (3 per
  /// point), 0 without contact. Empty if the effect is not a body.
  virtual std::optional<double> penetration(double /*t*/, In /*x*/) const { return {}; }
  /// Largest speed (m/s) of a moving body's surface, at those of the points at `x` (3 per
  /// point) that are in contact or less than `near` (m) from it. 0: no body moves there.
  virtual double surface_speed(double /*t*/, In /*x*/, double /*near*/) const {
    return 0;
  }
  /// Empty if there is nothing to draw.
  virtual std::optional<Outline> outline(double /*t*/) const { return {}; }
  /// Whether its loads are forces of contact.
  virtual bool contact() const { return outline(0).has_value(); }
  /// Returns a copy for one strand with this number of points, which must not be shared,
  /// if the load depends on contact forces that the effect holds (see HeldContacts). Null
  /// otherwise.
  virtual std::unique_ptr<Effect> for_strand(std::size_t /*points*/) const { return {}; }
  /// Returns the contact forces that the effect holds; null if it holds none.
  virtual Multipliers* multipliers() { return nullptr; }
  /// Set if its contact may be solved together with that between strands
  /// (StrandFriction): what then takes its place among the strand's effects.
  virtual std::shared_ptr<const Obstacle> obstacle() const { return {}; }
};

/// Strands may share effects, which are stateless but for those of for_strand().
using Effects = std::vector<std::shared_ptr<const Effect>>;

/// Whether some of them hold contact forces, so that a strand needs its own.
inline bool hold_contacts(const Effects& effects) {
  return std::ranges::any_of(
      effects, [](const auto& effect) { return effect->for_strand(0) != nullptr; });
}

/// Returns the first breakpoint of all effects after t (s), or infinity.
inline double next_breakpoint(const Effects& effects, double t) {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& effect : effects) next = std::min(next, effect->next_breakpoint(t));
  return next;
}

/// Returns the sum of their uniform accelerations, m/s^2.
inline Vec uniform_acceleration(const Effects& effects) {
  Vec sum;
  for (const auto& effect : effects) {
    sum = sum + effect->uniform_acceleration().value_or(Vec{});
  }
  return sum;
}

/// Returns the sum of their viscosities.
inline Viscosity viscosity(const Effects& effects) {
  Viscosity sum;
  for (const auto& effect : effects) {
    const Viscosity own = effect->viscosity().value_or(Viscosity{});
    sum.per_length += own.per_length;
    sum.per_mass += own.per_mass;
  }
  return sum;
}

/// Returns true if the load is neither a uniform acceleration nor a viscosity: it then
/// depends on the place of a point.
inline bool depends_on_place(const Effect& effect) {
  return !effect.uniform_acceleration() && !effect.viscosity();
}

/// Returns true if the load of some effect depends on the place of a point.
inline bool depend_on_place(const Effects& effects) {
  return std::ranges::any_of(
      effects, [](const auto& effect) { return depends_on_place(*effect); });
}

/// Returns the union of the effects' needs.
inline Needs needs(const Effects& effects) {
  Needs all;
  for (const auto& effect : effects) all = all | effect->needs();
  return all;
}

}  // namespace tress::models
