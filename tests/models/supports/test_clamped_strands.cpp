// Strands between clamps against closed forms of beams and of the elastica.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "contract/forms/sparse_form.h"
#include "experiments/numerics/dense_algebra.h"
#include "simulation/rest/supported_start.h"
#include "tests/models/supports/held_strand.h"

namespace tress::test_clamped_strands {

using namespace testing_support;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double length = 0.1, radius = 2e-4, modulus = 3e9, density = 1300;  // SI
const double area = std::numbers::pi * radius * radius;
const double bending = modulus * area * radius * radius / 4;

ModelSettings straight(const std::string& elements) {
  return {{"elements", elements},    {"motion", "fixed"},
          {"radius_m", "2e-4"},      {"youngs_modulus_pa", "3e9"},
          {"density_kg_m3", "1300"}, {"internal_friction_kg_m3_s", "0"}};
}

/// S(w) of a system, dense.
MatrixXd matrix_of(System& system, In q, In lambda, Weights w) {
  SparseForm& form = *system.sparse_form();
  const Pattern& pattern = form.pattern();
  const std::vector<double> zero(q.size());
  std::vector<double> values(std::size_t(pattern.nonzeros()));
  EXPECT_EQ(form.values(0, q, zero, zero, w, values), Status::ok);
  if (w.pos != 0 && system.layout().constraints > 0) {
    EXPECT_EQ(system.constraint_form()->add_curvature(0, q, lambda, -w.pos, values),
              Status::ok);
  }
  MatrixXd full = MatrixXd::Zero(pattern.rows, pattern.cols);
  for (int k = 0; k < pattern.cols; ++k) {
    for (int p = pattern.start[std::size_t(k)]; p < pattern.start[std::size_t(k) + 1];
         ++p) {
      full(pattern.row[std::size_t(p)], k) = values[std::size_t(p)];
    }
  }
  return full;
}

/// Orthonormal motions that the constraints admit, in typical sizes.
MatrixXd free_motions(System& system, In q) {
  const auto n = static_cast<Eigen::Index>(q.size());
  std::vector<double> q_typ(q.size()), v_typ(q.size());
  system.scale(q_typ, v_typ);
  const VectorXd typ = Eigen::Map<const VectorXd>(q_typ.data(), n);
  if (system.layout().constraints == 0) return typ.asDiagonal();
  ConstraintForm& form = *system.constraint_form();
  const Pattern& pattern = form.pattern();
  std::vector<double> values(std::size_t(pattern.nonzeros()));
  EXPECT_EQ(form.gradient(0, q, values), Status::ok);
  MatrixXd g = MatrixXd::Zero(n, pattern.cols);
  for (int k = 0; k < pattern.cols; ++k) {
    for (int p = pattern.start[std::size_t(k)]; p < pattern.start[std::size_t(k) + 1];
         ++p) {
      g(pattern.row[std::size_t(p)], k) = values[std::size_t(p)];
    }
    g.col(k) = typ.asDiagonal() * g.col(k);
    g.col(k) /= g.col(k).norm();
  }
  EXPECT_TRUE(experiments::is_definite(g.transpose() * g));  // independent
  return typ.asDiagonal() * experiments::complement(g);
}

/// A strand whose tip is clamped as it begins, and free to slide along it.
std::unique_ptr<SupportedSystem> sliding(const std::string& model,
                                         const std::string& elements,
                                         const ModelSettings& more = {}) {
  const ModelSettings settings = with(straight(elements), more);
  auto strand = make_model(model, settings);
  Support clamp = clamp_of_tip(*strand, model, settings);
  clamp.axes = {{0, 1, 0}, {0, 0, 1}};
  return std::make_unique<SupportedSystem>(std::move(strand), std::vector{clamp});
}

/// Lowest angular frequency of small motions from the start, 1/s.
double first_frequency(SupportedSystem& system) {
  std::vector<double> q = zeros(system), v = q,
                      lambda(std::size_t(system.layout().constraints));
  system.initial_state(q, v);
  const MatrixXd z = free_motions(system, q);
  const MatrixXd m = z.transpose() * matrix_of(system, q, lambda, {1, 0, 0}) * z,
                 k = z.transpose() * matrix_of(system, q, lambda, {0, 0, 1}) * z;
  // Massless coordinates have infinite frequencies: 1/omega^2 of K^-1 M.
  const Eigen::VectorXcd inverse = experiments::eigenvalues(experiments::solution(k, m));
  return 1 / std::sqrt(inverse.real().maxCoeff());
}

struct Accuracy {
  const char* name;
  const char* model;
  ModelSettings settings;
  double bar;  // with the larger number of elements
  double order = 2;
  const char *coarse = "20", *fine = "40";  // elements
};
void PrintTo(const Accuracy& c, std::ostream* out) { *out << c.name; }  // NOLINT

class ClampedStrands : public testing::TestWithParam<Accuracy> {};

/// omega = 4.730041^2 sqrt(EI/(rho A L^4)); rotational inertia of the section lowers it
/// by (r/L)^2 at most. Elements err by order 2 (SuperClothoid: 4).
TEST_P(ClampedStrands, HaveTheFirstFrequencyOfABeamBetweenClamps) {
  const auto& [name, model, settings, bar, order, coarse, fine] = GetParam();
  const double exact = std::pow(4.730040745, 2) *
                       std::sqrt(bending / (density * area * std::pow(length, 4)));
  std::vector<double> errors;
  for (const char* elements : {coarse, fine}) {
    errors.push_back(first_frequency(*sliding(model, elements,
                                              with(settings, {{"gravity_m_s2", "0"}}))) /
                         exact -
                     1);
  }
  std::printf("%s: first frequency off by %.2e with %s, %.2e with %s elements\n", name,
              errors[0], coarse, errors[1], fine);
  EXPECT_LE(std::abs(errors[1]), bar);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.3);
}

/// Sag of the middle, rho A g L^4/(384 EI), as the linear answer to the weight.
TEST_P(ClampedStrands, SagAsABeamBetweenClamps) {
  const auto& [name, model, settings, bar, order, coarse, fine] = GetParam();
  const auto system = sliding(model, fine, settings);
  std::vector<double> q = zeros(*system), v = q, r = q,
                      lambda(std::size_t(system->layout().constraints));
  system->initial_state(q, v);
  ASSERT_EQ(system->residual(0, q, v, v, r), Status::ok);
  const MatrixXd z = free_motions(*system, q);
  const MatrixXd k = z.transpose() * matrix_of(*system, q, lambda, {0, 0, 1}) * z;
  const VectorXd load = z.transpose() * Eigen::Map<const VectorXd>(r.data(), z.rows());
  const VectorXd moved = z * experiments::solution(k, -load);
  MaterialPoints& points = *system->material_points();
  std::vector<double> u(3 * std::size_t(points.count()));
  points.velocities(0, q, In(moved.data(), q.size()), u);
  const double exact = density * area * 9.81 * std::pow(length, 4) / (384 * bending);
  const double sag = -u[3 * (u.size() / 6) + 2];
  std::printf("%s: sag over that of a beam %.6f\n", name, sag / exact);
  // Edges err by up to twice what they do in the square of the frequency.
  EXPECT_NEAR(sag / exact, 1, 4 * bar);
}

const ModelSettings none;
INSTANTIATE_TEST_SUITE_P(
    Models, ClampedStrands,
    testing::Values(
        Accuracy{"super_helix", "super_helix", none, 5e-3},
        Accuracy{"super_helix_bend", "super_helix", {{"modes", "bend"}}, 5e-3},
        Accuracy{"super_clothoid", "super_clothoid", none, 1e-4, 4, "6", "12"},
        Accuracy{"articulated_chain", "articulated_chain", none, 5e-3},
        Accuracy{"der", "der", none, 5e-3},
        Accuracy{"der_inextensible", "der", {{"stretch", "inextensible"}}, 5e-3},
        Accuracy{"mass_spring", "mass_spring", none, 5e-3},
        Accuracy{"corde", "corde", none, 5e-3},
        Accuracy{"xpbd_cosserat", "xpbd_cosserat", none, 5e-3},
        Accuracy{"lifted_curls", "lifted_curls", none, 5e-3},
        Accuracy{"inextensible_strand", "inextensible_strand", none, 5e-3},
        Accuracy{"dynamic_spline", "dynamic_spline", none, 1e-4, 4, "6", "12"}),
    [](const auto& test) { return std::string(test.param.name); });

/// Modulus k of the elastica whose ends come together by this part of its length.
double elastica(double push) {
  double low = 1e-6, high = 0.95;
  for (int i = 0; i < 100; ++i) {
    const double k = (low + high) / 2;
    const double distance = 2 * std::comp_ellint_2(k) / std::comp_ellint_1(k) - 1;
    (distance > 1 - push ? low : high) = k;
  }
  return low;
}

struct Pushed {
  const char* model;
  const char* elements;
  double bar;
};

/// Both ends clamped and pushed together: P = 16 K(k)^2 EI/L^2 at the distance
/// L (2 E(k)/K(k) - 1). Elements err by order 2: those of der by 1.6e-2 with 40 at a push
/// of 0.6, 4.2e-3 with 80.
TEST(PushedStrands, BuckleAsTheElasticaBetweenClamps) {
  for (const Pushed& c :
       {Pushed{"super_helix", "40", 5e-3}, Pushed{"super_clothoid", "20", 2e-4},
        Pushed{"der", "80", 5e-3}, Pushed{"articulated_chain", "40", 5e-3}}) {
    for (const double push : {0.1, 0.3, 0.6}) {
      const ModelSettings settings =
          with(straight(c.elements), {{"gravity_m_s2", "0"}, {"radius_m", "4e-5"}});
      auto strand = make_model(c.model, settings);
      Support clamp = clamp_of_tip(*strand, c.model, settings);
      clamp.path.position = {length * (1 - push), 0, 0};
      SupportedSystem held(std::move(strand), {clamp});
      const auto start = simulation::begin_on_supports(held, c.model);
      std::vector<double> q = zeros(held), v = q, force(3), moment(3);
      held.initial_state(q, v);
      ASSERT_EQ(held.support_forces(0, q, v, force, moment), Status::ok);
      const double k = std::comp_ellint_1(elastica(push));
      const double expected =
          16 * k * k * bending * std::pow(4e-5 / radius, 4) / (length * length);
      std::printf("%s pushed by %g: force over that of the elastica %.6f, %d steps\n",
                  c.model, push, -force[0] / expected, start.steps);
      EXPECT_NEAR(-force[0] / expected, 1, c.bar) << c.model << ' ' << push;
      // Inflections are at quarters: the moment is P times half the rise k L/K.
      const double end = expected * elastica(push) * length / (2 * k);
      EXPECT_NEAR(norm(load3(moment.data())) / end, 1, 2 * c.bar)
          << c.model << ' ' << push;
    }
  }
}

/// A straight strand between clamps, one of which slides, buckles under a twisting moment
/// of 8.98682 EI/L (Greenhill), where the stiffness loses rank. Elements err by order 2:
/// helices by 1.1e-3 with 40, 4.7e-3 with 20; edges, whose joints twist by 0.33 rad, by
/// -2.2e-2 with 40, -5.8e-3 with 80.
TEST(TwistedStrands, BuckleUnderTheMomentOfGreenhill) {
  constexpr double greenhill = 8.986819, torsion = 1 / 1.48;  // GJ/EI, nu = 0.48
  for (const auto& [model, bar] :
       {std::pair<std::string, double>{"super_helix", 2e-3}, {"der", 2.5e-2}}) {
    /// Least eigenvalue at a moment, in units of EI/L.
    const auto least = [&, model = model](double moment) {
      const double turn = moment / torsion;  // rad, of the tip
      const ModelSettings settings = straight("40");
      auto strand = make_model(model, settings);
      Support clamp = clamp_of_tip(*strand, model, settings);
      clamp.axes = {{0, 1, 0}, {0, 0, 1}};
      clamp.path.frame = rotation({1, 0, 0}, turn) * clamp.path.frame;
      SupportedSystem held(std::move(strand), {clamp});
      std::vector<double> q = zeros(held), v = q,
                          lambda(std::size_t(held.layout().constraints));
      held.initial_state(q, v);
      for (std::size_t i = 0; i < 40; ++i) {
        if (model == "der") {
          q[120 + i] = turn * (double(i) + 0.5) / 40;
        } else {
          q[3 * i] = turn / length;
        }
      }
      if (model != "der") lambda[2] = moment * bending / length;
      const MatrixXd z = free_motions(held, q);
      const MatrixXd k = z.transpose() * matrix_of(held, q, lambda, {0, 0, 1}) * z;
      return experiments::symmetric_eigenvalues((k + k.transpose()) / 2)[0];
    };
    double low = 7, high = 11;
    ASSERT_GT(least(low), 0) << model;
    ASSERT_LT(least(high), 0) << model;
    while (high - low > 1e-4) {
      const double middle = (low + high) / 2;
      (least(middle) > 0 ? low : high) = middle;
    }
    std::printf("%s: critical moment over that of Greenhill %.6f\n", model.c_str(),
                low / greenhill);
    EXPECT_NEAR(low / greenhill, 1, bar) << model;
  }
}

}  // namespace tress::test_clamped_strands
