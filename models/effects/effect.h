#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "contract/system.h"
#include "math/frame.h"
#include "math/vec3.h"
#include "models/effects/coupling.h"

namespace tress::models {

/// The material points that an effect acts on; spans an effect does not need may be
/// empty.
struct Points {
  int count = 0;
  In x;        // (3 count) position, m
  In v;        // (3 count) velocity, m/s
  In tangent;  // (3 count) unit tangent
  In mass;     // (count) mass carried by the point, kg
  In length;   // (count) strand length carried by the point, m
};

/// What a model must compute before it calls add_load, add_derivatives or power; the
/// model computes the union. potential() reads positions whatever this says.
struct Needs {
  bool position = false;
  bool velocity = false;
  bool tangent = false;
  bool derivatives = false;  // add_derivatives does something
  bool couplings = false;    // add_couplings too
  bool directions = false;   // add_direction_derivatives too

  Needs operator|(Needs other) const {
    return {position || other.position,   velocity || other.velocity,
            tangent || other.tangent,     derivatives || other.derivatives,
            couplings || other.couplings, directions || other.directions};
  }
};

/// A body as it is drawn.
struct Outline {
  std::string_view shape;  // "plane", "sphere", "capsule" or "ellipsoid"
  Vec half_axes;           // m; a capsule's z without the caps, a plane has none
  Vec x;                   // of its origin, m
  Frame frame;             // its axes
};

/// A force on material points that never sees degrees of freedom. Called once per block
/// of points, never per point; an effect that a scene does not name is not built.
class Effect {
 public:
  virtual ~Effect() = default;
  virtual std::string_view name() const = 0;
  virtual Needs needs() const = 0;
  /// f += load, (3 count) N.
  virtual void add_load(double t, const Points& p, InOut f) const noexcept = 0;
  /// Of an effect whose load is m times the same acceleration at every point and time.
  /// Models in moving frames may let the root accelerate against it instead of calling
  /// add_load.
  virtual std::optional<Vec> uniform_acceleration() const noexcept { return {}; }
  /// blocks += pos df/dx + vel df/dv, (9 count) row-major 3x3 blocks.
  virtual void add_derivatives(double t, const Points& p, double pos, double vel,
                               InOut blocks) const noexcept = 0;
  /// blocks += factor df/dt with respect to the unit tangent t at fixed x and v, (9
  /// count) as above: they meet turns of t, which are across t. How t follows from
  /// coordinates is the model's to know.
  virtual void add_direction_derivatives(double /*time*/, const Points& /*p*/,
                                         double /*factor*/,
                                         InOut /*blocks*/) const noexcept {}
  /// Of an effect whose load on a point depends on where others are: the whole
  /// derivative, of which add_derivatives has the blocks of each point by itself. A model
  /// takes the one or the other.
  virtual void add_couplings(double /*t*/, const Points& /*p*/,
                             std::vector<Coupling>& /*all*/) const {}
  /// J; reads the positions of the points, for which needs() does not ask.
  virtual double potential(double t, const Points& p) const noexcept = 0;
  /// W done by the part of the load that `potential` does not account for.
  virtual double power(double t, const Points& p) const noexcept = 0;
  /// Largest depth (m) of the strand's surface in a body over the points at `x` (3 per
  /// point), 0 when none touches. Nothing: the effect is no body.
  virtual std::optional<double> penetration(double /*t*/, In /*x*/) const { return {}; }
  /// Nothing where there is nothing to draw.
  virtual std::optional<Outline> outline(double /*t*/) const { return {}; }
};

/// Effects hold no state: strands may share them.
using Effects = std::vector<std::shared_ptr<const Effect>>;

inline Needs needs(const Effects& effects) {
  Needs all;
  for (const auto& effect : effects) all = all | effect->needs();
  return all;
}

}  // namespace tress::models
