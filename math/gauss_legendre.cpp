#include "math/gauss_legendre.h"

#include <gsl/gsl_integration.h>

#include <memory>

namespace tress {

std::vector<QuadraturePoint> gauss_legendre(int count, double length) {
  std::vector<QuadraturePoint> points(static_cast<std::size_t>(count));
  const std::unique_ptr<gsl_integration_glfixed_table,
                        decltype(&gsl_integration_glfixed_table_free)>
      table(gsl_integration_glfixed_table_alloc(points.size()),
            gsl_integration_glfixed_table_free);
  for (std::size_t i = 0; i < points.size(); ++i) {
    gsl_integration_glfixed_point(0, length, i, &points[i].at, &points[i].weight,
                                  table.get());
  }
  return points;
}

}  // namespace tress
