// A straight strand that lies on a plane and is pushed to and fro: all its points move as
// one mass with Coulomb's friction, whose steps are written out here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "contract/forms/material_points.h"
#include "integrators/bdf2_formula.h"
#include "integrators/catalogue.h"
#include "integrators/tr_bdf2.h"
#include "models/catalogue.h"
#include "models/effects/exact_body.h"
#include "models/effects/gravity.h"
#include "models/strand/strand.h"
#include "tests/support/drive.h"

namespace tress::test_shaken_plate {
namespace {

using namespace models;
using testing_support::Drive;

constexpr double radius = 40e-6, mu = 0.3, g = 9.81, step = 0.59e-3;
constexpr int steps_of_period = 200;

/// The acceleration `most` sin(omega t) along `way`.
class Shaken final : public Effect {
 public:
  Shaken(const Vec& way, double most) : way_(way), most_(most) {}
  std::string_view name() const override { return "shaken"; }
  Needs needs() const override { return {}; }
  static double acceleration(double most, double t) {
    return most * std::sin(2 * std::numbers::pi * t / (steps_of_period * step));
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override {
    const double a = acceleration(most_, t);
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      store3(load3(&f[3 * i]) + (p.mass[i] * a) * way_, &f[3 * i]);
    }
  }
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  Vec way_;
  double most_;
};

struct ShakenCase {
  std::string model, integrator;
  bool rigid;
  bool upright;  // the plane's normal is z, else y
};
void PrintTo(const ShakenCase& of, std::ostream* out) {
  *out << of.model << '_' << of.integrator << (of.rigid ? "_rigid" : "_compliant")
       << (of.upright ? "_level" : "_wall");
}

/// One mass: places and velocities after every step.
struct Mass {
  double most;
  double x = 0, v = 0, a = 0;
  double x_before = 0, v_before = 0;

  /// Velocity of a stage v = v_bar + w a; friction is the force that stops it, or all
  /// that there can be.
  double stage(double t, double v_bar, double w) {
    const double push = Shaken::acceleration(most, t);
    const double stops = -v_bar / w - push;
    a = push + std::clamp(stops, -mu * g, mu * g);
    return std::abs(stops) <= mu * g ? 0 : v_bar + w * a;
  }
  void step_bdf(int i, bool second) {
    const integrators::Bdf2Formula of(step, second && i > 0 ? 1 : 0);
    const double v_bar = of.c0 * v - of.c1 * v_before,
                 x_bar = of.c0 * x - of.c1 * x_before;
    v_before = v;
    x_before = x;
    v = stage((i + 1) * step, v_bar, of.bh);
    x = x_bar + of.bh * v;
  }
  void step_tr_bdf2(int i) {
    const integrators::EsdirkTable& table = integrators::tr_bdf2_table();
    double vs[3] = {v}, as[3] = {a};
    for (std::size_t k = 1; k < 3; ++k) {
      double v_bar = v;
      for (std::size_t j = 0; j < k; ++j) v_bar += step * table.a[k][j] * as[j];
      vs[k] = stage((i + table.c(k)) * step, v_bar, step * table.gamma());
      as[k] = a;
    }
    for (std::size_t j = 0; j < 3; ++j) x += step * table.a[2][j] * vs[j];
    v = vs[2];
  }
  void go(const std::string& integrator, int i) {
    if (integrator == "tr_bdf2") return step_tr_bdf2(i);
    step_bdf(i, integrator == "bdf2");
  }
};

class ShakenPlate : public testing::TestWithParam<ShakenCase> {
 protected:
  std::unique_ptr<System> lying(double most) const {
    Strand strand = make_strand({}, {radius, radius}, {.elements = 8, .length = 0.1},
                                uniform_shape({}));
    const Vec up = GetParam().upright ? Vec{0, 0, 1} : Vec{0, 1, 0};
    const Vec way = GetParam().upright ? Vec{0, 1, 0} : Vec{0, 0, 1};
    const ExactContact law{
        {.stiffness = 1e3, .damping = 1, .offset = radius}, GetParam().rigid, mu};
    // Compliant: at the depth at which the surface bears the weight.
    const double weight = 1300 * std::numbers::pi * radius * radius * g;
    const double sunk = GetParam().rigid ? 0 : weight / law.compliance.stiffness;
    strand.free_root = FreeRoot{(radius - sunk) * up, {}, {}, {}};
    const Frame frame =
        GetParam().upright ? Frame{} : Frame{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    const ModelEntry& model = find_model(GetParam().model);
    Parameters options(model.parameters, "test");
    if (model.id == "super_clothoid") options.set("quadrature", "4");
    return model.on_strand(
        strand, options,
        {std::make_shared<Gravity>(-g * up), std::make_shared<Shaken>(way, most),
         std::make_shared<ExactBody>(Plane{}, StrandPlace{{}, frame}, law)});
  }
};

TEST_P(ShakenPlate, MovesAsOneMass) {
  const auto parts =
      GetParam().rigid ? std::vector{0.13, 1.1, 2.0} : std::vector{0.9, 1.4, 4.0};
  for (const double part : parts) {
    const double most = part * mu * g;
    const auto system = lying(most);
    Options options;
    options.step = step;
    if (system->layout().constraints > 0) options.formulation = Formulation::index3;
    Drive drive(GetParam().integrator, *system, options);
    ASSERT_EQ(drive.status, Status::ok) << drive.integrator->failure();
    const Integrator& method = *drive.integrator;
    Mass mass{.most = most};
    MaterialPoints& points = *system->material_points();
    std::vector<double> x0(3 * static_cast<std::size_t>(points.count())), x(x0);
    points.positions(0, drive.q0, x0);
    const std::size_t across = GetParam().upright ? 1 : 2;
    double farthest = 0;
    for (int i = 0; i < 2 * steps_of_period; ++i) {
      ASSERT_EQ(drive.to((i + 1) * step), Status::ok) << method.failure();
      EXPECT_LE(system->contact_form()->drive(), options.contact_tolerance);
      mass.go(GetParam().integrator, i);
      points.positions(method.time(), method.q(), x);
      for (std::size_t k = across; k < x.size(); k += 3) {
        farthest = std::max(farthest, std::abs(x[k] - x0[k] - mass.x));
      }
    }
    // Every step leaves the speed to the tolerance. Where the mass matrix is singular a
    // Runge-Kutta method starts from the acceleration of 1e-6 s later (Dynamics::
    // accelerate), which moves the speed by a step of the difference until it sticks.
    const double span = 2 * steps_of_period * step;
    const double later = Shaken::acceleration(most, 1e-6) * step;
    const double left =
        options.contact_tolerance + (GetParam().integrator == "tr_bdf2" ? later : 0);
    EXPECT_LE(farthest, span * left) << part;
    EXPECT_EQ(method.stats().contact_unfinished, 0) << part;
  }
}

/// Every model in each place, by one of the integrators in turn; or by the others, which
/// are `more`.
std::vector<ShakenCase> shaken(bool more) {
  constexpr const char* integrators[] = {"backward_euler", "bdf2", "tr_bdf2"};
  std::vector<ShakenCase> all;
  std::size_t turn = 0;
  for (const ModelEntry& model : model_catalogue()) {
    if (!model.on_strand || model.roots != Roots::clamped_or_free) continue;
    for (const bool rigid : {true, false}) {
      for (const bool upright : {true, false}) {
        const std::string own = integrators[turn++ % 3];
        for (const std::string integrator : integrators) {
          if ((integrator == own) == more) continue;
          all.push_back({std::string(model.id), integrator, rigid, upright});
        }
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Models, ShakenPlate, testing::ValuesIn(shaken(false)),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(More, ShakenPlate, testing::ValuesIn(shaken(true)),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace tress::test_shaken_plate
