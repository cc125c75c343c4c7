#include "experiments/run/list.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <vector>

#include "experiments/run/command_line.h"
#include "integrators/integrator_options.h"
#include "models/strand/strand_parameters.h"

namespace tress::experiments {
namespace {

/// One letter per formulation, for the cells of the matrix.
char letter(Formulation formulation) {
  switch (formulation) {
    case Formulation::parametric:
      return 'p';
    case Formulation::acceleration:
      return 'a';
    case Formulation::baumgarte:
      return 'b';
    case Formulation::projection:
      return 'j';
    case Formulation::index2_ggl:
      return 'g';
    case Formulation::index3:
      return '3';
    case Formulation::rattle:
      return 'r';
    case Formulation::correction:
      return 'c';
  }
  return '?';
}

constexpr const char* legend =
    "p parametric (or no constraints), a acceleration level, b Baumgarte, j projection, "
    "g index 2 (GGL), 3 index 3, r RATTLE, c corrected positions; a number is the reason "
    "for a gap, below";

/// Reasons in order of appearance, each stored once and identified by its number.
class Footnotes {
 public:
  int number(const std::string& reason) {
    const auto found = std::find(reasons_.begin(), reasons_.end(), reason);
    if (found != reasons_.end()) return static_cast<int>(found - reasons_.begin()) + 1;
    reasons_.push_back(reason);
    return static_cast<int>(reasons_.size());
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

/// "pab 2,3": formulations that work, then the numbers of the notes on the others.
std::string cell(const IntegratorEntry& integrator, System& system, Footnotes& notes) {
  std::string works, gaps;
  for (const auto& [formulation, order] : integrator.formulations) {
    const std::string reason = refusal(integrator, system, formulation);
    if (reason.empty()) {
      works += letter(formulation);
      continue;
    }
    const std::string number = std::to_string(notes.number(reason));
    const bool noted = (',' + gaps + ',').find(',' + number + ',') != std::string::npos;
    if (!noted) gaps += (gaps.empty() ? "" : ",") + number;
  }
  return works.empty() || gaps.empty() ? works + gaps : works + ' ' + gaps;
}

/// "pabj", followed by those whose order is not the nominal one: ", 3 of order 1".
std::string letters_of(const IntegratorEntry& entry) {
  std::string nominal, others;
  for (const auto& [formulation, order] : entry.formulations) {
    if (order == entry.order()) {
      nominal += letter(formulation);
    } else {
      others += fmt::format(", {} of order {}", letter(formulation), order);
    }
  }
  return nominal + others;
}

std::string matrix(std::span<const ModelEntry> models,
                   std::span<const IntegratorEntry> integrators) {
  Footnotes notes;
  std::vector<std::vector<std::string>> columns(1, {""});
  for (const IntegratorEntry& integrator : integrators) {
    columns[0].emplace_back(integrator.id);
  }
  for (const ModelEntry& model : models) {
    std::vector<std::string>& column = columns.emplace_back(1, std::string(model.id));
    try {
      const std::unique_ptr<System> system = model.make(
          Parameters(setup_parameters(model), fmt::format("model {}", model.id)));
      for (const IntegratorEntry& integrator : integrators) {
        column.push_back(cell(integrator, *system, notes));
      }
    } catch (const std::exception& error) {
      const std::string note = std::to_string(notes.number(error.what()));
      column.resize(integrators.size() + 1, note);
    }
  }
  std::string text;
  for (std::size_t i = 0; i <= integrators.size(); ++i) {
    std::string line = "  ";
    for (const std::vector<std::string>& column : columns) {
      std::size_t width = 0;
      for (const std::string& entry : column) width = std::max(width, entry.size());
      line += fmt::format("{:<{}}  ", column[i], width);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return fmt::format("\nWHAT DRIVES WHAT (default parameters)\n  {}\n{}\n{}", legend,
                     text, notes.text());
}

}  // namespace

std::string catalogue_text(std::span<const ModelEntry> models,
                           std::span<const IntegratorEntry> integrators,
                           std::span<const Parameter> experiment_settings) {
  std::string text = "MODELS (parameters by --set key=value, [default])\n";
  for (const ModelEntry& model : models) {
    text += fmt::format("  {:<20} {} ({})\n", model.id, model.summary, model.source);
    text += parameter_lines(model.parameters);
  }
  text +=
      "\nKEYS OF ALL MODELS OF A STRAND (strand, clamp, gravity and drag, with the "
      "defaults of studies; scenes/README.md has those of scene files)\n";
  text += parameter_lines(strand_parameters());
  text += "\nINTEGRATORS (options of one alone by --set key=value, [default])\n";
  for (const IntegratorEntry& entry : integrators) {
    text += fmt::format("  {:<20} order {}{}, {} [{}] ({})\n", entry.id, entry.order(),
                        entry.adaptive           ? ", adaptive"
                        : entry.error_controlled ? ", fixed step or tolerance"
                                                 : "",
                        entry.summary, letters_of(entry), entry.source);
    text += parameter_lines(entry.parameters);
  }
  text += "\nKEYS OF ALL INTEGRATORS\n" + parameter_lines(common_options());
  if (!experiment_settings.empty()) {
    text += "\nKEYS OF THIS EXPERIMENT\n" + parameter_lines(experiment_settings);
  }
  return text + matrix(models, integrators);
}

}  // namespace tress::experiments
