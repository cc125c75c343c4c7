#include "simulation/scene_changes/changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "simulation/groom/guide_choice.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/scene_tables.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/typical_strands.h"

namespace tress::simulation {
namespace {

/// Each half is attached to the other half of its segment, or to the second half of the
/// segment's parent.
Strand halved(const Strand& strand) {
  Strand fine = strand;
  fine.segments.clear();
  for (const Segment& whole : strand.segments) {
    Segment first = whole;
    first.length /= 2;
    first.parent = whole.parent < 0 ? -1 : 2 * whole.parent + 1;
    Segment second = first;
    second.parent = static_cast<int>(fine.segments.size());
    second.mount = {};
    fine.segments.push_back(first);
    fine.segments.push_back(second);
  }
  return fine;
}

/// Replaces the value of the model's option `modes`.
Ingredient mode(const std::string& name, const std::string& word) {
  return {name,
          [word](const Scene& scene) {
            Scene changed = scene;
            changed.model_options.set("modes", word);
            return changed;
          },
          {}};
}

void set_driven(Scene& scene, DrivenTables driven) {
  if (scene.tables == nullptr) return;
  auto tables = std::make_shared<StrandTables>(*scene.tables);
  tables->driven = std::move(driven);
  scene.tables = std::move(tables);
}

/// Table `i` of a list in [effects]: `name`, `name`_2, ...
Ingredient driven(const std::string& name, std::vector<Table> DrivenTables::*list,
                  std::size_t i) {
  return {i == 0 ? name : name + "_" + std::to_string(i + 1),
          [list, i](const Scene& from) {
            Scene changed = from;
            DrivenTables left = from.tables->driven;
            (left.*list).erase((left.*list).begin() + static_cast<std::ptrdiff_t>(i));
            set_driven(changed, std::move(left));
            return changed;
          },
          [list, i](const Scene& from) {
            Scene changed = bare(from);
            DrivenTables alone;
            (alone.*list).push_back((from.tables->driven.*list)[i]);
            set_driven(changed, std::move(alone));
            return changed;
          }};
}

template <class Change>
Scene cut_anew(Scene scene, const Change& changed) {
  if (!describe_strands(scene.tables.get())) {
    throw std::logic_error("strands without a table cannot be remeshed");
  }
  auto tables = std::make_shared<StrandTables>(changed(*scene.tables));
  CutStrands cut = StrandSeries(tables, scene.head, scene.seed, held_at_once).all();
  scene.strands = std::move(cut.strands);
  scene.followers = std::move(cut.followers);
  scene.fitted = std::move(cut.fitted);
  scene.tables = std::move(tables);
  return scene;
}

/// change(table, strands of the table, strands of all) for every groom.
template <class Change>
Scene with_grooms(Scene scene, const Change& change) {
  const StrandSeries series(scene.tables, scene.head, scene.seed, made_singly);
  return cut_anew(std::move(scene), [&](StrandTables tables) {
    for (std::size_t i = 0; i < tables.sources.size(); ++i) {
      const std::size_t strands = series.first()[i + 1] - series.first()[i];
      if (tables.sources[i].groom)
        change(tables.sources[i].table, strands, series.size());
    }
    return tables;
  });
}

/// Of [[supports]].
std::size_t strand_of(const Table& support) {
  return static_cast<std::size_t>(support.values().whole("strand"));
}

void set_whole(Table& table, const std::string& key, std::size_t value) {
  table.set(key, std::to_string(value), table.place(key));
}

/// Replaces the names of strands in joints by their numbers.
void number_joints(StrandTables& tables) {
  for (Table& joint : tables.joints) {
    for (const std::string key : {"a", "b"}) {
      const std::vector<std::string> end = names_of(joint.values().word(key));
      const auto named = std::ranges::find_if(tables.sources, [&](const auto& source) {
        return !source.groom && source.table.values().word("name") == end.front();
      });
      if (named == tables.sources.end() || end.size() != 2) continue;
      joint.set(key, fmt::format("{},{}", named - tables.sources.begin(), end[1]),
                joint.place(key));
    }
  }
}

/// `part` of `whole`, for `count` of them; one at least.
std::size_t share_of(std::size_t part, std::size_t whole, std::size_t count) {
  const double exact =
      static_cast<double>(part) * static_cast<double>(count) / static_cast<double>(whole);
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::round(exact)), 1, count);
}

}  // namespace

std::string_view Method::word(std::string_view choice) const {
  for (const auto& [key, value] : options) {
    if (key == choice) return value;
  }
  for (const Parameter& p : model->parameters) {
    if (p.name == choice && !p.choices.empty()) return words_of(p.choices).front();
  }
  return {};
}

Scene with_method(Scene scene, const Method& method) {
  scene.model = method.model;
  scene.model_options = Parameters(model_table_parameters(*method.model), "[model]");
  scene.model_options.set("id", method.model->id);
  for (const auto& [key, value] : method.options) scene.model_options.set(key, value);
  scene.integrator = method.integrator;
  Options options;
  options.step = scene.options.step;
  options.formulation = method.formulation;
  scene.options = options;
  return scene;
}

Scene with_elements(Scene scene, int elements) {
  return cut_anew(std::move(scene), [elements](const StrandTables& tables) {
    return with_elements(tables, elements);
  });
}

Scene with_elements_of_strands(Scene scene, std::span<const int> elements) {
  return cut_anew(std::move(scene), [elements](const StrandTables& tables) {
    return with_elements(tables, elements);
  });
}

Scene with_elements_at_rest(Scene scene, int elements) {
  const bool linear = scene.model->id == "super_clothoid";
  return cut_anew(std::move(scene), [&](const StrandTables& tables) {
    return with_cuts(with_elements(tables, elements), linear ? "rest_linear" : "rest");
  });
}

bool may_cut_at_rest(const Scene& scene) {
  return describe_strands(scene.tables.get()) &&
         std::ranges::all_of(scene.strands,
                             [](const Strand& strand) { return !strand.free_root; }) &&
         std::ranges::all_of(scene.tables->sources, [](const StrandSource& source) {
           const Parameters& p = source.table.values();
           return !source.groom && p.numbers("points").empty() &&
                  p.number("grading") == 1 && p.word("mesh") == "grading";
         });
}

Scene with_twice_the_elements(Scene scene) {
  return cut_anew(std::move(scene), [](const StrandTables& tables) {
    return with_twice_the_elements(tables);
  });
}

Scene every_strand(Scene scene, std::size_t most) {
  return with_grooms(std::move(scene),
                     [most](Table& groom, std::size_t strands, std::size_t all) {
                       set_whole(groom, "guides", 0);
                       clear_detail(groom);
                       if (all <= most) return;
                       if (groom.values().word("file").empty()) {
                         set_whole(groom, "density_per_m2", 0);
                       }
                       set_whole(groom, "count", share_of(most, all, strands));
                     });
}

Scene with_guides(Scene scene, std::size_t guides) {
  return with_grooms(std::move(scene),
                     [guides](Table& groom, std::size_t strands, std::size_t all) {
                       const std::size_t own = share_of(guides, all, strands);
                       set_whole(groom, "guides", own == strands ? 0 : own);
                     });
}

std::vector<std::size_t> guides_of(const Scene& scene, std::size_t guides) {
  const StrandSeries series(scene.tables, scene.head, scene.seed, held_at_once);
  const std::span<const Strand> all = scene.strands;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i + 1 < series.first().size(); ++i) {
    const std::size_t first = series.first()[i], count = series.first()[i + 1] - first;
    for (const std::size_t k :
         choose_guides(all.subspan(first, count), share_of(guides, all.size(), count),
                       scene.seed)) {
      chosen.push_back(first + k);
    }
  }
  return chosen;
}

Scene with_strands(Scene scene, std::vector<Strand> strands) {
  scene.strands = std::move(strands);
  if (scene.tables != nullptr) {
    auto tables = std::make_shared<StrandTables>(*scene.tables);
    number_joints(*tables);
    tables->sources.clear();
    scene.tables = std::move(tables);
  }
  return scene;
}

std::vector<Ingredient> ingredients(const Scene& scene) {
  const std::vector<std::string> names = effect_names(scene);
  std::vector<Ingredient> all;
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    all.push_back({names[i],
                   [i](const Scene& from) {
                     Scene changed = from;
                     changed.effects.erase(changed.effects.begin() +
                                           static_cast<std::ptrdiff_t>(i));
                     return changed;
                   },
                   [i](const Scene& from) {
                     Scene changed = bare(from);
                     changed.effects.push_back(from.effects[i]);
                     return changed;
                   }});
  }
  if (scene.tables != nullptr) {
    const DrivenTables& of = scene.tables->driven;
    for (std::size_t i = 0; i < of.moments.size(); ++i) {
      all.push_back(driven("point_moment", &DrivenTables::moments, i));
    }
    for (std::size_t i = 0; i < of.shapes.size(); ++i) {
      all.push_back(driven("natural_shape", &DrivenTables::shapes, i));
    }
  }
  if (scene.model_options.knows("modes")) {
    const std::string_view modes = scene.model_options.word("modes");
    if (modes == "bend_twist") all.push_back(mode("mode twist", "bend"));
    if (modes != "bend_planar")
      all.push_back(mode("mode second bending plane", "bend_planar"));
  }
  return all;
}

Scene bare(Scene scene) {
  scene.effects.clear();
  set_driven(scene, {});
  return scene;
}

Scene thinned(Scene scene, std::size_t most) {
  if (scene.strands_touch() || !SceneJoints(scene).groups().empty()) return scene;
  if (scene.strands.size() <= most) return scene;
  const auto typical = typical_strands(scene.strands, most);
  return only(std::move(scene), typical);
}

Scene only(Scene scene, const std::vector<std::size_t>& strands) {
  std::vector<Strand> chosen;
  chosen.reserve(strands.size());
  for (const std::size_t i : strands) chosen.push_back(scene.strands[i]);
  scene = with_strands(std::move(scene), std::move(chosen));
  if (scene.tables == nullptr) return scene;
  refuse_if(!scene.tables->joints.empty(), "some of the strands that [[joints]] join",
            "scene " + scene.name, "take all strands, or a scene without [[joints]]");
  StrandTables tables = *scene.tables;
  std::erase_if(tables.supports, [&](const Table& support) {
    return std::ranges::count(strands, strand_of(support)) == 0;
  });
  for (Table& support : tables.supports) {
    const auto number = std::ranges::find(strands, strand_of(support)) - strands.begin();
    set_whole(support, "strand", static_cast<std::size_t>(number));
  }
  scene.tables = std::make_shared<const StrandTables>(std::move(tables));
  return scene;
}

Scene refined(Scene scene) {
  scene.options.step /= 2;
  scene.options.tolerance /= 4;  // as the error of halved elements
  std::vector<Strand> fine;
  for (const Strand& strand : scene.strands) fine.push_back(halved(strand));
  return with_strands(std::move(scene), std::move(fine));
}

}  // namespace tress::simulation
