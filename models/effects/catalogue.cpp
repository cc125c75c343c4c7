#include "models/effects/catalogue.h"

#include <string>
#include <vector>

#include "contract/open_catalogue.h"
#include "models/effects/body.h"
#include "models/effects/constant_force.h"
#include "models/effects/control_mesh.h"
#include "models/effects/distributed_load.h"
#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"
#include "models/effects/point_force.h"
#include "models/effects/ring.h"
#include "models/effects/self_contact.h"
#include "models/effects/strand_friction.h"
#include "models/effects/strand_interaction.h"
#include "models/effects/tether.h"
#include "models/effects/wind.h"

namespace tress::models {

// Each is defined in its effect's file.

namespace {

// clang-format off
std::vector<EffectEntry> built_in_effects() {
  return {
      EffectEntry{"gravity", "uniform acceleration of all mass", "Newton", gravity_parameters(), make_gravity},
      EffectEntry{"linear_drag", "force against the velocity, per length and per mass", "Bertails 2006, section 4.2", linear_drag_parameters(), make_linear_drag},
      EffectEntry{"constant_force", "uniform force per length and per mass", "Newton", constant_force_parameters(), make_constant_force},
      EffectEntry{"quadratic_drag", "drag of still air in the square of the speed, across and along the strand", "Ablow & Schechter 1983; White, Viscous Fluid Flow", quadratic_drag_parameters(), make_quadratic_drag, false, false, quadratic_drag_uses()},
      EffectEntry{"wind", "load of moving air: steady, sine or gusts", "Ablow & Schechter 1983; Bridson et al. 2007; Kraichnan 1970", wind_parameters(), make_wind, false, false, wind_uses()},
      EffectEntry{"point_force", "force on one place of a strand, dead or along its tangent, constant or over time", "Beck 1952 (follower force)", point_force_parameters(), make_point_force, true},
      EffectEntry{"distributed_load", "force per length on a part of a strand, dead, along its tangent or across it, constant or over time", "Leipholz 1980 (follower load)", distributed_load_parameters(), make_distributed_load, true},
      EffectEntry{"ring", "elastic ring through which a strand slides without friction", "Hooke", ring_parameters(), make_ring, true},
      EffectEntry{"tether", "spring, damper and pull of one point towards a moving place", "Hooke", tether_parameters(), make_tether, true},
      EffectEntry{"body", "contact with a rigid body, with friction", "Hunt & Crossley 1975; Li et al. 2020, eq. 15; Alart & Curnier 1991", body_parameters(), make_body, true, true, body_uses()},
      EffectEntry{"self_contact", "repulsion and drag between parts of a strand far apart along it", "law of Wang, thesis, NCTU, section 5.2", self_contact_parameters(), make_self_contact, false, true},
      EffectEntry{"control_mesh", "guides tied to their neighbours by breakable links, with strips of triangles between them that others touch", "Chang, Jin & Yu 2002", control_mesh_parameters(), nullptr, false, true},
      EffectEntry{"strand_friction", "strands, and parts of one, do not pass through each other and rub: exact contact", "Moreau 1999; de Saxcé & Feng 1998", strand_friction_parameters(), nullptr, false, true},
      EffectEntry{"strand_interaction", "strands repel and drag each other", "Wang, thesis, NCTU", strand_interaction_parameters(), nullptr, false, true},
  };
}
// clang-format on

OpenCatalogue<EffectEntry>& all_effects() {
  static OpenCatalogue<EffectEntry> all("effect", built_in_effects());
  return all;
}

}  // namespace

std::span<const EffectEntry> effects() {
  static const std::span<const EffectEntry> closed = all_effects().close();
  return closed;
}

std::span<const EffectEntry> added_effects() { return all_effects().added(); }

void add_effect(const EffectEntry& effect, const std::string& where) {
  refuse_if(effect.make == nullptr,
            "effect '" + std::string(effect.id) + "' cannot be made", where,
            "set EffectEntry::make; an effect between strands cannot be a plug-in");
  all_effects().add(effect, where);
}

const EffectEntry& find_effect(std::string_view id, const std::string& where) {
  std::vector<std::string_view> ids;
  for (const EffectEntry& entry : effects()) {
    if (entry.id == id) return entry;
    ids.push_back(entry.id);
  }
  std::string all;
  for (const std::string_view one : ids)
    all += (all.empty() ? "" : ", ") + std::string(one);
  throw InputError("unknown effect '" + std::string(id) + "'", where,
                   suggestion(id, ids, "use one of: " + all));
}

}  // namespace tress::models
