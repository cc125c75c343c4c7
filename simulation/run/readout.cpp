#include "simulation/run/readout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/effects/effect.h"
#include "simulation/run/body_columns.h"
#include "simulation/run/line_curvature.h"
#include "simulation/scene/driven_bodies.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {
namespace {

/// Of points with 3 numbers each.
std::size_t nearest(const Vec& place, In x) {
  std::size_t best = 0;
  for (std::size_t i = 0; 3 * i < x.size(); ++i) {
    if (norm(load3(&x[3 * i]) - place) < norm(load3(&x[3 * best]) - place)) best = i;
  }
  return best;
}

void add_force(const Vec& place, const Vec& force, std::vector<float>& to) {
  for (const double c : {place.x, place.y, place.z, force.x, force.y, force.z}) {
    to.push_back(static_cast<float>(c));
  }
}

}  // namespace

Readout::Readout(const Scene& scene, const World& world)
    : scene_(scene),
      effects_(make_effects(scene)),
      supports_(SceneSupports(scene).named()) {
  for (auto& more :
       {SceneJoints(scene).named(), SceneSupports(scene).named_on_bodies()}) {
    supports_.insert(supports_.end(), more.begin(), more.end());
  }
  find_lines(world);
  const std::vector<std::string> names = effect_names(scene);

  const auto add = [this](std::string name, std::string help) {
    series_.push_back({std::move(name), std::move(help)});
  };
  add("t_s", "time");
  for (const char* axis : {"x", "y", "z"}) {
    add(std::string("tip_") + axis + "_m",
        "tip, mean over the strands that have not failed; empty if all have");
  }
  add("kinetic_j", "kinetic energy of all strands");
  if (scene.strands.empty()) {
    add("potential_j", "potential energy, of models with a geometry of their own only");
  } else {
    add("elastic_j", "elastic energy of all strands");
    for (std::size_t i = 0; i < effects_.size(); ++i) {
      add(names[i] + "_j", "potential energy of the effect");
    }
  }
  add("stretch_rel", "largest |length/rest - 1| of a segment");
  add("penetration_m",
      "largest depth of a strand in a body since the last frame, at the ends of all "
      "steps and on paths through a body within a step. Strands are straight between "
      "their points. Paths through bodies that strands drive are left out");
  add("touching_pairs",
      "strands that come closer than the inner radius; pairs of pieces that rub");
  add("mean_distance_m", "mean distance from a strand to the nearest other one");
  if (world.mesh() != nullptr) {
    add("broken_links", "broken links of the control mesh, of " +
                            std::to_string(world.mesh()->mesh().links.size()));
    add("mesh_contacts", "points near a strip of the control mesh");
    add("control_mesh_j", "energy of the links that hold");
  }
  if (scene.failed_strands == FailedStrands::stay) {
    add("failed_strands", "strands that have failed and stay where they are");
  }
  for (const DrivenName& body : driven_body_names(scene)) {
    for (Reading& column : columns_of(body)) series_.push_back(std::move(column));
  }
  first_load_ = series_.size();
  for (const NamedSupport& support : supports_) {
    const auto add_axes = [&](bool held, const char* what, const char* unit) {
      if (!held) return;
      for (const char* axis : {"x", "y", "z"}) {
        add(fmt::format("{}_{}_{}_{}", what, support.name, axis, unit),
            fmt::format("{} of {}, along {}", what, support.acting, axis));
      }
    };
    add_axes(support.place, "force", "n");
    add_axes(support.direction, "moment", "n_m");
  }
  add("dt_s", "step, mean since the last frame");
  add("newton_per_step", "Newton iterations a step, mean since the last frame");
  add("rejected_steps", "steps tried again with shorter ones since the last frame");
  if (scene.friction() != nullptr)
    add("overlap_m", "deepest overlap of strands that rub, so far");
  channels_ = {{"curvature", "1/m"}, {"speed", "m/s"}};
  for (const std::string& name : names) channels_.push_back({"load " + name, "N/m"});

  if (scene.chooses_steps()) {
    step_channel_ = channels_.size();
    channels_.push_back({"step", "s"});
  }
  // The last one.
  if (scene.friction() != nullptr) channels_.push_back({"friction used (1: slides)", ""});

  for (const Strand& strand : scene.strands) lumps_.push_back(lumps(strand));
}

Frame3d Readout::read(World& world) {
  Frame3d frame;
  std::vector<double>& row = frame.series;
  row.assign(1, world.time());
  const std::vector<DrivenBodies::Motion> motions = world.body_motions();
  const auto bodies = models::driven_bodies(effects_);
  for (std::size_t k = 0; k < bodies.size(); ++k) bodies[k]->move_to(motions[k]);
  read_points(world, frame);
  const Energies energies = world.energies();
  row.push_back(energies.kinetic);
  row.push_back(energies.elastic);
  row.insert(row.end(), energies.effects.begin(), energies.effects.end());
  row.push_back(world.stretch());
  double depth = 0;
  for (const auto& effect : effects_) {
    depth =
        std::max(depth, effect->penetration(world.time(), world.positions()).value_or(0));
  }
  row.push_back(std::max(depth, world.take_depth()));
  const StrandInteraction* interaction = world.interaction();
  double touching = 0;
  if (interaction != nullptr)
    touching += static_cast<double>(interaction->touching_pairs());
  if (world.friction() != nullptr)
    touching += static_cast<double>(world.friction()->contacts());
  row.push_back(touching);
  row.push_back(interaction != nullptr ? interaction->mean_distance() : std::nan(""));
  if (const ControlMesh* mesh = world.mesh(); mesh != nullptr) {
    row.push_back(static_cast<double>(mesh->broken()));
    row.push_back(static_cast<double>(mesh->contacts()));
    row.push_back(mesh->energy());
  }
  if (scene_.failed_strands == FailedStrands::stay) {
    row.push_back(static_cast<double>(world.lost().size()));
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    append_motion(*bodies[k], motions[k], row);
  }
  const World::SupportLoads loads = world.support_loads();
  for (std::size_t i = 0; i < 3 * supports_.size(); i += 3) {
    const auto append = [&](bool held, const std::vector<double>& of) {
      if (held) row.insert(row.end(), &of[i], &of[i] + 3);
    };
    append(supports_[i / 3].place, loads.forces);
    append(supports_[i / 3].direction, loads.moments);
    if (i >= loads.places.size() || !supports_[i / 3].place) continue;
    const Vec force = load3(&loads.forces[i]);
    if (is_finite(force)) add_force(load3(&loads.places[i]), force, frame.reactions);
  }
  const Stats now = world.stats();
  const auto steps = static_cast<double>(now.steps - before_.steps);
  const auto iterations =
      static_cast<double>(now.newton_iterations - before_.newton_iterations);
  // Per system: all advance through the same time, which the last frame may shorten.
  const std::size_t last = scene_.last_frame();
  const double interval = world.time() < scene_.duration || last == 0
                              ? 1 / scene_.frame_rate
                              : scene_.duration - scene_.time_of(last - 1);
  row.push_back(steps > 0 ? interval * static_cast<double>(world.systems()) / steps
                          : std::nan(""));
  row.push_back(iterations / steps);
  read_steps(world, interval, frame);
  row.push_back(static_cast<double>(now.rejected - before_.rejected));
  if (world.friction() != nullptr) row.push_back(world.friction()->deepest());
  before_ = now;
  return frame;
}

/// The mean step of each strand since the last frame, at all its points; 0 in the first.
void Readout::read_steps(const World& world, double interval, Frame3d& frame) {
  if (!step_channel_) return;
  std::vector<long> steps = world.steps();
  steps_before_.resize(steps.size());
  std::vector<float> of_points;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const long taken = steps[k] - steps_before_[k];
    const double step = taken > 0 ? interval / static_cast<double>(taken) : 0;
    of_points.insert(of_points.end(), static_cast<std::size_t>(world.points()[k]),
                     static_cast<float>(step));
  }
  steps_before_ = std::move(steps);
  std::ranges::copy(at_drawn(of_points),
                    frame.channels.begin() +
                        static_cast<std::ptrdiff_t>(*step_channel_ * drawn_.size()));
}

std::vector<NamedLoad> Readout::support_loads(const Frame3d& frame) const {
  std::vector<NamedLoad> all;
  std::size_t column = first_load_;
  const auto next = [&](bool held) {
    column += held ? 3 : 0;
    return held ? std::optional(load3(&frame.series[column - 3])) : std::nullopt;
  };
  for (const NamedSupport& support : supports_) {
    all.push_back({support.name, next(support.place), next(support.direction)});
  }
  return all;
}

std::vector<float> Readout::at_drawn(const std::vector<float>& of_points) const {
  std::vector<float> drawn;
  for (const std::size_t i : drawn_) drawn.push_back(of_points[i]);
  return drawn;
}

void Readout::find_lines(const World& world) {
  const std::vector<int>& before = world.before();
  for (std::size_t i = 0; i < before.size(); ++i) {
    const int from = before[i];
    if (from < 0 || drawn_.empty() || static_cast<std::size_t>(from) != drawn_.back()) {
      lines_.push_back(0);
      if (from >= 0) {
        drawn_.push_back(static_cast<std::size_t>(from));
        ++lines_.back();
      }
    }
    drawn_.push_back(i);
    ++lines_.back();
  }
}

void Readout::read_points(World& world, Frame3d& frame) {
  const std::vector<double>& x = world.positions();
  const std::vector<double>& u = world.velocities();
  for (const std::size_t i : drawn_) {
    for (std::size_t c = 0; c < 3; ++c) {
      frame.positions.push_back(static_cast<float>(x[3 * i + c]));
    }
  }
  frame.channels.assign(channels_.size() * drawn_.size(), 0.0F);
  std::size_t first = 0;
  for (const int line : lines_) {
    const auto points = static_cast<std::size_t>(line);
    const auto at = [&](std::size_t i) { return load3(&x[3 * drawn_[first + i]]); };
    for (std::size_t i = 0; i < points; ++i) {
      const double bent = line_curvature(at, i, points);
      const double speed = norm(load3(&u[3 * drawn_[first + i]]));
      frame.channels[first + i] = static_cast<float>(bent);
      frame.channels[drawn_.size() + first + i] = static_cast<float>(speed);
    }
    first += points;
  }
  if (world.friction() != nullptr) {
    // The last channel; before the first step there is none.
    const std::vector<double> used = world.friction()->friction_used();
    std::ranges::copy(used,
                      frame.channels.end() - static_cast<std::ptrdiff_t>(drawn_.size()));
  }
  const std::vector<ContactForce> contacts = world.contact_forces();
  Vec tip;
  std::size_t end = 0;
  for (std::size_t k = 0; k < world.strands(); ++k) {
    const auto points = static_cast<std::size_t>(world.points()[k]);
    if (points == 0) continue;
    // Strands are separate lines.
    if (!scene_.strands.empty()) read_loads(world, k, end, contacts, frame);
    end += points;
    if (!world.lost(k)) tip = tip + load3(&x[3 * (end - 1)]);
  }
  // Without any left they are no numbers, and their cells are empty.
  if (world.strands() > 0) {
    tip = 1 / static_cast<double>(world.strands() - world.lost().size()) * tip;
  }
  for (const double component : {tip.x, tip.y, tip.z}) frame.series.push_back(component);
}

/// Loads of the effects on the material points, over the length that each represents.
/// Those of contact, which may act between the material points, on the nearest ones.
void Readout::read_loads(World& world, std::size_t k, std::size_t first,
                         std::span<const ContactForce> contacts, Frame3d& frame) {
  const std::size_t count = drawn_.size();
  const auto points = static_cast<std::size_t>(world.points()[k]);
  const In x = In(world.positions()).subspan(3 * first, 3 * points);
  const In u = In(world.velocities()).subspan(3 * first, 3 * points);
  tangent_.resize(3 * points);
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t from = i == 0 ? 0 : i - 1, to = std::min(i + 1, points - 1);
    const Vec d = load3(&x[3 * to]) - load3(&x[3 * from]);
    store3((1 / norm(d)) * d, &tangent_[3 * i]);
  }
  const Points p = lumps_[k].points(x, u, tangent_);
  std::vector<double> load(3 * points);
  std::size_t channel = 2;
  const auto read = [&](const auto& add_load) {
    std::ranges::fill(load, 0.0);
    add_load(load);
    for (std::size_t i = 0; i < points; ++i) {
      frame.channels[channel * count + first + i] =
          static_cast<float>(norm(load3(&load[3 * i])) / lumps_[k].length[i]);
    }
    ++channel;
  };
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    if (!effects_[e]->contact()) {
      read([&](InOut f) { effects_[e]->add_load(world.time(), p, f); });
      continue;
    }
    read([&](InOut f) {
      auto contact = std::ranges::lower_bound(contacts, k, {}, &ContactForce::strand);
      for (; contact != contacts.end() && contact->strand == k; ++contact) {
        if (contact->effect != e) continue;
        const std::size_t at = nearest(contact->place, x);
        store3(load3(&f[3 * at]) + contact->force, &f[3 * at]);
        add_force(contact->place, contact->force, frame.contacts);
      }
    });
  }
  const auto read_between = [&](const auto& add_load) {
    read(add_load);
    for (std::size_t i = 0; i < points; ++i) {
      const Vec force = load3(&load[3 * i]);
      if (norm(force) > 0) add_force(load3(&x[3 * i]), force, frame.contacts);
    }
  };
  // Effects between strands come after the others, in alphabetical order.
  if (world.mesh() != nullptr) {
    const auto effect = world.mesh()->effect(k);
    read_between([&](InOut f) { effect->add_load(world.time(), p, f); });
  }
  if (world.friction() != nullptr) {
    read_between([&](InOut f) { world.friction()->add_loads(k, f); });
  }
  if (world.interaction() != nullptr) {
    const auto effect = world.interaction()->effect(k);
    read_between([&](InOut f) { effect->add_load(world.time(), p, f); });
  }
}

}  // namespace tress::simulation
