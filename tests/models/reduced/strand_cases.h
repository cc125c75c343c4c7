#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "models/strand/strand_parameters.h"
#include "simulation/run/simulation.h"
#include "tests/support/tangent.h"

/// What the tests of reduced-coordinate strands share.
namespace tress::testing_support {

using namespace simulation;

inline constexpr double eps = std::numeric_limits<double>::epsilon();

/// `more` set after `base`: the later of two values of a key holds.
inline ModelSettings with(ModelSettings base, const ModelSettings& more) {
  base.insert(base.end(), more.begin(), more.end());
  return base;
}

/// The parameters behind a model of the catalogue.
inline Parameters parameters_of(std::string_view model, const ModelSettings& settings) {
  Parameters parameters(setup_parameters(find_model(model)),
                        "model " + std::string(model));
  for (const auto& [key, value] : settings) parameters.set(key, value);
  return parameters;
}

/// One model in one setting, with a name that tests print.
struct StrandCase {
  std::string name;
  std::string_view model;
  ModelSettings settings;

  std::unique_ptr<System> make(const ModelSettings& more = {}) const {
    return make_model(model, with(settings, more));
  }
};

inline void PrintTo(const StrandCase& c, std::ostream* out) { *out << c.name; }  // NOLINT

inline std::vector<double> zeros(const System& system) {
  return std::vector<double>(static_cast<std::size_t>(system.layout().coordinates));
}

/// Largest |x_i - y_i| / typ_i over largest |y_i| / typ_i: units and sizes drop out.
inline double relative_difference(In x, In y, In typ) {
  double apart = 0, size = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    apart = std::max(apart, std::abs(x[i] - y[i]) / typ[i]);
    size = std::max(size, std::abs(y[i]) / typ[i]);
    if (!std::isfinite(x[i] - y[i])) return std::numeric_limits<double>::infinity();
  }
  return apart / size;
}

}  // namespace tress::testing_support
