#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "contract/layers.h"
#include "experiments/peers/swing.h"

namespace tress::experiments::peers {

/// What is looked at between steps, seen from the clamp (mm, mg, s). An engine that gave
/// up returns a tip that is not finite.
struct Motion {
  Vec tip;
  double kinetic_energy = 0;
};

/// One engine holding one strand, straight and at rest at first.
class Peer {
 public:
  virtual ~Peer() = default;
  /// From t to t + dt, with the dt that it was made with.
  virtual void step(double t) = 0;
  virtual Motion motion() = 0;
};

struct Method {
  std::string_view name;  // joints and integrator or solver
  int order;              // of the integrator; the reference of a higher one is coarser
  std::unique_ptr<Peer> (*make)(const Swing& swing, double dt);
};

/// One library: what it is called, which version is linked, what it can step with.
struct Engine {
  std::string_view id, version;
  std::span<const Method> methods;
};

/// Those that were found when this was built; `missing()` names the packages of the
/// others.
std::span<const Engine> engines();
std::span<const std::string_view> missing();

// Defined by each engine's own file, when it is part of the build.
std::span<const Method> simbody_methods();
std::span<const Method> bullet_methods();
std::span<const Method> mujoco_methods();
std::span<const Method> ode_methods();

}  // namespace tress::experiments::peers
