#include "simulation/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "contract/shipped_file.h"
#include "integrators/integrator_options.h"
#include "models/effects/obstacle.h"
#include "models/strand/geometry.h"
#include "simulation/scene/file_groom.h"
#include "simulation/scene/gradient_table.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/root_table.h"
#include "simulation/scene/scene_check.h"
#include "simulation/scene/scene_tables.h"
#include "simulation/scene/strand_table.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_table.h"
#include "simulation/table/directions.h"
#include "simulation/table/read_table.h"

namespace tress::simulation {
namespace {

constexpr std::size_t most_effects = 1000, most_groom_files = 100;
constexpr double most_frames = 1e6;

constexpr std::string_view known_tables[] = {
    "model", "integrator", "material", "strand",   "groom",
    "root",  "effects",    "gradient", "supports", "joints"};
constexpr std::string_view material_table[] = {"material"};

/// A scene being read: the parsed text and the part interpreted so far.
class Reader {
 public:
  Reader(const std::string& text, const std::string& file)
      : file_(file), root_(parse_toml(text, file)) {}

  Scene read() { return read(false); }

  SceneOutline read_outline() {
    SceneOutline outline;
    outline.scene = read(true);
    outline.series = std::move(series_);
    return outline;
  }

 private:
  /// `outlined`: with the first strand of each table only.
  Scene read(bool outlined) {
    read_top();
    read_model();
    read_integrator();
    if (scene_.model->on_strand != nullptr) {
      read_strands(outlined);
      read_effects();
      if (scene_.tables->gradient) gradient_parameters(scene_);
    } else {
      refuse_strand_tables();
    }
    check(scene_, places_, series_ == nullptr ? 0 : series_->size());
    return std::move(scene_);
  }

  const toml::table* table(std::string_view name) const {
    const toml::node* node = root_.get(name);
    return node == nullptr ? nullptr : &as_table(*node, std::string(name), file_);
  }

  /// The table, or its defaults if the scene has none.
  Table read_or_default(const std::string& name, std::span<const Parameter> declared) {
    const toml::table* given = table(name);
    if (given == nullptr) return Table(declared, "[" + name + "]", file_ + ":1:1");
    return read_table(*given, declared, "[" + name + "]", file_);
  }

  std::vector<const toml::table*> each(const toml::node& node, const std::string& name,
                                       bool many) const {
    return tables_of(node, name, many, file_);
  }

  void read_top() {
    const Table top =
        read_table(root_, top_parameters(), "the scene", file_, known_tables);
    const Parameters& p = top.values();
    scene_.name = std::filesystem::path(file_).stem().string();
    scene_.title = p.word("title");
    scene_.source = p.word("source");
    if (scene_.title.empty()) {
      throw InputError("a scene without a title", file_ + ":1:1",
                       "begin it with title = \"...\"");
    }
    scene_.duration = p.number("duration_s");
    scene_.frame_rate = p.number("frames_per_s");
    scene_.checkpoint = p.number("checkpoint_s");
    scene_.guard = p.word("guard") == "true";
    scene_.seed = static_cast<std::uint64_t>(p.number("seed"));
    scene_.rest =
        p.word("rest") == "inverse" ? RestStrains::inverse : RestStrains::natural;
    scene_.unstable = p.word("unstable") == "stiffen" ? Unstable::stiffen
                      : p.word("unstable") == "keep"  ? Unstable::keep
                                                      : Unstable::drop;
    scene_.failed_strands =
        p.word("failed_strands") == "stay" ? FailedStrands::stay : FailedStrands::end_run;
    places_.failed_strands = top.place("failed_strands");
    if (scene_.rest == RestStrains::natural && top.given("unstable")) {
      throw InputError("unstable has no effect without rest = \"inverse\"",
                       top.place("unstable"), "leave it out");
    }
    places_.rest = top.place("rest");
    if (scene_.duration * scene_.frame_rate <= most_frames) return;
    throw InputError(
        fmt::format("{:.0f} frames", scene_.duration * scene_.frame_rate),
        top.place("frames_per_s"),
        fmt::format("give frames_per_s times duration_s up to {:.0f}", most_frames));
  }

  void read_model() {
    // The valid keys depend on the id, which is therefore read first.
    Table id(model_table_parameters(model_catalogue().front()).first(1), "[model]", "");
    if (const toml::table* given = table("model")) read_key(*given, "id", file_, id);
    const ModelEntry* model = &find_model(id.values().word("id"));
    const Table options = read_or_default("model", model_table_parameters(*model));
    refuse_both_moduli(options);  // of a tree
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
      places_.options.emplace(p.name, read.place(p.name));
      apply(scene_.options, option_of(p.name), read.text(p.name), read.place(p.name));
    }
    check_tolerance(read);
  }

  /// Either the step is given, or an error and with it all that follows from it.
  void check_tolerance(const Table& read) {
    const IntegratorEntry& entry = find_integrator(scene_.integrator);
    const auto refuse = [&](std::string_view key, const std::string& why,
                            const std::string& remedy = "leave it out") {
      if (!read.given(key)) return;
      throw InputError(fmt::format("{} {}", key, why), read.place(key), remedy);
    };
    const double floor =
        std::ranges::find(read.declared(), "rtol", &Parameter::name)->min;
    if (scene_.options.tolerance > 0 && scene_.options.tolerance < floor) {
      refuse("position_tol_rel",
             fmt::format("= {:g} is below rounding", scene_.options.tolerance),
             fmt::format("give at least {:g}, or 0 for fixed steps", floor));
    }
    const bool least = scene_.options.min_step > 0;
    if (scene_.options.tolerance == 0) {
      if (least) refuse("min_step_s", "has no effect without tolerance");
      return;
    }
    if (scene_.options.max_step > 0 &&
        scene_.options.min_step > scene_.options.max_step) {
      refuse("min_step_s", "is more than max_step_s",
             "give a smaller min_step_s, or a larger max_step_s");
    }
    if (!entry.adaptive && !entry.error_controlled) {
      refuse("position_tol_rel",
             fmt::format("is not for {}, which has a fixed step", entry.id));
    }
    if (entry.adaptive && least) {
      refuse("min_step_s", fmt::format("does nothing with {}", entry.id));
    }
    const auto decided =
        entry.adaptive
            ? std::array<std::string_view, 3>{"dt_s", "rtol", "atol"}
            : std::array<std::string_view, 3>{"dt_s", "newton_tolerance", "refresh"};
    for (const std::string_view key : decided) {
      refuse(key, "is not for a run with position_tol_rel, which decides it");
    }
    scene_.options = with_tolerance(entry, scene_.options);
    places_.tolerance = read.place("position_tol_rel");
  }

  void refuse_strand_tables() const {
    for (const std::string_view name : {"strand", "groom", "material", "root", "effects",
                                        "gradient", "supports", "joints"}) {
      const toml::node* node = root_.get(name);
      if (node == nullptr) continue;
      throw InputError(fmt::format("[{}] is not allowed with model {}, which brings its "
                                   "own geometry",
                                   name, scene_.model->id),
                       place_of(node->source(), file_),
                       "remove the table; all parameters belong in [model]");
    }
  }

  void read_strands(bool outlined) {
    StrandTables tables{read_or_default("material", material_table_parameters()),
                        read_or_default("root", root_table_parameters()),
                        {}};
    scene_.head = head_motion(tables.root);
    tables.skin = skin_of(tables.root);
    read_each("strand", strand_table_parameters(), tables);
    read_each("groom", groom_table_parameters(), tables);
    if (tables.sources.empty()) {
      throw InputError("a scene without strands", file_ + ":1:1",
                       "give a [strand], or a [groom] for many");
    }
    if (const toml::table* given = table("gradient")) {
      tables.gradient =
          read_table(*given, gradient_table_parameters(), "[gradient]", file_);
    }
    if (const toml::node* node = root_.get("supports")) {
      for (const toml::table* one : each(*node, "supports", true)) {
        tables.supports.push_back(read_support(*one, file_));
      }
    }
    if (const toml::node* node = root_.get("joints")) {
      for (const toml::table* one : each(*node, "joints", true)) {
        tables.joints.push_back(read_joint(*one, file_));
      }
    }
    if (const toml::table* all = table("effects")) {
      tables.driven = read_driven(*all, file_);
    }
    scene_.tables = std::make_shared<const StrandTables>(std::move(tables));
    if (has_constraints(scene_) &&
        scene_.options.formulation == Formulation::parametric) {
      const Formulation usual = formulation_of_supports(
          find_integrator(scene_.integrator), scene_.options.tolerance > 0);
      const auto given = places_.options.find("formulation");
      refuse_if(given != places_.options.end(),
                "formulation = \"parametric\" does not hold supports or joints",
                given == places_.options.end() ? "" : given->second,
                fmt::format("leave it out, or give \"{}\"", name(usual)));
      scene_.options.formulation = usual;
    }
    series_ = std::make_shared<const StrandSeries>(
        scene_.tables, scene_.head, scene_.seed, outlined ? made_singly : held_at_once);
    CutStrands cut = outlined ? series_->outline() : series_->all();
    scene_.strands = std::move(cut.strands);
    SceneSupports(scene_).check_strands(series_->size());
    scene_.followers = std::move(cut.followers);
    scene_.fitted = std::move(cut.fitted);
    for (const std::size_t i : cut.source) {
      places_.numbers.push_back(outlined ? series_->first()[i] : places_.numbers.size());
      places_.strands.push_back(scene_.tables->sources[i].table.place());
    }
  }

  /// Every [name] or [[name]] and its [name.material], if any.
  void read_each(const std::string& name, std::span<const Parameter> declared,
                 StrandTables& tables) {
    const toml::node* node = root_.get(name);
    if (node == nullptr) return;
    const auto all = each(*node, name, true);
    if (all.size() > held_at_once.strands) {
      throw InputError(fmt::format("{} tables [[{}]]", all.size(), name),
                       place_of(all[held_at_once.strands]->source(), file_),
                       fmt::format("give at most {}: one [groom] makes many strands",
                                   held_at_once.strands));
    }
    std::size_t files = 0;
    for (const toml::table* one : all) {
      StrandSource source{
          read_table(*one, declared, "[" + name + "]", file_, material_table),
          {},
          name == "groom"};
      if (source.groom) source.file = read_file_groom(source.table);
      if (source.file && ++files > most_groom_files) {
        throw InputError(fmt::format("more than {} grooms from files", most_groom_files),
                         source.table.place("file"), "write their strands to one file");
      }
      if (const toml::node* own = one->get("material")) {
        const std::string own_name = name + ".material";
        source.material =
            read_table(as_table(*own, own_name, file_), material_table_parameters(),
                       "[" + own_name + "]", file_);
      }
      tables.sources.push_back(std::move(source));
    }
  }

  void read_effects() {
    const toml::table* all = table("effects");
    if (all == nullptr) return;
    // The keys are in alphabetical order, in which tether and wind would follow it.
    for (const bool between : {false, true}) {
      for (const auto& [key, node] : *all) {
        if (is_driven(key.str())) continue;
        refuse_misspelt(key.str(), place_of(key.source(), file_));
        const EffectEntry& entry = find_effect(key.str(), place_of(key.source(), file_));
        if ((entry.make == nullptr) == between) read_effect(entry, node);
      }
    }
  }

  /// Refuses a name that is no effect, but nearly that of a table of driven_kinds().
  static void refuse_misspelt(std::string_view name, const std::string& place) {
    if (std::ranges::count(models::effects(), name, &EffectEntry::id) > 0) return;
    std::vector<std::string_view> ids;
    for (const DrivenKind& kind : driven_kinds()) ids.push_back(kind.id);
    for (const EffectEntry& entry : models::effects()) ids.push_back(entry.id);
    const std::string_view near = nearest(name, ids);
    refuse_if(is_driven(near), fmt::format("unknown effect '{}'", name), place,
              fmt::format("did you mean '{}'?", near));
  }

  static void refuse_unused(const Table& read, std::span<const models::EffectUse> uses) {
    std::map<std::string_view, std::vector<Use>> by_choice;
    for (const auto& [choice, word, keys] : uses) {
      by_choice[choice].push_back({word, keys});
    }
    for (const auto& [choice, of_words] : by_choice) read.refuse_unused(choice, of_words);
  }

  void read_effect(const EffectEntry& entry, const toml::node& node) {
    const std::string name = fmt::format("effects.{}", entry.id);
    for (const toml::table* one : each(node, name, entry.many)) {
      const Table read =
          read_table(*one, entry.parameters, fmt::format("[{}]", name), file_);
      refuse_unused(read, entry.uses);
      if (read.given("axis")) static_cast<void>(direction(read, "axis"));
      scene_.effects.push_back({&entry, read.values()});
      places_.effects.push_back(read.place());
      if (scene_.effects.size() > most_effects) {
        throw InputError(fmt::format("more than {} effects", most_effects), read.place(),
                         "leave some out");
      }
    }
  }

  const std::string& file_;
  const toml::table root_;
  Scene scene_;
  std::shared_ptr<const StrandSeries> series_;
  ScenePlaces places_;
};

}  // namespace

std::vector<std::vector<double>> segment_lengths(const std::vector<Strand>& strands) {
  std::vector<std::vector<double>> all(strands.size());
  for (std::size_t k = 0; k < strands.size(); ++k) {
    check_unbranched(strands[k], fmt::format("effects.control_mesh, strand {}", k));
    for (const Segment& segment : strands[k].segments) all[k].push_back(segment.length);
  }
  return all;
}

std::shared_ptr<const Effect> make_effect(const Scene& scene,
                                          const EffectChoice& choice) {
  if (choice.entry->make == nullptr) return {};
  std::shared_ptr<const Effect> made = choice.entry->make(choice.parameters, scene.head);
  if (scene.friction() == nullptr) return made;
  auto obstacle = made->obstacle();
  if (obstacle != nullptr) return obstacle;
  return made;
}

Effects make_effects(const Scene& scene) {
  Effects all;
  for (const EffectChoice& choice : scene.effects) {
    if (auto made = make_effect(scene, choice)) all.push_back(std::move(made));
  }
  return all;
}

std::vector<std::string> effect_names(const Scene& scene) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    const std::string_view id = scene.effects[i].entry->id;
    const auto so_far = std::ranges::count(
        scene.effects.begin(), scene.effects.begin() + static_cast<std::ptrdiff_t>(i), id,
        [](const EffectChoice& choice) { return choice.entry->id; });
    std::string name(id);
    if (so_far > 0) name.append("_").append(std::to_string(so_far + 1));
    names.push_back(std::move(name));
  }
  return names;
}

const Parameters* Scene::parameters_of(std::string_view effect) const {
  const auto found = std::ranges::find_if(effects, [effect](const EffectChoice& choice) {
    return choice.entry->id == effect;
  });
  return found == effects.end() ? nullptr : &found->parameters;
}

std::size_t Scene::last_frame() const {
  // 1e-9: a whole number of frames up to rounding gets no extra frame.
  return static_cast<std::size_t>(std::ceil(duration * frame_rate - 1e-9));
}

bool Scene::chooses_steps() const {
  return options.tolerance > 0 || find_integrator(integrator).adaptive;
}

Scene read_scene(const std::string& file) {
  const std::string there = shipped_file(file);
  return parse_scene(read_file(there, most_toml_bytes), there);
}

SceneOutline read_outline(const std::string& file) {
  const std::string there = shipped_file(file);
  return parse_outline(read_file(there, most_toml_bytes), there);
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
SceneOutline parse_outline(const std::string& text, const std::string& file) {
  return Reader(text, file).read_outline();
}

}  // namespace tress::simulation
