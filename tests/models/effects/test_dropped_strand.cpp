// A strand dropped flat on a rigid plane stays there, by every method that takes exact
// contact: without restitution nothing throws it back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "contract/forms/material_points.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/effects/exact_body.h"
#include "models/effects/gravity.h"
#include "models/strand/strand.h"
#include "tests/support/drive.h"

namespace tress::test_dropped_strand {
namespace {

using namespace models;
using testing_support::Drive;

constexpr double radius = 40e-6, g = 9.81, mu = 0.3, height = 0.02, sideways = 0.5;

struct Dropped {
  std::string model, integrator;
  double step;  // s; 0: with a tolerance
};
void PrintTo(const Dropped& of, std::ostream* out) {
  *out << of.model << '_' << of.integrator << '_' << std::lround(1e6 * of.step) << "_us";
}

class DroppedStrand : public testing::TestWithParam<Dropped> {
 protected:
  static std::unique_ptr<System> falling() {
    Strand strand = make_strand({}, {radius, radius}, {.elements = 4, .length = 0.04},
                                uniform_shape({}));
    strand.free_root = FreeRoot{{0, 0, height + radius},
                                {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                                {sideways, 0, 0},
                                {}};
    const ExactContact law{{.stiffness = 1, .offset = radius}, true, mu};
    const ModelEntry& model = find_model(GetParam().model);
    Parameters options(model.parameters, "test");
    return model.on_strand(strand, options,
                           {std::make_shared<Gravity>(Vec{0, 0, -g}),
                            std::make_shared<ExactBody>(Plane{}, StrandPlace{}, law)});
  }
};

/// It lands at the speed u, and loses mu u of its speed sideways in the impact. It then
/// slides to rest. Methods find the time of the impact within two steps, and the impact
/// itself by backward Euler.
TEST_P(DroppedStrand, LandsAndSlidesToRest) {
  const double landing = std::sqrt(2 * height / g), u = g * landing;
  const double slow = sideways - mu * u;
  const double expected = sideways * landing + slow * slow / (2 * mu * g);
  const auto system = falling();
  Options options;
  if (GetParam().step > 0) {
    options.step = GetParam().step;
  } else {
    options.tolerance = 1e-3;
  }
  if (system->layout().constraints > 0) {
    options.formulation =
        GetParam().step > 0 ? Formulation::index3 : Formulation::projection;
  }
  Drive drive(GetParam().integrator, *system, options);
  ASSERT_EQ(drive.status, Status::ok) << drive.integrator->failure();
  MaterialPoints& points = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  const double landed = landing + 2 * GetParam().step;
  double highest = 0, reached = 0;
  for (double t = 0; t < 0.2; t += 0.01) {
    ASSERT_EQ(drive.to(t + 0.01), Status::ok) << drive.integrator->failure();
    points.positions(drive.integrator->time(), drive.integrator->q(), x);
    reached = x[0];
    if (t + 0.01 < landed) continue;
    for (std::size_t i = 2; i < x.size(); i += 3) {
      highest = std::max(highest, std::abs(x[i] - radius));
    }
  }
  // The contact tolerance, 1e-8 m/s, over all steps from one frame to the next.
  EXPECT_LT(highest, 1e-7);
  // A tolerance bounds the error of each step, of which two make the impact.
  const double late = GetParam().step > 0 ? 2 * GetParam().step * mu * u : 4e-3 * 0.04;
  EXPECT_NEAR(reached, expected, late);
}

/// A clamped strand swings down on a slope, on which its parts land one after the other.
/// Tolerances bound the errors of impacts too, and no step falls below 1e-7 s.
TEST(SwingingStrand, LandsOnASlopeWithAnyTolerance) {
  for (const char* method : {"tr_bdf2", "esdirk43"}) {
    std::vector<double> finest;
    for (const double tolerance : {1e-6, 1e-5, 1e-4}) {
      Material material;
      material.youngs_modulus = 1e7;
      material.internal_friction = 1e-10;
      Strand strand = make_strand(material, {radius, radius},
                                  {.elements = 6, .length = 0.1}, uniform_shape({}));
      const ExactContact law{{.stiffness = 1, .offset = radius}, true, mu};
      const StrandPlace slope{{0.05, 0, -0.05}, rotation({0, 1, 0}, 0.6)};
      const ModelEntry& model = find_model("super_helix");
      const auto system =
          model.on_strand(strand, Parameters(model.parameters, "test"),
                          {std::make_shared<Gravity>(Vec{0, 0, -g}),
                           std::make_shared<ExactBody>(Plane{}, slope, law)});
      Options options;
      options.tolerance = tolerance;
      Drive drive(method, *system, options);
      ASSERT_EQ(drive.to(0.16), Status::ok)
          << method << ' ' << tolerance << ": " << drive.integrator->failure();
      MaterialPoints& points = *system->material_points();
      std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
      points.positions(drive.integrator->time(), drive.integrator->q(), x);
      if (finest.empty()) finest = x;
      // Some tens of impacts, each within the tolerance.
      for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(x[i], finest[i], 30 * tolerance * 0.1) << method << ' ' << tolerance;
      }
    }
  }
}

std::vector<Dropped> dropped() {
  std::vector<Dropped> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (!model.on_strand || model.roots != Roots::clamped_or_free) continue;
    for (const auto& method : integrators::integrator_catalogue()) {
      if (method.contact == integrators::Contact::regular) continue;
      for (const double step : {10e-3, 4e-3, 1e-3}) {
        all.push_back({std::string(model.id), std::string(method.id), step});
      }
      if (method.error_controlled &&
          method.controlled_contact != integrators::Contact::regular) {
        all.push_back({std::string(model.id), std::string(method.id), 0});
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Models, DroppedStrand, testing::ValuesIn(dropped()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace tress::test_dropped_strand
