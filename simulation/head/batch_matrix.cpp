#include "simulation/head/batch_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "contract/input_error.h"
#include "models/effects/catalogue.h"
#include "simulation/head/no_head.h"

namespace tress::simulation {
namespace {

using Way = BatchCase::Way;

constexpr std::string_view weight = "[effects.gravity]\n";

std::string strand_text(double y) {
  return fmt::format(
      "[[strand]]\nposition_m = [0, {}, 0]\nlength_m = 0.1\nelements = 2\n", y);
}

/// Two strands.
std::string scene_text(std::string_view model, std::string_view jacobian,
                       std::string_view integrator, std::string_view formulation,
                       std::string_view effects) {
  std::string text = fmt::format(
      "title = \"batch\"\nduration_s = 1e-4\nframes_per_s = 20000\n[model]\nid = "
      "\"{}\"\n",
      model);
  if (!jacobian.empty()) text += fmt::format("jacobian = \"{}\"\n", jacobian);
  text += fmt::format("[integrator]\nid = \"{}\"\n", integrator);
  if (!formulation.empty()) text += fmt::format("formulation = \"{}\"\n", formulation);
  text += find_integrator(integrator).adaptive ? "rtol = 1e-3\n" : "dt_s = 2.5e-5\n";
  // Soft, so that explicit methods need few steps.
  return text +
         fmt::format(
             "[material]\nname = \"hair.caucasian\"\nellipticity = 1\n"
             "youngs_modulus_pa = 1e5\n{}",
             effects) +
         strand_text(0) + strand_text(0.1);
}

/// Empty: the integrator does not drive this.
std::optional<SceneOutline> read(const std::string& text) {
  try {
    return parse_outline(text, "batch.toml");
  } catch (const InputError&) {
    return {};
  }
}

BatchCase case_of(std::string text, const SceneOutline& outline) {
  if (const auto no = no_head(outline))
    return {Way::refused, std::move(text), no->reason};
  if (const auto no = no_lanes(outline.scene)) {
    return {Way::replicated, std::move(text), no->reason};
  }
  return {Way::lanes, std::move(text)};
}

std::vector<std::string_view> words(std::string_view choices) {
  std::vector<std::string_view> all;
  for (std::size_t from = 0; from < choices.size();) {
    const std::size_t to = std::min(choices.find('|', from), choices.size());
    all.push_back(choices.substr(from, to - from));
    from = to + 1;
  }
  return all;
}

/// Approximations of the Jacobian that a model offers.
std::vector<std::string_view> jacobians_of(const ModelEntry& model) {
  for (const Parameter& p : model.parameters) {
    if (p.name == "jacobian") return words(p.choices);
  }
  return {};
}

/// Reasons in order of appearance, each once.
class Notes {
 public:
  std::size_t number(const std::string& reason) {
    const auto found = std::ranges::find(reasons_, reason);
    if (found != reasons_.end()) {
      return static_cast<std::size_t>(found - reasons_.begin()) + 1;
    }
    reasons_.push_back(reason);
    return reasons_.size();
  }
  std::string text() const {
    std::string lines;
    for (std::size_t i = 0; i < reasons_.size(); ++i) {
      lines += fmt::format("  {:>3}  {}\n", i + 1, reasons_[i]);
    }
    return lines;
  }

 private:
  std::vector<std::string> reasons_;
};

std::string cell(const BatchCase& one, Notes& notes) {
  switch (one.way) {
    case Way::none:
      return "-";
    case Way::lanes:
      return "L";
    case Way::replicated:
      return fmt::format("R{}", notes.number("no SIMD lanes for " + one.reason));
    case Way::refused:
      return fmt::format("x{}", notes.number(one.reason));
  }
  return {};
}

/// Lines of columns as wide as their widest cells.
std::string table_text(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> width;
  for (const auto& line : lines) {
    width.resize(std::max(width.size(), line.size()));
    for (std::size_t i = 0; i < line.size(); ++i) {
      width[i] = std::max(width[i], line[i].size());
    }
  }
  std::string text;
  for (const auto& line : lines) {
    std::string one = "  ";
    for (std::size_t i = 0; i < line.size(); ++i) {
      one += fmt::format("{:<{}}  ", line[i], width[i]);
    }
    text += one.substr(0, one.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::vector<const ModelEntry*> strand_models() {
  std::vector<const ModelEntry*> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand != nullptr) all.push_back(&model);
  }
  return all;
}

/// The table of an effect; of bodies also with exact friction.
std::vector<std::pair<std::string, std::string>> tables_of_effects() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const EffectEntry& effect : models::effects()) {
    const std::string table = effect.many ? fmt::format("[[effects.{}]]\n", effect.id)
                                          : fmt::format("[effects.{}]\n", effect.id);
    all.emplace_back(effect.id, table);
    if (effect.id == "body") {
      all.emplace_back("body_exact", table + "friction_law = \"exact\"\n");
    }
    if (effect.id == "strand_interaction") {
      all.back().second += "coupling = \"lagged\"\n";
      all.emplace_back("monolithic", table + "coupling = \"monolithic\"\n");
    }
  }
  return all;
}

}  // namespace

BatchCase batch_case(const ModelEntry& model, const IntegratorEntry& integrator,
                     std::string_view effects) {
  std::string text, formulation;
  std::optional<SceneOutline> outline;
  const auto with = [&](std::string_view jacobian) {
    text = scene_text(model.id, jacobian, integrator.id, formulation, effects);
    outline = read(text);
    return outline.has_value();
  };
  const std::unique_ptr<System> system =
      model.make(Parameters(setup_parameters(model), fmt::format("model {}", model.id)));
  for (const auto& [one, order] : integrator.formulations) {
    if (!refusal(integrator, *system, one).empty()) continue;
    formulation = one == Formulation::parametric ? "" : name(one);
    if (with({})) break;
  }
  if (!outline) return {};
  BatchCase usual = case_of(text, *outline);
  if (usual.way != Way::replicated || !head_method(outline->scene)) return usual;
  for (const std::string_view jacobian : jacobians_of(model)) {
    if (!with(jacobian)) continue;
    BatchCase other = case_of(text, *outline);
    if (other.way == Way::lanes) return other;
    // The reason that remains when the Jacobian is the one that lanes have.
    if (!other.reason.starts_with("jacobian")) usual = std::move(other);
  }
  return usual;
}

std::string batch_matrix() {
  const std::vector<const ModelEntry*> models = strand_models();
  Notes notes;
  const auto effects = tables_of_effects();
  std::vector<std::vector<std::string>> by_integrator(1, {""}), by_effect(1, {""});
  for (const ModelEntry* model : models) by_integrator[0].emplace_back(model->id);
  for (const auto& [name, table] : effects) by_effect[0].push_back(name);
  for (const IntegratorEntry& integrator : integrator_catalogue()) {
    auto& line = by_integrator.emplace_back(1, std::string(integrator.id));
    for (const ModelEntry* model : models) {
      const BatchCase one = batch_case(*model, integrator, weight);
      line.push_back(cell(one, notes));
      if (one.way != Way::lanes) continue;
      auto& acting =
          by_effect.emplace_back(1, fmt::format("{} {}", model->id, integrator.id));
      for (const auto& [name, table] : effects) {
        acting.push_back(cell(batch_case(*model, integrator, table), notes));
      }
    }
  }
  return fmt::format(
      "\nBATCHES OF STRANDS (simulate --as batch; a scene with [effects.gravity])\n"
      "  L in SIMD lanes, R replicated: each strand a system of its own, x refused, - "
      "the "
      "integrator does not drive the model; a number is the reason, below\n{}\n"
      "  The same with one effect, where there are SIMD lanes; elsewhere strands are "
      "replicated, and what is refused here is refused\n{}\n{}",
      table_text(by_integrator), table_text(by_effect), notes.text());
}

}  // namespace tress::simulation
