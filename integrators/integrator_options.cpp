#include "integrators/integrator_options.h"

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

namespace tress::integrators {
namespace {

/// How a field of Options is set from parameters and converted to their text.
struct Access {
  void (*assign)(Options&, const Parameters&, std::string_view key);
  std::string (*text)(const Options&, std::string_view key);
};

struct Field {
  Parameter parameter;
  Access access;
};

/// A numeric field.
template <auto member>
constexpr Access number{[](Options& o, const Parameters& p, std::string_view key) {
                          using Type = std::remove_reference_t<decltype(o.*member)>;
                          o.*member = static_cast<Type>(p.number(key));
                        },
                        [](const Options& o, std::string_view) {
                          return number_text(static_cast<double>(o.*member));
                        }};

std::vector<std::string_view> words(std::string_view key) {
  const auto declared = std::ranges::find(common_options(), key, &Parameter::name);
  return words_of(declared->choices);
}

/// Index of the option value among the declared choices, which follow the enum's order.
template <auto member>
constexpr Access choice{
    [](Options& o, const Parameters& p, std::string_view key) {
      const auto all = words(key);
      using Enum = std::remove_reference_t<decltype(o.*member)>;
      o.*member = static_cast<Enum>(std::ranges::find(all, p.word(key)) - all.begin());
    },
    [](const Options& o, std::string_view key) {
      return std::string(words(key)[static_cast<std::size_t>(o.*member)]);
    }};

const Options defaults;
constexpr double smallest_step = 1e-12;       // s
constexpr double smallest_tolerance = 1e-15;  // below it round-off dominates
constexpr double largest = 1e30;
constexpr double most_counted = 1e15;  // whole numbers that a double holds exactly

const Field fields[] = {
    {{.name = "formulation",
      .help = "formulation of the constraints; a model with constraints needs another "
              "than parametric",
      .choices = "parametric|acceleration|baumgarte|projection|index2_ggl|index3|rattle|"
                 "correction"},
     choice<&Options::formulation>},
    {{.name = "alpha",
      .help = "Baumgarte's position gain (1/s^2)",
      .number = defaults.alpha,
      .min = -largest,
      .max = largest},
     number<&Options::alpha>},
    {{.name = "beta",
      .help = "Baumgarte's velocity gain (1/s)",
      .number = defaults.beta,
      .min = -largest,
      .max = largest},
     number<&Options::beta>},
    {{.name = "step",
      .help = "time step of fixed-step methods (s)",
      .number = defaults.step,
      .min = smallest_step,
      .max = largest},
     number<&Options::step>},
    {{.name = "rtol",
      .help = "relative tolerance of adaptive methods",
      .number = defaults.rtol,
      .min = smallest_tolerance,
      .max = 1},
     number<&Options::rtol>},
    {{.name = "atol",
      .help = "absolute tolerance over the model's scale",
      .number = defaults.atol,
      .min = 0,
      .max = largest},
     number<&Options::atol>},
    {{.name = "max_step",
      .help = "largest step of adaptive methods (s), 0: unlimited",
      .number = defaults.max_step,
      .min = 0,
      .max = largest},
     number<&Options::max_step>},
    {{.name = "position_tol_rel",
      .help = "tolerance of error control: estimated error of a point in a "
              "step, over the length, at least 1e-15. 0: fixed step. In a scene it "
              "excludes dt_s, "
              "newton_tolerance and refresh. "
              "Methods with rtol take it as rtol, and a hundredth as atol",
      .number = defaults.tolerance,
      .min = 0,
      .max = 1},
     number<&Options::tolerance>},
    {{.name = "min_step",
      .help =
          "shortest step of an adaptive run, which fails if it needs a shorter one (s)",
      .number = defaults.min_step,
      .min = 0,
      .max = largest},
     number<&Options::min_step>},
    {{.name = "max_steps",
      .help = "steps, or exchanges of strands that touch, from one frame to the next "
              "until a run counts as failed",
      .number = static_cast<double>(defaults.max_steps),
      .min = 1,
      .max = most_counted,
      .whole = true},
     number<&Options::max_steps>},
    {{.name = "max_work",
      .help = "evaluations, solves and steps, times coordinates + 10, until a run counts "
              "as failed, 0: unlimited",
      .number = 0,
      .min = 0,
      .max = largest},
     number<&Options::max_work>},
    {{.name = "max_order",
      .help = "order of multistep or Runge-Kutta methods, 0: default",
      .number = 0,
      .min = 0,
      .max = 13,
      .whole = true},
     number<&Options::max_order>},
    {{.name = "newton_tolerance",
      .help = "largest correction over the model's scale",
      .number = defaults.newton_tolerance,
      .min = smallest_tolerance,
      .max = 1},
     number<&Options::newton_tolerance>},
    {{.name = "newton_iterations",
      .help = "Newton iterations allowed per step",
      .number = static_cast<double>(defaults.newton_iterations),
      .min = 1,
      .max = 1000,
      .whole = true},
     number<&Options::newton_iterations>},
    {{.name = "refresh",
      .help = "when the Newton matrix is rebuilt",
      .choices = "every_iteration|every_step|when_slow"},
     choice<&Options::refresh>},
    {{.name = "contact_tolerance_m_s",
      .help = "speed by which a step may violate the law of exact contact (m/s)",
      .number = defaults.contact_tolerance,
      .min = smallest_tolerance,
      .max = 1},
     number<&Options::contact_tolerance>},
    {{.name = "contact_iterations",
      .help = "largest number of solutions of a step until the law of "
              "exact contact is satisfied",
      .number = static_cast<double>(defaults.contact_iterations),
      .min = 1,
      .max = 1000,
      .whole = true},
     number<&Options::contact_iterations>},
    {{.name = "newton_coefficient",
      .help = "SUNDIALS' nonlinear coefficient, 0: SUNDIALS' default",
      .number = Options{}.newton_coefficient,
      .min = 0,
      .max = 1},
     number<&Options::newton_coefficient>},
    {{.name = "linear",
      .help = "linear solver of systems with constraints, of ida and of adjoint "
              "gradients; other steps use [model] solver",
      .choices = "automatic|klu|banded|dense"},
     choice<&Options::linear>},
};

}  // namespace

std::span<const Parameter> common_options() {
  static const std::vector<Parameter> parameters = [] {
    std::vector<Parameter> list;
    for (const Field& field : fields) list.push_back(field.parameter);
    return list;
  }();
  return parameters;
}

std::span<const Parameter> integrator_options() {
  static const std::vector<Parameter> parameters = [] {
    std::vector<Parameter> list(common_options().begin(), common_options().end());
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      for (const Parameter& own : entry.parameters) {
        if (readers_of_option(own.name).front() == &entry) list.push_back(own);
      }
    }
    return list;
  }();
  return parameters;
}

std::vector<const IntegratorEntry*> readers_of_option(std::string_view key) {
  std::vector<const IntegratorEntry*> readers;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (std::ranges::count(entry.parameters, key, &Parameter::name) > 0) {
      readers.push_back(&entry);
    }
  }
  return readers;
}

void apply(Options& options, std::string_view key, std::string_view value,
           const std::string& where) {
  Parameters parameters(integrator_options(), where);
  parameters.set(key, value);
  if (!readers_of_option(key).empty()) {
    options.own.insert_or_assign(std::string(key), value);
    return;
  }
  for (const Field& field : fields) {
    if (field.parameter.name == key) field.access.assign(options, parameters, key);
  }
}

std::string text_of(const Options& options, std::string_view key) {
  for (const Field& field : fields) {
    if (field.parameter.name == key) return field.access.text(options, key);
  }
  const auto own = options.own.find(key);
  if (own != options.own.end()) return own->second;
  return Parameters(integrator_options(), "").text(key);
}

}  // namespace tress::integrators
