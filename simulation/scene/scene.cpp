#include "simulation/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "integrators/integrator_options.h"
#include "models/effects/strand_interaction.h"
#include "simulation/files/parse.h"
#include "simulation/scene/groom.h"
#include "simulation/scene/read_table.h"
#include "simulation/scene/scene_check.h"
#include "simulation/scene/scene_tables.h"

namespace tress {
namespace {

constexpr std::size_t most_strands = 10'000, most_elements = 200'000;
constexpr std::size_t most_effects = 1000;
constexpr double most_frames = 1e6;

constexpr std::string_view tables[] = {"model", "integrator", "material", "strand",
                                       "groom", "root",       "effects"};
constexpr std::string_view material_table[] = {"material"};

/// A scene being read: the parsed text and what of it is understood so far.
class Reader {
 public:
  Reader(const std::string& text, const std::string& file)
      : file_(file), root_(parse_toml(text, file)) {}

  Scene read() {
    read_top();
    read_model();
    read_integrator();
    if (scene_.model->on_strand != nullptr) {
      read_strands();
      read_effects();
    } else {
      refuse_strand_tables();
    }
    check(scene_, places_);
    return std::move(scene_);
  }

 private:
  const toml::table* table(std::string_view name) const {
    const toml::node* node = root_.get(name);
    return node == nullptr ? nullptr : &as_table(*node, std::string(name), file_);
  }

  /// The table, or its defaults where the scene has none.
  Table read_or_default(const std::string& name, std::span<const Parameter> declared) {
    const toml::table* given = table(name);
    if (given == nullptr) return Table(declared, "[" + name + "]", file_ + ":1:1");
    return read_table(*given, declared, "[" + name + "]", file_);
  }

  /// [name] as one, [[name]] as all of them.
  std::vector<const toml::table*> each(const toml::node& node, const std::string& name,
                                       bool many) const {
    const toml::array* list = node.as_array();
    if (list == nullptr) return {&as_table(node, name, file_)};
    const std::string place = place_of(node.source(), file_);
    if (!many) {
      throw InputError(fmt::format("several [[{}]]", name), place,
                       fmt::format("give one [{}]", name));
    }
    std::vector<const toml::table*> all;
    for (const toml::node& one : *list) all.push_back(&as_table(one, name, file_));
    return all;
  }

  void read_top() {
    const Table top = read_table(root_, top_parameters(), "the scene", file_, tables);
    const Parameters& p = top.values();
    scene_.name = std::filesystem::path(file_).stem().string();
    scene_.title = p.word("title");
    scene_.source = p.word("source");
    if (scene_.title.empty()) {
      throw InputError("a scene without a title", file_ + ":1:1",
                       "begin it with title = \"...\"");
    }
    scene_.duration = p.number("duration_s");
    scene_.frame_rate = p.number("frames_1_s");
    scene_.checkpoint = p.number("checkpoint_s");
    scene_.guard = p.word("guard") == "true";
    scene_.seed = static_cast<std::uint64_t>(p.number("seed"));
    if (scene_.duration * scene_.frame_rate <= most_frames) return;
    throw InputError(
        fmt::format("{:.0f} frames", scene_.duration * scene_.frame_rate),
        top.place("frames_1_s"),
        fmt::format("give frames_1_s times duration_s up to {:.0f}", most_frames));
  }

  void read_model() {
    // Which keys belong here depends on the id, which alone is read first.
    Table id(model_table_parameters(models().front()).first(1), "[model]", "");
    if (const toml::table* given = table("model")) read_key(*given, "id", file_, id);
    const ModelEntry* model = &find_model(id.values().word("id"));
    const Table options = read_or_default("model", model_table_parameters(*model));
    scene_.model = model;
    scene_.model_options = options.values();
    places_.model = options.place("id");
  }

  void read_integrator() {
    const Table read = read_or_default("integrator", integrator_table_parameters());
    read.refuse_unused("id", integrator_uses());
    scene_.integrator = read.values().word("id");
    places_.integrator = read.place("id");
    for (const Parameter& p : read.declared()) {
      if (p.name == "id" || !read.given(p.name)) continue;
      const std::string_view option = p.name == "dt_s" ? "step" : p.name;
      apply(scene_.options, option, read.text(p.name), read.place(p.name));
    }
  }

  void refuse_strand_tables() const {
    for (const std::string_view name :
         {"strand", "groom", "material", "root", "effects"}) {
      const toml::node* node = root_.get(name);
      if (node == nullptr) continue;
      throw InputError(fmt::format("[{}] is not for {}, which brings its own geometry",
                                   name, scene_.model->id),
                       place_of(node->source(), file_),
                       "leave the table out, [model] takes all there is");
    }
  }

  void read_strands() {
    const Table material = read_or_default("material", material_table_parameters());
    const Table root = read_or_default("root", root_table_parameters());
    scene_.head = head_motion(root);
    const std::optional<FreeRoot> free_root = free_motion(root);
    const Common common{material, scene_.head, free_root, scene_.seed};
    read_each("strand", strand_table_parameters(), [&](const Table& t, const Table* own) {
      add({scene_strand(t, own, common, scene_.strands.size())}, t);
    });
    read_each("groom", groom_table_parameters(), [&](const Table& t, const Table* own) {
      const auto each = static_cast<std::size_t>(t.values().whole("elements"));
      const std::size_t most = std::min(most_strands - scene_.strands.size(),
                                        (most_elements - elements_) / each);
      add(groom_strands(t, own, common, scene_.strands.size(), most), t);
    });
    if (scene_.strands.empty()) {
      throw InputError("a scene without strands", file_ + ":1:1",
                       "give a [strand], or a [groom] for many");
    }
  }

  /// Every [name] or [[name]] and its [name.material], if any.
  template <class F>
  void read_each(const std::string& name, std::span<const Parameter> declared,
                 const F& use) {
    const toml::node* node = root_.get(name);
    if (node == nullptr) return;
    for (const toml::table* one : each(*node, name, true)) {
      const Table read =
          read_table(*one, declared, "[" + name + "]", file_, material_table);
      const toml::node* own = one->get("material");
      if (own == nullptr) {
        use(read, nullptr);
        continue;
      }
      const std::string own_name = name + ".material";
      const Table material =
          read_table(as_table(*own, own_name, file_), material_table_parameters(),
                     "[" + own_name + "]", file_);
      use(read, &material);
    }
  }

  void add(std::vector<Strand> strands, const Table& table) {
    for (Strand& strand : strands) {
      elements_ += strand.segments.size();
      scene_.strands.push_back(std::move(strand));
      places_.strands.push_back(table.place());
    }
    if (scene_.strands.size() <= most_strands && elements_ <= most_elements) return;
    throw InputError(fmt::format("{} strands of {} elements altogether",
                                 scene_.strands.size(), elements_),
                     table.place(),
                     fmt::format("give at most {} strands and {} elements", most_strands,
                                 most_elements));
  }

  void read_effects() {
    const toml::table* all = table("effects");
    if (all == nullptr) return;
    for (const auto& [key, node] : *all) {
      if (key.str() == interaction_id) {
        read_interaction(node);
      } else {
        read_effect(key, node);
      }
    }
  }

  void read_effect(const toml::key& key, const toml::node& node) {
    const std::string where = place_of(key.source(), file_);
    const std::string_view others[] = {interaction_id};
    if (!nearest(key.str(), others).empty()) {
      throw InputError(fmt::format("unknown effect '{}'", one_line(key.str())), where,
                       fmt::format("did you mean '{}'?", interaction_id));
    }
    const EffectEntry& entry = find_effect(one_line(key.str()), where);
    const std::string name = fmt::format("effects.{}", entry.id);
    for (const toml::table* one : each(node, name, entry.many)) {
      const Table read =
          read_table(*one, entry.parameters, fmt::format("[{}]", name), file_);
      scene_.effects.push_back({&entry, read.values()});
      places_.effects.push_back(read.place());
      if (scene_.effects.size() > most_effects) {
        throw InputError(fmt::format("more than {} effects", most_effects), read.place(),
                         "leave some out");
      }
    }
  }

  void read_interaction(const toml::node& node) {
    const std::string name = fmt::format("effects.{}", interaction_id);
    const Table read = read_table(as_table(node, name, file_),
                                  strand_interaction_parameters(), name, file_);
    scene_.interaction = read.values();
    places_.interaction = read.place();
  }

  const std::string& file_;
  const toml::table root_;
  Scene scene_;
  ScenePlaces places_;
  std::size_t elements_ = 0;
};

}  // namespace

std::size_t Scene::last_frame() const {
  // 1e-9: a whole number of frames up to rounding is not one more.
  return static_cast<std::size_t>(std::ceil(duration * frame_rate - 1e-9));
}

Scene read_scene(const std::string& file) {
  return parse_scene(read_file(file, most_toml_bytes), file);
}

std::vector<Scene> read_scenes(const std::vector<std::string>& files) {
  std::vector<Scene> all;
  for (const std::string& file : files) {
    Scene scene = read_scene(file);
    if (std::ranges::find(all, scene.name, &Scene::name) != all.end()) {
      throw InputError("two scenes of one name", file, "rename one of them");
    }
    all.push_back(std::move(scene));
  }
  return all;
}

Scene parse_scene(const std::string& text, const std::string& file) {
  return Reader(text, file).read();
}

}  // namespace tress
