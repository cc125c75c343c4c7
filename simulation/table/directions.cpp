#include "simulation/table/directions.h"

#include <cmath>
#include <string>

#include "contract/input_error.h"

namespace tress::simulation {

Vec direction(const Table& table, std::string_view key) {
  const Vec given = table.values().vec(key);
  const double length = std::hypot(given.x, given.y, given.z);  // for 1e200, too
  if (length > 0) return Vec{given.x / length, given.y / length, given.z / length};
  throw InputError(std::string(key) + " has no direction", table.place(key),
                   "give three numbers that are not all 0");
}

}  // namespace tress::simulation
