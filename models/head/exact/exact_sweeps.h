#pragma once

#include "models/head/exact/exact_element.h"
#include "models/head/exact/exact_kernel.h"

/// Definitions of ExactKernel, for the source of each kind of element alone: other
/// sources have other options.
namespace tress::models {

template <class Kind>
TRESS_FLATTEN auto ExactKernel<Kind>::move(const Material& m, const Motion& root,
                                           const Unknowns* q, const Unknowns* v,
                                           const Unknowns* a, Scratch* scratch,
                                           Factors* factors) const -> Motion {
  Motion at = root;
  by_registers_of<T>([&] {
    for (int i = 0; i < kernel_.elements(); ++i) {
      factors[i].start = at;
      scratch[i].q = q[i];
      Kind::template move<true>(kernel_.rule(), m, q[i], v[i], a[i], at, scratch[i].kept);
    }
  });
  return at;
}

template <class Kind>
TRESS_FLATTEN auto ExactKernel<Kind>::newton(const Material& m, const Motion& end,
                                             const ExactPoint<T>* const* loads,
                                             const Unknowns* rest, Weights w,
                                             const Unknowns* q, const Unknowns* v,
                                             const Unknowns* a, Unknowns* correction,
                                             const Scratch* scratch,
                                             Factors* factors) const -> T {
  const int n = kernel_.elements();
  T most;
  by_registers_of<T>([&] {
    typename Elimination::Hanging hanging{};
    for (int i = n - 1; i >= 0; --i) {
      Factors& e = factors[i];
      const T rotor = T(i + 1 < n ? 1 : Kind::rotors_of_last) * m.rotor;
      Elimination::add_rotor(rotor, i + 1 < n ? factors[i + 1].start : end, hanging);
      const ExactElement<Kind> element(kernel_, m, w, q[i], v[i], a[i], scratch[i].kept);
      typename Elimination::Columns columns;
      element.own(hanging, e, columns);
      element.add_bending(Kernel::bending(m, w, i, q[i], rest[i], v[i]), columns);
      Elimination::carry(hanging, e, columns);
      // One code with and without loads: the same bits for strands that have none.
      e.placed = hanging.placed;
      typename Elimination::Places places{};
      if (any_less(T(0), e.placed)) {
        Elimination::carry(hanging, T(w.pos), e, columns, places);
      }
      if (loads != nullptr && loads[i] != nullptr) [[unlikely]] {
        element.add_loads(loads[i], e, columns, places);
      }
      Elimination::eliminate(columns, kernel_.twist(), e, hanging);
      if (any_less(T(0), e.placed)) Elimination::eliminate(places, T(w.pos), e, hanging);
    }
    most = Elimination::corrections(n, factors, each(correction));
  });
  return most;
}

template <class Kind>
TRESS_FLATTEN auto ExactKernel<Kind>::again(const Material& m, const Motion& end,
                                            const typename Kind::Loads* const* loads,
                                            const Unknowns* rest, const Unknowns* v,
                                            const Unknowns* a, Unknowns* correction,
                                            const Scratch* scratch,
                                            Factors* factors) const -> T {
  const int n = kernel_.elements();
  T most;
  by_registers_of<T>([&] {
    kernel_.residual(
        m, end, loads, [rest](int i) { return rest[i]; }, v, a, correction, scratch);
    Vec force, moment;
    for (int i = n - 1; i >= 0; --i) {
      Elimination::hang(factors[i], each(correction)[i], force, moment);
    }
    most = Elimination::corrections(n, factors, each(correction));
  });
  return most;
}

}  // namespace tress::models
