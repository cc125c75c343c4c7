#include "models/strand/points_along.h"

#include <algorithm>

#include "contract/input_error.h"
#include "models/strand/arc_lengths.h"

namespace tress::models {

std::vector<double> lengths_of_points(const Strand& strand, std::size_t points,
                                      const std::string& where) {
  if (points != strand.segments.size() + 1) {
    throw InputError("the model's points are not the ends of its elements", where,
                     "compare runs of two numbers of elements by their tips");
  }
  return arc_lengths(strand);
}

PointBetween point_between(double place, const std::vector<double>& among) {
  const auto above =
      static_cast<std::size_t>(std::ranges::lower_bound(among, place) - among.begin());
  PointBetween made;
  made.count = std::min(among.size(), made.weight.size());
  made.first = std::min(above > 1 ? above - 2 : 0, among.size() - made.count);
  for (std::size_t i = 0; i < made.count; ++i) {
    made.weight[i] = 1;
    for (std::size_t j = 0; j < made.count; ++j) {
      if (i == j) continue;
      const double xi = among[made.first + i], xj = among[made.first + j];
      made.weight[i] *= (place - xj) / (xi - xj);
    }
  }
  return made;
}

}  // namespace tress::models
