#include "simulation/scene/shared_parameter.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "models/strand/strand_parameters.h"

namespace tress::simulation {

Parameter shared_parameter(std::string_view name) {
  for (const Parameter& p : strand_parameters()) {
    if (p.name == name) return p;
  }
  throw std::logic_error("no shared parameter " + std::string(name));
}

}  // namespace tress::simulation
