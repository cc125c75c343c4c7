// Matrices for other programs: they are those that the equations of motion have.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <string>

#include "contract/forms/constraint_form.h"
#include "contract/input_error.h"
#include "experiments/matrices/system_matrices.h"
#include "simulation/scene/scene.h"

namespace tress::test_matrices {

using namespace experiments;
using namespace experiments::matrices;

Scene strand_by(const std::string& model, const std::string& options = "") {
  return simulation::parse_scene("title = \"t\"\nduration_s = 1\n[model]\nid = \"" +
                                     model + "\"\n" + options +
                                     R"(
[integrator]
id = "bdf2"
dt_s = 0.002
[strand]
length_m = 0.1
elements = 6
root_tangent = [1, 0, 0]
shape = "helix"
curl_radius_m = 0.01
curl_pitch_m = 0.05
[effects.gravity]
[effects.linear_drag]
)",
                                 "matrices.toml");
}

constexpr double h = 1e-3;

/// Error of what the model's own solver finds for S x, x the scale of its coordinates.
double solver_error(const std::string& model, const std::string& options) {
  Moment now = moment(strand_by(model, options), 0, 0.05);
  const std::vector<Named> all = matrices_of(now, h);
  const Instant& at = now.at;
  EXPECT_EQ(now.system->linearize(at.t, at.q, at.v, at.a, {1, h, h * h}), Status::ok);
  const auto n = static_cast<Eigen::Index>(at.q.size());
  Eigen::VectorXd q_typ(n), v_typ(n), x(n);
  now.system->scale({q_typ.data(), at.q.size()}, {v_typ.data(), at.q.size()});
  const Eigen::MatrixXd s = all[3].matrix.dense();
  const Eigen::VectorXd b = s * q_typ;
  EXPECT_EQ(now.system->solve({b.data(), at.q.size()}, {x.data(), at.q.size()}),
            Status::ok);
  return (x - q_typ).cwiseAbs().maxCoeff() / q_typ.maxCoeff();
}

// D and K by differences are good to 1e-10 of their largest entries; the condition of S
// in the coordinates' scales, some 1e3 here, multiplies that.
TEST(Matrices, OfAStepAreThoseThatTheModelSolvesWith) {
  for (const char* model : {"super_helix", "articulated_chain", "der"}) {
    EXPECT_LT(solver_error(model, "jacobian = \"exact\""), 1e-6) << model;
  }
  for (const char* model : {"corde", "mass_spring"}) {
    EXPECT_LT(solver_error(model, ""), 1e-6) << model;
  }
}

TEST(Matrices, OfTheResidualAgreeWithTheSparseForm) {
  Moment now = moment(strand_by("der", "jacobian = \"exact\""), 0, 0.05);
  const std::vector<Named> all = matrices_of(now, h);
  const Weights of[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::MatrixXd sparse = all[i].matrix.dense();
    const Eigen::MatrixXd dense = tangent_of_residual(*now.system, now.at, of[i]);
    EXPECT_TRUE(all[i].analytic);
    EXPECT_LT((sparse - dense).cwiseAbs().maxCoeff(), 1e-8 * sparse.cwiseAbs().maxCoeff())
        << all[i].name;
  }
}

TEST(Matrices, AccelerationsAndMultipliersSolveTheEquations) {
  const Scene scene = simulation::parse_scene(
      "title = \"t\"\nduration_s = 1\n[model]\nid = \"tinkertoys\"\nstructure = "
      "\"truss\"\nsize = 4\n"
      "spin_rad_s = 2\n[integrator]\nid = \"generalized_alpha\"\nformulation = "
      "\"projection\"\ndt_s = 0.002\n",
      "truss.toml");
  Moment now = moment(scene, 0, 0.1);
  const std::vector<Named> all = matrices_of(now, h);
  ASSERT_EQ(all[4].name, "G");
  const Eigen::MatrixXd g = all[4].matrix.dense();
  EXPECT_GT(g.rows(), g.cols());  // more constraints than coordinates: some are redundant
  const auto n = static_cast<Eigen::Index>(now.at.q.size());
  Eigen::VectorXd r(n), bias(g.rows());
  EXPECT_EQ(now.system->residual(now.at.t, now.at.q, now.at.v, now.at.a,
                                 {r.data(), now.at.q.size()}),
            Status::ok);
  EXPECT_EQ(now.system->constraint_form()->bias(
                now.at.t, now.at.q, now.at.v,
                {bias.data(), static_cast<std::size_t>(bias.size())}),
            Status::ok);
  const Eigen::Map<const Eigen::VectorXd> a(now.at.a.data(), n),
      lambda(now.multipliers.data(), g.rows());
  const double force = (g.transpose() * lambda).norm();
  EXPECT_GT(force, 0.01);  // it spins
  EXPECT_LT((r - g.transpose() * lambda).norm(), 1e-9 * force);
  EXPECT_LT((g * a + bias).norm(), 1e-8 * bias.norm());
}

TEST(Matrices, ReadBackToTheSameBits) {
  const Matrix matrix{3, 2, {{0, 0, 1.0 / 3}, {2, 0, -5e-324}, {1, 1, 1e300}}};
  std::istringstream text(matrix_market(matrix, "a comment"));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real general");
  std::getline(text, line);
  EXPECT_EQ(line, "% a comment");
  int rows = 0, cols = 0;
  std::size_t nonzeros = 0;
  text >> rows >> cols >> nonzeros;
  EXPECT_EQ(rows, 3);
  EXPECT_EQ(cols, 2);
  ASSERT_EQ(nonzeros, matrix.entries.size());
  for (const Matrix::Entry& e : matrix.entries) {
    int row = 0, col = 0;
    std::string value;
    text >> row >> col >> value;
    EXPECT_EQ(row, e.row + 1);
    EXPECT_EQ(col, e.col + 1);
    EXPECT_EQ(std::strtod(value.c_str(), nullptr), e.value);
  }
}

TEST(Matrices, FrequenciesAreThoseOfAChainOfTwo) {
  // Two unit masses and three springs k between walls: k and 3 k over m.
  const Matrix mass{2, 2, {{0, 0, 1}, {1, 1, 1}}};
  const Matrix stiffness{2, 2, {{0, 0, 8}, {1, 0, -4}, {0, 1, -4}, {1, 1, 8}}};
  const auto [least, largest] = frequencies_hz(mass, stiffness);
  EXPECT_NEAR(least, 2 / (2 * std::numbers::pi), 1e-14);
  EXPECT_NEAR(largest, std::sqrt(12) / (2 * std::numbers::pi), 1e-14);
  EXPECT_EQ(asymmetry(stiffness), 0);
  EXPECT_NEAR(spectrum(stiffness).condition, 3,
              1e-14);  // 12 times (8 + 4)/48
}

TEST(Matrices, AStrandThatIsNotThereIsRefused) {
  try {
    moment(strand_by("der"), 1, 0);
    FAIL() << "strand 2 of 1 was found";
  } catch (const InputError& refused) {
    EXPECT_NE(std::string(refused.what()).find("there is no strand 2"),
              std::string::npos);
  }
}

}  // namespace tress::test_matrices
