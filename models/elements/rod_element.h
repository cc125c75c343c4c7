#pragma once

#include <array>
#include <concepts>

#include "contract/forms/compliance_form.h"
#include "math/dual.h"
#include "models/maximal/strained.h"

/// Elements of a rod over neighbouring nodes. An author writes a law once, as a template
/// over the scalar T, and dual numbers give its derivatives:
///
///     static constexpr int nodes, strains;        // nodes <= 4, strains <= 5
///     /// s: the strains of the element at the positions x of its nodes, m.
///     template <class T> void strain(const Vec3<T>* x, T* s) const;
///
/// An element is free of stress at the strains s of the strand's rest shape. A law may
/// map these to others, as where it rounds off a kink at 0:
///
///     void natural(double* s) const;
///
/// A law may also state derivatives by hand, where they are faster; the tests of
/// models/elements compare them with dual numbers (tests/support/law_derivatives.h):
///
///     void gradient(const double* x, double (&g)[strains][3 * nodes]) const;
///     /// h += sum_k stress_k d^2 s_k/dx^2
///     void add_second(const double* x, const double* stress,
///                     double (&h)[3 * nodes][3 * nodes]) const;
namespace tress::models {

template <class L>
concept RodLaw = L::nodes >= 1 && L::nodes <= 4 && L::strains >= 1 &&
                 L::strains <= ComplianceForm::most_rows&& requires(
                                   const L law, const Vec* x, double* s,
                                   const Vec3<Dual<3 * L::nodes, Dual<3 * L::nodes>>>* x2,
                                   Dual<3 * L::nodes, Dual<3 * L::nodes>>* s2) {
  law.strain(x, s);
  law.strain(x2, s2);  // a template over the scalar
};

/// Stiffness (J per square of the strain) and friction (J s) of each strain.
template <RodLaw Law>
struct ElementConstants {
  /// Stiffness and friction of each strain.
  std::array<double, Law::strains> stiffness{}, friction{};
};

/// Strains by law, and their derivatives by dual numbers: a Part of strained.h for every
/// law. Cost of the second derivatives: 9 nodes^2 times that of the strains.
template <RodLaw Law>
struct LawPart {
  /// Number of strains, and of coordinates in x.
  static constexpr int strains = Law::strains, coordinates = 3 * Law::nodes;
  Law law;  // law of the strains
  /// Coefficients and rest values of each strain.
  double stiffness[strains] = {}, friction[strains] = {}, rest[strains] = {};

  /// Evaluates the strains at x.
  template <class T>
  void strain(const T* x, T* s) const {
    std::array<Vec3<T>, Law::nodes> at;
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = load3(x + 3 * k);
    law.strain(at.data(), s);
    for (int k = 0; k < strains; ++k) s[k] = s[k] - T(rest[k]);
  }

  /// Evaluates the first derivatives of the strains by x.
  void gradient(const double* x, double (&g)[strains][coordinates]) const {
    if constexpr (requires { law.gradient(x, g); }) {
      law.gradient(x, g);
    } else {
      Dual<coordinates> at[coordinates], s[strains];
      for (int i = 0; i < coordinates; ++i) {
        at[i].value = x[i];
        at[i].part[i] = 1;
      }
      strain(at, s);
      for (int k = 0; k < strains; ++k) {
        for (int i = 0; i < coordinates; ++i) g[k][i] = s[k].part[i];
      }
    }
  }

  /// Adds the second derivatives of the strains, weighted with `stress`.
  void add_second(const double* x, const double* stress,
                  double (&h)[coordinates][coordinates]) const {
    if constexpr (requires { law.add_second(x, stress, h); }) {
      law.add_second(x, stress, h);
    } else {
      using First = Dual<coordinates>;
      Dual<coordinates, First> at[coordinates], s[strains];
      for (int i = 0; i < coordinates; ++i) {
        at[i].value.value = x[i];
        at[i].value.part[i] = 1;
        at[i].part[i] = First(1);
      }
      strain(at, s);
      for (int k = 0; k < strains; ++k) {
        for (int i = 0; i < coordinates; ++i) {
          for (int j = 0; j < coordinates; ++j) {
            h[i][j] += stress[k] * s[k].part[i].part[j];
          }
        }
      }
    }
  }
};

/// Element in the form that ElementElasticity uses. x and rate are the positions and
/// velocities of its nodes, three numbers each; matrices are row-major.
class RodElement {
 public:
  /// Bound of the coordinates of an element.
  static constexpr int most_coordinates = ComplianceForm::most_coordinates;

  virtual ~RodElement() = default;
  /// Returns the number of nodes.
  virtual int nodes() const = 0;
  /// The element is to be free of stress in the rest shape, in which its nodes are at x.
  virtual void rest_at(const double* x) = 0;
  /// Adds the elastic and friction forces df on the nodes.
  virtual void add_force(const double* x, const double* rate,
                         double* f) const noexcept = 0;
  /// h = pos df/dx + vel df/d(rate). `from`: the element at the origin of stresses, or
  /// null (see Placement).
  virtual void tangent(const double* x, const double* rate, double pos, double vel,
                       const StressOrigin* origin, const double* from,
                       double* h) const noexcept = 0;
  /// Returns the elastic energy, J.
  virtual double energy(const double* x) const noexcept = 0;
  /// Power (W) of friction, and that of the first `led` coordinates, which are
  /// prescribed.
  virtual double power(const double* x, const double* rate, int led) const noexcept = 0;
  /// Returns the constant data of ComplianceForm for these coordinates.
  virtual ComplianceForm::Block block(std::vector<int> coordinates) const = 0;
  /// Computes strains as StrainForm does, with the first `led` coordinates prescribed.
  virtual void strain(const double* x, const double* rate, int led,
                      ComplianceForm::Value& value) const noexcept = 0;
  /// Adds second derivatives as ComplianceForm::add_second(), with `led` coordinates
  /// prescribed.
  virtual void add_second(const double* x, const double* stress, int led,
                          ComplianceForm::Second& h) const noexcept = 0;
};

/// Element of the strains of a law.
template <RodLaw Law>
class LawElement final : public RodElement {
 public:
  /// Strains that the element has.
  using Part = LawPart<Law>;
  static constexpr int size = Part::coordinates;  // number of coordinates

  /// Takes the law and its coefficients.
  LawElement(Law law, const ElementConstants<Law>& constants) : part_{std::move(law)} {
    std::ranges::copy(constants.stiffness, part_.stiffness);
    std::ranges::copy(constants.friction, part_.friction);
  }

  int nodes() const override { return Law::nodes; }
  void rest_at(const double* x) override {
    double s[Part::strains];
    part_.strain(x, s);
    for (int k = 0; k < Part::strains; ++k) s[k] += part_.rest[k];
    if constexpr (requires { part_.law.natural(s); }) part_.law.natural(s);
    std::ranges::copy(s, part_.rest);
  }
  void add_force(const double* x, const double* rate, double* f) const noexcept override {
    Strained(part_, x, rate).add_force(f);
  }
  void tangent(const double* x, const double* rate, double pos, double vel,
               const StressOrigin* origin, const double* from,
               double* h) const noexcept override {
    Strained now(part_, x, rate);
    if (from != nullptr) now.take_stresses(*origin, from);
    double all[size][size];
    now.tangent(pos, vel, all);
    std::copy_n(&all[0][0], size * size, h);
  }
  double energy(const double* x) const noexcept override {
    return strain_energy(part_, x);
  }
  double power(const double* x, const double* rate, int led) const noexcept override {
    const Strained now(part_, x, rate);
    double sum = now.friction_power();
    for (int k = 0; k < Part::strains; ++k) {
      for (int i = 0; i < led; ++i) sum += now.stress[k] * now.gradient[k][i] * rate[i];
    }
    return sum;
  }
  ComplianceForm::Block block(std::vector<int> coordinates) const override {
    return strain_block(part_, std::move(coordinates));
  }
  void strain(const double* x, const double* rate, int led,
              ComplianceForm::Value& value) const noexcept override {
    double g[Part::strains][size];
    part_.strain(x, value.c);
    part_.gradient(x, g);
    for (int k = 0; k < Part::strains; ++k) {
      value.drift[k] = 0;
      for (int i = 0; i < led; ++i) value.drift[k] += g[k][i] * rate[i];
      std::copy(g[k] + led, g[k] + size, value.gradient[k]);
    }
  }
  /// Adds the second derivatives of the strains, weighted with `stress`.
  void add_second(const double* x, const double* stress, int led,
                  ComplianceForm::Second& h) const noexcept override {
    double all[size][size] = {};
    part_.add_second(x, stress, all);
    for (int i = led; i < size; ++i) {
      for (int j = led; j < size; ++j) h[i - led][j - led] += all[i][j];
    }
  }

 private:
  Part part_;
};

}  // namespace tress::models
