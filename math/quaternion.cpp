#include "math/quaternion.h"

#include <algorithm>

namespace tress {

Quaternion quaternion_of(const Frame& f) {
  // 4 q q^T by columns; the one of the largest entry of q loses no digits.
  const double x = f.e0.x, y = f.e1.y, z = f.e2.z;
  const double wx = f.e1.z - f.e2.y, wy = f.e2.x - f.e0.z, wz = f.e0.y - f.e1.x;
  const double xy = f.e0.y + f.e1.x, xz = f.e2.x + f.e0.z, yz = f.e1.z + f.e2.y;
  const Quaternion columns[] = {{1 + x + y + z, {wx, wy, wz}},
                                {wx, {1 + x - y - z, xy, xz}},
                                {wy, {xy, 1 - x + y - z, yz}},
                                {wz, {xz, yz, 1 - x - y + z}}};
  const Quaternion& q =
      *std::ranges::max_element(columns, {}, [](const auto& c) { return dot(c, c); });
  return 1 / std::sqrt(dot(q, q)) * q;
}

}  // namespace tress
