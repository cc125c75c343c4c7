// What sticks to a body that turns stays where it is on it, by every method that takes
// exact friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "contract/forms/material_points.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/effects/exact_body.h"
#include "models/effects/gravity.h"
#include "models/strand/strand.h"
#include "tests/support/drive.h"

namespace tress::test_turning_body {
namespace {

using namespace models;
using testing_support::Drive;

constexpr double radius = 40e-6, g = 9.81, mu = 0.6;
// The strand lies from here outwards, 2 cm of it.
constexpr double inner = 0.03;
// Quarters of a second: 3 s, and one turn to and fro.
constexpr int long_run = 12, period = 2;

struct Turning {
  std::string model, integrator;
  bool rigid, free;
};
void PrintTo(const Turning& of, std::ostream* out) {
  *out << of.model << '_' << of.integrator << (of.rigid ? "_rigid" : "_compliant")
       << (of.free ? "_free" : "_rooted");
}

class TurningBody : public testing::TestWithParam<Turning> {
 protected:
  /// Turns to and fro by half a radian, twice a second, about the z axis.
  static RootMotion motion() {
    RootMotion head;
    head.rotations = {{{0, 0, 1}, one_minus_cosine(0.25, 2)}};
    return head;
  }
  std::unique_ptr<System> lying() const {
    Strand strand = make_strand({}, {radius, radius}, {.elements = 5, .length = 0.02},
                                uniform_shape({}));
    const ExactContact law{
        {.stiffness = 1e3, .damping = 1, .offset = radius}, GetParam().rigid, mu};
    // Compliant: at the depth at which the surface bears the weight.
    const double weight =
        strand.material.density * std::numbers::pi * radius * radius * g;
    const double sunk = GetParam().rigid ? 0 : weight / law.compliance.stiffness;
    const Vec at{inner, 0, radius - sunk};
    if (GetParam().free) {
      strand.free_root = FreeRoot{at, {}, {}, {}};
    } else {
      strand.root = motion();
      strand.root.position = at;
      strand.root.centre = Vec{};
    }
    const ModelEntry& model = find_model(GetParam().model);
    Parameters options(model.parameters, "test");
    return model.on_strand(
        strand, options,
        {std::make_shared<Gravity>(Vec{0, 0, -g}),
         std::make_shared<ExactBody>(Plane{}, StrandPlace{}, law, motion())});
  }
};

/// Places of the points on the body.
std::vector<double> places(System& system, const Integrator& method) {
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  points.positions(method.time(), method.q(), x);
  const double angle = one_minus_cosine(0.25, 2)(method.time()).value;
  const Frame turned = rotation({0, 0, 1}, angle);
  for (std::size_t i = 0; i < x.size(); i += 3) store3(turned.back(load3(&x[i])), &x[i]);
  return x;
}

TEST_P(TurningBody, WhatSticksStaysWhereItIs) {
  // A law of the velocity creeps most where steps are long and by backward Euler, and as
  // much in every period.
  const bool most = GetParam().integrator == "backward_euler" && !GetParam().free;
  const int frames = GetParam().rigid && !GetParam().free ? long_run : period;
  for (const double step : {4e-3, 1e-3}) {
    if (step < 4e-3 && !most) continue;
    const auto system = lying();
    Options options;
    options.step = step;
    if (system->layout().constraints > 0) options.formulation = Formulation::index3;
    Drive drive(GetParam().integrator, *system, options);
    ASSERT_EQ(drive.status, Status::ok) << drive.integrator->failure();
    const std::vector<double> start = places(*system, *drive.integrator);
    double farthest = 0;
    for (int frame = 1; frame <= frames; ++frame) {
      ASSERT_EQ(drive.to(0.25 * frame), Status::ok) << drive.integrator->failure();
      const std::vector<double> now = places(*system, *drive.integrator);
      for (std::size_t i = 0; i < now.size(); i += 3) {
        farthest = std::max(farthest, norm(load3(&now[i]) - load3(&start[i])));
      }
    }
    EXPECT_LT(farthest, 1e-6) << step;
  }
}

/// Every model with each of its contacts and roots, by one of the integrators in turn; or
/// by the others, which are `more`.
std::vector<Turning> turning(bool more) {
  std::vector<std::string> methods;
  for (const auto& one : integrators::integrator_catalogue()) {
    if (one.contact != integrators::Contact::regular) methods.emplace_back(one.id);
  }
  std::vector<Turning> all;
  std::size_t turn = 0;
  for (const ModelEntry& model : model_catalogue()) {
    if (!model.on_strand) continue;
    ++turn;  // so that the same contacts of two models are by two integrators
    for (const bool free : {true, false}) {
      if (free && model.roots != Roots::clamped_or_free) continue;
      for (const bool rigid : {true, false}) {
        const std::string own = methods[turn++ % methods.size()];
        for (const std::string& integrator : methods) {
          if ((integrator == own) == more) continue;
          all.push_back({std::string(model.id), integrator, rigid, free});
        }
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Models, TurningBody, testing::ValuesIn(turning(false)),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(More, TurningBody, testing::ValuesIn(turning(true)),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace tress::test_turning_body
