#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contract/forms/driven_bodies.h"
#include "contract/forms/energetics.h"
#include "contract/forms/history.h"
#include "contract/forms/loaded_tangent.h"
#include "contract/forms/material_points.h"
#include "contract/forms/point_accelerations.h"
#include "contract/forms/sections.h"
#include "models/effects/driven_body.h"

namespace tress::models {

/// Typical sizes of a motion, for scales.
struct TypicalMotion {
  double length = 1;  // m
  double rate = 1;    // 1/s
};
/// Returns the sizes of a strand's motion: its length, and the largest typical rate of a
/// coordinate.
TypicalMotion typical_motion(System& strand);

/// A rigid body that strands drive, as a system of its own. Strands hold it by joints at
/// its material points; it has none at first.
///
/// A body that turns about a bearing has its angle theta as coordinate:
///
///     I theta'' + c theta' - M = moment of strands about the axis.
///
/// The 6 coordinates of a free body are the place x of its centre of mass and a rotation
/// vector phi relative to a reference. With the principal moments J in its frame:
///
///     m x'' = m g + force,    J omega' + omega x J omega = moment.
///
/// The reference follows the motion (accept), so |phi| remains below 1.5 after a step.
/// The matrix follows from the residual by dual numbers.
class BodySystem : public System,
                   public MaterialPoints,
                   public PointAccelerations,
                   public Sections,
                   public LoadedTangent,
                   public Energetics,
                   public History {
 public:
  /// `effect` must outlive it.
  BodySystem(const DrivenBody& effect, const TypicalMotion& typical)
      : effect_(effect), typical_(typical) {}

  /// Returns the contact of the body.
  const DrivenBody& effect() const { return effect_; }
  /// Adds a material point that is at this place at the start. Returns its number.
  int add_point(const Vec& place);

  /// Returns the motion of the body.
  virtual DrivenBodies::Motion motion(In q, In v) const = 0;
  /// Writes the screws of the coordinates.
  virtual void screws(In q, In v, std::span<Screw> to) const = 0;
  /// Writes the accelerations.
  virtual Status acceleration(double t, In q, In v, Out a) noexcept = 0;
  /// Returns the power of all forces without those of strands, W.
  virtual double own_power(In q, In v) const = 0;
  /// Sets the derivatives of contact forces for linearize(): the wrench of the contact,
  /// and the derivatives of s . f at fixed s, by columns (DrivenBody::Slopes).
  void hang(const BodyWrench& wrench, std::span<const double> own);

  Traits traits() const override {
    return {.constant_mass = false, .regular_mass = true};
  }
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return linearize_loaded(t, q, v, a, w, {}, {});
  }
  Energetics* energetics() override { return this; }
  MaterialPoints* material_points() override { return this; }
  History* history() override { return this; }

  int count() const override { return static_cast<int>(arms_.size()); }
  int before(int) const override { return -1; }
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;

  Kind section_kind(int) const override { return {.turning = Turning::frame}; }
  Frame section_frame(double, In q, int) override;

  bool takes_loads() const override { return true; }

 protected:
  const DrivenBody& effect_;
  TypicalMotion typical_;
  std::vector<Vec> arms_;  // of material points, from the reference point at the start
  BodyWrench wrench_;      // of the contact, for linearize()
  std::vector<double> own_, zero_;
};

/// Returns the acceleration by gravity among these effects, m/s^2.
Vec gravity_on_bodies(const Effects& effects);

/// Makes the system of a body. `gravity`: acceleration of a free body, m/s^2.
std::unique_ptr<BodySystem> make_body_system(const DrivenBody& effect, const Vec& gravity,
                                             const TypicalMotion& typical);

}  // namespace tress::models
