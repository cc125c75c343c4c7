#include "contract/integrator.h"

namespace tress {

std::string_view name(Formulation formulation) {
  switch (formulation) {
    case Formulation::parametric:
      return "parametric";
    case Formulation::acceleration:
      return "acceleration";
    case Formulation::baumgarte:
      return "baumgarte";
    case Formulation::projection:
      return "projection";
    case Formulation::index2_ggl:
      return "index2_ggl";
    case Formulation::index3:
      return "index3";
    case Formulation::rattle:
      return "rattle";
    case Formulation::correction:
      return "correction";
  }
  return "";
}

Parameters own_options(const Options& options, std::span<const Parameter> declared) {
  Parameters own(declared, "the integrator's own options");
  for (const Parameter& p : declared) {
    const auto given = options.own.find(p.name);
    if (given != options.own.end()) own.set(p.name, given->second);
  }
  return own;
}

}  // namespace tress
