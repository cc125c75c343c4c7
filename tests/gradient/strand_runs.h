#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "contract/forms/material_points.h"
#include "integrators/catalogue.h"
#include "integrators/gradient/adjoint_run.h"
#include "integrators/gradient/gradient_run.h"
#include "models/catalogue.h"
#include "models/strand_copies.h"

/// Strands of the catalogue as functions of their parameters, for tests of gradients.
namespace tress::testing_support {

using namespace integrators;
using namespace models;

/// Methods that solve their stages.
inline std::vector<std::string> stage_methods() {
  std::vector<std::string> all;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.stages > 0) all.emplace_back(entry.id);
  }
  return all;
}

/// A number of setup_parameters() that a test varies: value + s unit.
struct Varied {
  std::string key;
  double value, unit;
};

struct StrandRun {
  const ModelEntry* model;
  ModelSettings settings;
  std::string method;
  Options options;
  std::vector<double> stops;  // s

  Parameters parameters() const {
    Parameters p(setup_parameters(*model), "model " + std::string(model->id));
    for (const auto& [name, text] : settings) {
      if (p.knows(name)) p.set(name, text);
    }
    return p;
  }

  std::unique_ptr<System> make(const std::string& key = {}, double value = 0) const {
    Parameters p = parameters();
    if (!key.empty()) p.set(key, number_text(value));
    return model->make(p);
  }

  std::unique_ptr<System> copies() const {
    const Parameters p = parameters();
    return strand_copies(*model, strand(p), p, strand_effects(p));
  }

  /// Gravity and viscous drag are smooth.
  RunParameter parameter(const Varied& varied) const {
    RunParameter made = [this, varied](double s) {
      return make(varied.key, varied.value + s * varied.unit);
    };
    made.law = ParameterLaw::smooth;
    return made;
  }
};

inline std::vector<double> tip(System& system, double t, In q) {
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  points.positions(t, q, x);
  return {x.end() - 3, x.end()};
}

/// The tip at every stop, one after the other.
inline std::vector<double> tips(const StrandRun& run, const std::string& key,
                                double value) {
  const auto system = run.make(key, value);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n), all;
  system->initial_state(q, v);
  system->accept(0, q, v);
  const auto method = make_integrator(run.method, *system, run.options);
  Status s = method->start(0, q, v);
  for (const double stop : run.stops) {
    if (s == Status::ok) s = method->advance(stop);
    const auto x = s == Status::ok ? tip(*system, stop, method->q())
                                   : std::vector<double>(3, std::nan(""));
    all.insert(all.end(), x.begin(), x.end());
  }
  return all;
}

/// Derivatives of tips() by each of the numbers times its unit; empty with a message
/// where the run fails.
struct TipGradient {
  std::vector<std::vector<double>> by;
  std::vector<double> value;
  std::string failure;
};

inline TipGradient tip_gradient(const StrandRun& run,
                                const std::vector<RunParameter>& parameters,
                                GradientStart start = GradientStart::as_run) {
  const auto system = run.make();
  GradientRun gradient(*system, run.make(), parameters, {run.method, run.options, start},
                       run.copies());
  TipGradient found;
  found.by.resize(parameters.size());
  Status s = gradient.start();
  const auto count = static_cast<std::size_t>(system->material_points()->count());
  std::vector<double> dx(3 * count);
  for (const double stop : run.stops) {
    if (s == Status::ok) s = gradient.advance(stop);
    if (s != Status::ok) {
      found.failure = gradient.failure();
      return found;
    }
    const auto x = tip(*system, stop, gradient.q());
    found.value.insert(found.value.end(), x.begin(), x.end());
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      gradient.points_by(k, dx);
      found.by[k].insert(found.by[k].end(), dx.end() - 3, dx.end());
    }
  }
  return found;
}

inline std::vector<RunParameter> parameters(const StrandRun& run,
                                            const std::vector<Varied>& varied) {
  std::vector<RunParameter> all;
  for (const Varied& one : varied) all.push_back(run.parameter(one));
  return all;
}

inline TipGradient tip_gradient(const StrandRun& run, const std::vector<Varied>& varied) {
  return tip_gradient(run, parameters(run, varied));
}

/// tip_gradient() by one sweep backward.
inline TipGradient adjoint_tip_gradient(const StrandRun& run,
                                        const std::vector<RunParameter>& parameters,
                                        GradientStart start = GradientStart::as_run,
                                        std::size_t record = AdjointRun::most_record) {
  const auto system = run.make();
  AdjointRun adjoint(*system, run.make(), parameters, {run.method, run.options, start},
                     record);
  TipGradient found;
  found.by.resize(parameters.size());
  Status s = adjoint.start();
  for (const double stop : run.stops) {
    if (s == Status::ok) s = adjoint.advance(stop);
    if (s != Status::ok) break;
    const auto x = tip(*system, stop, adjoint.q());
    found.value.insert(found.value.end(), x.begin(), x.end());
  }
  const std::size_t numbers = 3 * run.stops.size();
  std::vector<double> by(numbers * parameters.size());
  const auto seed = [](std::size_t number, std::size_t stop, Out x_hat) {
    if (stop == number / 3 + 1) x_hat[x_hat.size() - 3 + number % 3] = 1;
  };
  if (s == Status::ok) s = adjoint.sweep(numbers, seed, by);
  found.failure = adjoint.failure();
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    for (std::size_t i = 0; i < numbers; ++i) {
      found.by[k].push_back(by[i * parameters.size() + k]);
    }
  }
  return found;
}

/// (8 (f(e) - f(-e)) - (f(2e) - f(-2e)))/(12 e) of tips().
inline std::vector<double> difference(const StrandRun& run, const Varied& one, double e) {
  const auto at = [&](double s) { return tips(run, one.key, one.value + s * one.unit); };
  const auto near_plus = at(e), near_minus = at(-e), far_plus = at(2 * e),
             far_minus = at(-2 * e);
  std::vector<double> d(near_plus.size());
  for (std::size_t i = 0; i < d.size(); ++i) {
    d[i] = (8 * (near_plus[i] - near_minus[i]) - (far_plus[i] - far_minus[i])) / (12 * e);
  }
  return d;
}

inline double largest_of(const std::vector<double>& x) {
  double most = 0;
  for (const double entry : x) {
    if (std::isnan(entry)) return entry;
    most = std::max(most, std::abs(entry));
  }
  return most;
}

/// Largest difference over the largest of the second.
inline double apart(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> d(x);
  for (std::size_t i = 0; i < d.size(); ++i) d[i] -= y[i];
  return largest_of(d) / largest_of(y);
}

}  // namespace tress::testing_support
