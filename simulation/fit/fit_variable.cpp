#include "simulation/fit/fit_variable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "simulation/files/parse.h"

namespace tress::simulation {
namespace {

/// Of half the range. A start this near to a bound moves inside: sin x has no slope
/// there. A result this near is at the bound.
constexpr double near_bound = 1e-3;

struct Named {
  std::string name;
  double one, other;
};

/// "NAME:NUMBER:NUMBER" items.
std::vector<Named> parse_named(std::string_view text, std::string_view form,
                               const std::string& where) {
  std::vector<Named> all;
  if (text.empty()) return all;
  for (const std::string& item : split(text, ',', where)) {
    const std::vector<std::string> parts = split(item, ':', where);
    const auto number = [&](std::size_t i) {
      return i < parts.size() ? decimal(parts[i]).value_or(std::nan("")) : std::nan("");
    };
    refuse_if(parts.size() != 3 || !std::isfinite(number(1)) || !std::isfinite(number(2)),
              fmt::format("'{}' is not {}", item, form), where,
              fmt::format("give {}, several separated by ','", form));
    all.push_back({parts[0], number(1), number(2)});
  }
  return all;
}

void check(const SceneParameter& parameter, const FitBound& bound) {
  const std::string& name = parameter.name;
  const std::string both =
      fmt::format("the bounds of {} are {:g} and {:g}", name, bound.low, bound.high);
  refuse_if(!std::isfinite(bound.low) || !std::isfinite(bound.high), both, bound.place,
            "give two finite numbers");
  refuse_if(!(bound.low < bound.high), both, bound.place,
            "give a lower limit below the upper one");
  refuse_if(parameter.positive && !(bound.low > 0),
            fmt::format("the lower bound of {} is {:g}", name, bound.low), bound.place,
            "give one above 0");
  refuse_if(bound.low < parameter.min || bound.high > parameter.max, both, bound.place,
            fmt::format("give limits between {:g} and {:g}, its range in a scene",
                        parameter.min, parameter.max));
  refuse_if(!(bound.low <= parameter.value && parameter.value <= bound.high),
            fmt::format("the scene's {} = {:g}, where the fit starts, is not between its "
                        "bounds {:g} and {:g}",
                        name, parameter.value, bound.low, bound.high),
            bound.place, "change the scene or the bounds");
}

}  // namespace

std::vector<FitBound> parse_bounds(std::string_view text, const std::string& where) {
  std::vector<FitBound> all;
  for (Named& one : parse_named(text, "NAME:LOW:HIGH", where)) {
    all.push_back({std::move(one.name), one.one, one.other, where});
  }
  return all;
}

std::vector<FitPrior> parse_priors(std::string_view text, const std::string& where) {
  std::vector<FitPrior> all;
  for (Named& one : parse_named(text, "NAME:VALUE:SIGMA", where)) {
    all.push_back({std::move(one.name), one.one, one.other, where});
  }
  return all;
}

FitVariable::FitVariable(const SceneParameter& parameter, const FitBound* bound)
    : logarithmic_(parameter.positive), measure_(parameter.measure) {
  const auto u_of = [&](double p) { return logarithmic_ ? std::log(p) : p / measure_; };
  const double start = u_of(parameter.value);
  start_ = start;
  if (bound == nullptr) return;
  check(parameter, *bound);
  const double low = u_of(bound->low), high = u_of(bound->high);
  middle_ = (low + high) / 2;
  reach_ = (high - low) / 2;
  const double inside = 1 - near_bound;
  start_ = std::asin(std::clamp((start - middle_) / reach_, -inside, inside));
}

double FitVariable::u(double x) const {
  return reach_ > 0 ? middle_ + reach_ * std::sin(x) : x;
}

double FitVariable::du_dx(double x) const {
  return reach_ > 0 ? reach_ * std::cos(x) : 1;
}

double FitVariable::p(double u) const {
  return logarithmic_ ? std::exp(u) : u * measure_;
}

double FitVariable::dp_du(double u) const {
  return logarithmic_ ? std::exp(u) : measure_;
}

double FitVariable::within(double u) const {
  return reach_ > 0 ? std::clamp(u, middle_ - reach_, middle_ + reach_) : u;
}

bool FitVariable::at_bound(double x) const {
  return reach_ > 0 && std::abs(std::sin(x)) > 1 - near_bound;
}

}  // namespace tress::simulation
