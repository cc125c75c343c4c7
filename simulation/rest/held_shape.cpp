#include "simulation/rest/held_shape.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "contract/forms/material_points.h"
#include "contract/input_error.h"
#include "linear/dense_algebra.h"
#include "simulation/rest/body_support.h"
#include "simulation/rest/dense_statics.h"
#include "simulation/rest/natural_gain.h"
#include "simulation/scene/scene_check.h"
#include "simulation/scene_changes/strand_options.h"

namespace tress::simulation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using models::Effects;

/// The motion held at t = 0.
RootMotion still(RootMotion motion) {
  for (auto* parts : {&motion.translations, &motion.rotations}) {
    for (RootMotion::Part& part : *parts) {
      part.signal = [value = part.signal(0).value](double) {
        return models::SignalValue{value, 0, 0};
      };
    }
  }
  motion.teleports.clear();
  return motion;
}

/// The elastic stiffness that grows with the moduli.
MatrixXd elastic_stiffness(DenseStatics& statics, NaturalStrains& strains) {
  const std::vector<double> stiffness = strains.natural_stiffness();
  const Eigen::Map<const VectorXd> k(stiffness.data(), std::ssize(stiffness));
  if (strains.strains_are_coordinates()) return MatrixXd(k.asDiagonal());
  const MatrixXd slope = statics.by_natural(strains);
  return slope * k.cwiseInverse().asDiagonal() * slope.transpose();
}

/// Largest displacement of a material point between two states.
double distance(System& system, In from, In to) {
  MaterialPoints* const points = system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points->count())), y = x;
  points->positions(0, from, x);
  points->positions(0, to, y);
  double most = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    most = std::max(most, norm(load3(&y[i]) - load3(&x[i])));
  }
  return most;
}

/// The state of balance for these natural strains, one Newton's step from q.
std::vector<double> balanced(DenseStatics& statics, std::vector<double> q) {
  const MatrixXd change =
      statics.displacement(solution(statics.stiffness(), statics.residual()));
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] -= change(static_cast<Eigen::Index>(i), 0);
  }
  return q;
}

/// Sets the natural strains for which the state of balance is nearest to q, and returns
/// that state. It is q itself where strains are coordinates. Elsewhere stretch, which
/// carries the tension and is not one of these strains, moves it a little.
std::vector<double> balance(System& system, NaturalStrains& strains,
                            const std::vector<double>& q) {
  constexpr int rounds = 4;  // after the first, with the tension of the load
  std::vector<double> at = q;
  for (int round = 0; round < rounds; ++round) {
    DenseStatics statics(system, at);
    VectorXd wrong = statics.residual();
    if (!strains.strains_are_coordinates()) wrong += statics.pull(at, q);
    const VectorXd change = natural_gain(statics, strains) * wrong;
    std::vector<double> natural = strains.natural();
    for (std::size_t k = 0; k < natural.size(); ++k) {
      natural[k] += change[static_cast<Eigen::Index>(k)];
    }
    strains.set_natural(natural);
    if (!strains.strains_are_coordinates()) at = balanced(statics, at);
  }
  return at;
}

void invert(const Scene& scene, const Strand& strand, Parameters options, Effects effects,
            HeldShape& held) {
  if (options.knows("jacobian")) options.set("jacobian", "exact");
  const auto system = scene.model->on_strand(strand, options, std::move(effects));
  const std::vector<double> q = coordinates_at_start(*system);
  NaturalStrains& strains = strains_to_hold(scene, strand, *system, inverse_rest);
  const double load = DenseStatics(*system, q).residual().norm();
  const std::vector<double> at = balance(*system, strains, q);
  DenseStatics statics(*system, at);
  held.natural = strains.natural();
  held.residual = load > 0 ? statics.residual().norm() / load : 0;
  if (!std::isfinite(held.residual)) {
    throw std::runtime_error("its forces at rest have no balance");
  }
  held.least_factor = held.factor * least_definite(statics.stiffness(),
                                                   elastic_stiffness(statics, strains));
  held.sag = distance(*system, q, balanced(statics, at));
}

HeldShape held_shape(const Scene& scene, std::size_t k, const Parameters& options,
                     const Effects& between) {
  HeldShape held;
  const Strand& strand = scene.strands[k];
  const auto acting = [&] {
    Effects all = supporting(make_effects(scene), held);
    all.insert(all.end(), between.begin(), between.end());
    return all;
  };
  const HoldingBodies support = body_support(scene, strand, options, acting());
  held.contacts = support.contacts;
  held.offsets = support.offsets;
  invert(scene, strand, options, acting(), held);
  if (!held.would_fall() || scene.unstable != Unstable::stiffen) return held;
  if (!std::isfinite(held.least_factor)) {
    throw std::runtime_error("it would fall however stiff it were");
  }
  held.factor = stiffened * held.least_factor;
  invert(scene, stiffer(strand, held), options, acting(), held);
  return held;
}

}  // namespace

Scene still(Scene scene) {
  scene.head = still(scene.head);
  for (Strand& strand : scene.strands) strand.root = still(strand.root);
  for (EffectChoice& choice : scene.effects) {
    if (choice.entry->id != "wind") continue;
    if (choice.parameters.word("profile") == "gusts") {
      choice.parameters.set("profile", "constant");
    }
  }
  return scene;
}

std::vector<HeldShape> held_shapes(const Scene& scene,
                                   const std::function<Effects(std::size_t)>& between,
                                   Crew& crew, std::span<const std::size_t> numbers) {
  const Scene held_scene = still(scene);
  const StrandOptions options(held_scene);
  std::vector<HeldShape> all(scene.strands.size());
  in_parts(crew, 0, all.size(), all.size(), [&](std::size_t k, std::size_t) {
    try {
      all[k] = held_shape(held_scene, k, options.of(held_scene.strands[k]), between(k));
    } catch (const std::runtime_error& error) {
      throw InputError(
          fmt::format("strand {}: {}", numbers.empty() ? k : numbers[k], error.what()),
          inverse_rest, "change its shape or what acts on it, or leave out rest");
    }
  });
  return all;
}

std::vector<double> points_at_start(const Scene& scene) {
  std::vector<double> all;
  for (const Strand& strand : scene.strands) {
    const auto system = scene.model->on_strand(strand, scene.model_options, {});
    MaterialPoints* const points = system->material_points();
    std::vector<double> x(3 * static_cast<std::size_t>(points->count()));
    points->positions(0, coordinates_at_start(*system), x);
    all.insert(all.end(), x.begin(), x.end());
  }
  return all;
}

Strand stiffer(Strand strand, const HeldShape& held) {
  strand.material.youngs_modulus *= held.factor;
  strand.material.shear_modulus *= held.factor;
  return strand;
}

Effects supporting(Effects effects, const HeldShape& held) {
  for (const auto& [body, more] : held.offsets) {
    effects[body] = with_offsets(*effects[body], more);
  }
  return effects;
}

}  // namespace tress::simulation
