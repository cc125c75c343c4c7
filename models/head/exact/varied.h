#pragma once

#include "math/dual.h"
#include "math/matrix3.h"

namespace tress::models {

/// A number with its derivatives along the three unknowns of an element.
template <class T>
using Varied = Dual<3, T>;
/// Vector of varied numbers.
template <class T>
using VariedVec = Vec3<Varied<T>>;

/// Returns a number with these derivatives.
template <class T>
Varied<T> varied(const T& x, const Vec3<T>& slope) {
  Varied<T> y(x);
  y.part = {slope.x, slope.y, slope.z};
  return y;
}
/// x whose component k grows by `slope` with unknown k.
template <class T>
VariedVec<T> varied_alike(const Vec3<T>& x, const T& slope) {
  const T o(0);
  return {varied(x.x, {slope, o, o}), varied(x.y, {o, slope, o}),
          varied(x.z, {o, o, slope})};
}

/// Returns the value without derivatives.
template <class T>
Vec3<T> value_of(const VariedVec<T>& x) {
  return {x.x.value, x.y.value, x.z.value};
}
/// Returns the derivative along unknown k.
template <class T>
Vec3<T> part_of(const VariedVec<T>& x, std::size_t k) {
  return {x.x.part[k], x.y.part[k], x.z.part[k]};
}
/// Returns the value without derivatives.
template <class T>
Matrix3<T> value_of(const Matrix3<Varied<T>>& m) {
  return {{value_of(m.row[0]), value_of(m.row[1]), value_of(m.row[2])}};
}
/// Derivatives by columns.
template <class T>
Matrix3<T> parts_of(const VariedVec<T>& x) {
  const auto row = [](const Varied<T>& y) {
    return Vec3<T>{y.part[0], y.part[1], y.part[2]};
  };
  return {{row(x.x), row(x.y), row(x.z)}};
}
/// Returns a vector with these derivatives.
template <class T>
VariedVec<T> with_parts(const Vec3<T>& x, const Vec3<T>& p0, const Vec3<T>& p1,
                        const Vec3<T>& p2) {
  return {varied(x.x, {p0.x, p1.x, p2.x}), varied(x.y, {p0.y, p1.y, p2.y}),
          varied(x.z, {p0.z, p1.z, p2.z})};
}

}  // namespace tress::models
