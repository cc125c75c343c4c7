#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "contract/layers.h"
#include "experiments/other_simulators/rubbing.h"
#include "math/vec3.h"

namespace tress::experiments::other_simulators {

/// Scene `swing`: one strand clamped at its root, released horizontally along +x from
/// rest, straight when unloaded. The clamp moves y_c(t) = 0.05 (1 - cos 2 pi t) m.
/// Gravity along -z, mass-proportional damping. Cut into N rigid links of length l = L /
/// N.
///
/// Units: mm, mg, s, so that a link's mass and moment are near one: some engines hold
/// absolute limits (MuJoCo refuses moments of inertia below 1e-15).
///
/// Hinges: bending springs of EI / l between links. The hinge at the clamp stands for
/// half an element only (from the clamp to the first link's middle), hence 2 EI / l. With
/// EI / l there the chain would converge to the rod at first order in l instead of
/// second. Ball joints get the same stiffness about the tangent. A link's moment about
/// its axis is raised to that about its diameter. A straight strand of circular section
/// does not twist, and the true moment, 1e-4 times that, would only shorten the time step
/// without need.
///
/// The clamp's motion: bodies are seen from the clamp, so that its acceleration and the
/// damping of its velocity join gravity (d'Alembert). The clamp does not turn, so this is
/// exact, and every engine takes a gravity that varies in time.
struct Swing {
  int links = 20;

  static constexpr double length = 200;       // mm
  static constexpr double radius = 0.04;      // mm
  static constexpr double density = 1.3;      // mg/mm^3
  static constexpr double young = 2e12;       // mg/(mm s^2), 2 GPa
  static constexpr double damping = 2;        // 1/s: force per mass and speed
  static constexpr double t_end = 2;          // s
  static constexpr double gravity_z = -9810;  // mm/s^2

  double link_length() const { return length / links; }
  double mass() const;                // of a link, mg
  double moment() const;              // of a link about its centre, any axis, mg mm^2
  double stiffness(int hinge) const;  // of hinge 0 (the clamp) to N - 1, mg mm^2/s^2

  /// Acceleration of the links seen from the clamp, mm/s^2: gravity, minus the clamp's
  /// acceleration, minus damping times its velocity.
  static Vec gravity(double t);
  /// Returns the displacement y_c of the clamp, mm.
  static double clamp(double t);
};

/// The rotation of a unit quaternion as axis times angle (|angle| <= pi), accurate at
/// zero.
Vec rotation_vector(double w, const Vec& xyz);

/// Motion sampled between steps, seen from the clamp (mm, mg, s). An engine that gave
/// up returns a tip that is not finite.
struct Motion {
  Vec tip;
  double kinetic_energy = 0;
};

/// One engine holding one strand, straight and at rest at first.
class Simulator {
 public:
  virtual ~Simulator() = default;
  /// Takes a step from t to t + dt, with the dt that was given at construction.
  virtual void step(double t) = 0;
  /// Takes `steps` such steps of dt; returns their wall time, s.
  virtual double advance(double t, double dt, int steps);
  virtual Motion motion() = 0;
};

enum class Precision { as_double, single };

struct Method {
  std::string_view name;  // joints and integrator or solver
  int order;              // of the integrator; the reference of a higher one is coarser
  std::unique_ptr<Simulator> (*make)(const Swing& swing, double dt);
  Precision precision = Precision::as_double;
};

/// One library: what it is called, which version is linked, what it can step with.
struct Engine {
  std::string_view id, version;
  std::span<const Method> methods;
  std::span<const RubbingMethod> rubbing;
};

/// Returns the engines that were found when this was built; `missing()` names the
/// packages of the others.
std::span<const Engine> engines();
std::span<const std::string_view> missing();

// Defined by each engine's own file, when it is part of the build.
std::span<const Method> simbody_methods();
std::span<const Method> bullet_methods();
std::span<const Method> mujoco_methods();
std::span<const Method> ode_methods();
std::span<const Method> mujoco_3_methods();
std::span<const Method> jolt_methods();

}  // namespace tress::experiments::other_simulators
