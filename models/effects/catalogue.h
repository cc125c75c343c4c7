#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "contract/parameters.h"
#include "models/effects/effect.h"

namespace tress::models {

struct RootMotion;

/// Parameters that apply to one value of another one, separated by '|'. Those that are
/// named for no value always apply.
struct EffectUse {
  std::string_view choice, word, keys;  // the other one, its value, the parameters
};

/// One line of the list of effects, which a scene names as [effects.id]. `./tress new
/// effect` adds one.
struct EffectEntry {
  std::string_view id;                    // id in scenes
  std::string_view summary;               // one line
  std::string_view source;                // author and year
  std::span<const Parameter> parameters;  // parameters of the effect
  /// `head`: the rigid motion of all roots, for bodies that follow it. Null for
  /// effects between strands, which are made for all of them at once (StrandInteraction,
  /// StrandFriction, ControlMesh).
  std::unique_ptr<const Effect> (*make)(const Parameters&, const RootMotion& head);
  bool many = false;                     // a scene may name several: [[effects.id]]
  bool contact = false;                  // its load begins where parts meet
  std::span<const EffectUse> uses = {};  // of its parameters
};

/// Returns the effects of tress, then those of plug-ins.
std::span<const EffectEntry> effects();
std::span<const EffectEntry> added_effects();  // those of plug-ins

/// Before the catalogue is first read. Throws InputError naming `where` if it has been,
/// on an id that another effect has, and on an entry that cannot be used.
void add_effect(const EffectEntry& effect, const std::string& where);

/// Throws InputError naming `where` and the nearest id if there is no such effect.
const EffectEntry& find_effect(std::string_view id, const std::string& where);

}  // namespace tress::models
