#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "tests/support/tested.h"

namespace tress::testing_support {

using namespace models;

/// A catalogue entry with at most one parameter away from its default: every word of
/// every choice gets its own case, so a new model or variant is tested without being
/// named here.
struct CatalogueCase {
  const ModelEntry* entry;
  std::string key;  // empty: all defaults
  std::string word;

  std::string name() const {
    std::string text(entry->id);
    if (!key.empty()) text += "_" + key + "_" + word;
    return text;
  }

  std::unique_ptr<System> make() const {
    Parameters parameters(setup_parameters(*entry), "model " + std::string(entry->id));
    if (!key.empty()) parameters.set(key, word);
    return entry->make(parameters);
  }
};

inline std::vector<CatalogueCase> catalogue_cases() {
  std::vector<CatalogueCase> cases;
  for (const ModelEntry& entry : tested_models()) {
    cases.push_back({&entry, "", ""});
    for (const Parameter& parameter : setup_parameters(entry)) {
      const auto words = words_of(parameter.choices);
      for (std::size_t i = 1; i < words.size(); ++i) {  // the first is the default
        cases.push_back({&entry, std::string(parameter.name), std::string(words[i])});
      }
    }
  }
  return cases;
}

/// Random but reproducible states around the initial one, in the system's own scales.
class States {
 public:
  explicit States(System& system, unsigned seed = 7) : random_(seed) {
    n = static_cast<std::size_t>(system.layout().coordinates);
    m = static_cast<std::size_t>(system.layout().constraints);
    for (auto* x : {&q, &v, &a, &q_typ, &v_typ, &a_typ}) x->assign(n, 0.0);
    system.initial_state(q, v);
    system.scale(q_typ, v_typ);
    for (std::size_t i = 0; i < n; ++i) a_typ[i] = v_typ[i] * v_typ[i] / q_typ[i];
  }

  /// Moves q by up to `amount` of its scale, v and a by their whole scales.
  void shake(double amount) {
    for (std::size_t i = 0; i < n; ++i) {
      q[i] += amount * q_typ[i] * uniform();
      v[i] += v_typ[i] * uniform();
      a[i] = a_typ[i] * uniform();
    }
  }

  std::vector<double> random(const std::vector<double>& typ) {
    std::vector<double> x(typ.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = typ[i] * uniform();
    return x;
  }

  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

  std::size_t n, m;
  std::vector<double> q, v, a, q_typ, v_typ, a_typ;

 private:
  std::mt19937 random_;
};

inline void PrintTo(const CatalogueCase& c, std::ostream* out) {
  *out << c.name();
}  // NOLINT

inline double largest(const std::vector<double>& x) {
  double most = 0;
  for (const double entry : x) most = std::max(most, std::abs(entry));
  return most;
}

inline std::vector<double> plus(const std::vector<double>& x, double factor,
                                const std::vector<double>& d) {
  std::vector<double> y = x;
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * d[i];
  return y;
}

/// (8 (f(e) - f(-e)) - (f(2e) - f(-2e))) / 12e for a vector-valued f: error O(e^4),
/// rounding about eps |f| / e.
template <class F>
std::vector<double> central_difference(double e, F f) {
  const std::vector<double> near_plus = f(e), near_minus = f(-e);
  const std::vector<double> far_plus = f(2 * e), far_minus = f(-2 * e);
  std::vector<double> d(near_plus.size());
  for (std::size_t i = 0; i < d.size(); ++i) {
    d[i] = (8 * (near_plus[i] - near_minus[i]) - (far_plus[i] - far_minus[i])) / (12 * e);
  }
  return d;
}

/// eps^(1/5) balances truncation e^4 = 3e-13 against rounding eps / e = 3e-13.
inline constexpr double difference_step = 7.4e-4;

}  // namespace tress::testing_support
