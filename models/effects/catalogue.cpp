#include "models/effects/catalogue.h"

#include <array>
#include <string>
#include <vector>

#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"
#include "models/effects/self_contact.h"
#include "models/input_error.h"

namespace tress {

// clang-format off
std::span<const EffectEntry> effects() {
  static const std::array entries = {
      EffectEntry{"gravity", "uniform acceleration of all mass", "Newton", gravity_parameters(), make_gravity},
      EffectEntry{"linear_drag", "force against the velocity, per length and per mass", "Bertails 2006, section 4.2", linear_drag_parameters(), make_linear_drag},
      EffectEntry{"self_contact", "repulsion and drag between parts of a strand far apart along it", "law of Wang, thesis, NCTU, section 5.2", self_contact_parameters(), make_self_contact},
  };
  return entries;
}
// clang-format on

const EffectEntry& find_effect(std::string_view id, const std::string& where) {
  std::vector<std::string_view> ids;
  for (const EffectEntry& entry : effects()) {
    if (entry.id == id) return entry;
    ids.push_back(entry.id);
  }
  std::string all;
  for (const std::string_view one : ids)
    all += (all.empty() ? "" : ", ") + std::string(one);
  const std::string_view near = nearest(id, ids);
  throw InputError(
      "unknown effect '" + std::string(id) + "'", where,
      near.empty() ? "use one of: " + all : "did you mean '" + std::string(near) + "'?");
}

}  // namespace tress
