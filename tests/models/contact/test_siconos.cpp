// Contact problems against those of Siconos (INRIA; nonsmooth Gauss-Seidel).
#include <gtest/gtest.h>
#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/SolverOptions.h>

#include <cstdlib>
#include <memory>

#include "models/contact/cone.h"
#include "tests/models/contact/random_contacts.h"

namespace tress::test_siconos {

using namespace models;
using namespace test_contact;

Vec column(const RandomContacts& all, std::size_t row, std::size_t col, int k) {
  const auto &a = all.contacts[row], &b = all.contacts[col];
  const Vec unit{k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0};
  const Vec force = unit * b.axes;
  Vec u;
  for (const auto& on : a.ends) {
    for (const auto& of : b.ends) {
      if (on.body != of.body) continue;
      const auto& body = all.bodies[static_cast<std::size_t>(on.body)];
      u = u + (on.weight * of.weight) * (body.compliance[static_cast<std::size_t>(
                                             of.point * body.points + on.point)] *
                                         force);
    }
  }
  return a.axes * u;
}

/// Largest difference of velocities (those of forces may be many) from Siconos'; r are
/// its forces.
double difference(const RandomContacts& all, double mu, std::vector<double>& r) {
  const std::size_t count = all.contacts.size(), n = 3 * count;
  std::vector<double> q(n), u(n), friction(count, mu);
  // Siconos frees its matrix with its problem, and takes C's memory for it.
  auto* w = static_cast<double*>(std::malloc(n * n * sizeof(double)));
  for (std::size_t i = 0; i < count; ++i) {
    store3(all.contacts[i].free, &q[3 * i]);
    for (std::size_t j = 0; j < count; ++j) {
      for (int k = 0; k < 3; ++k) {
        store3(column(all, i, j, k),
               &w[n * (3 * j + static_cast<std::size_t>(k)) + 3 * i]);
      }
    }
  }
  NumericsMatrix* matrix =
      NM_create_from_data(NM_DENSE, static_cast<int>(n), static_cast<int>(n), w);
  FrictionContactProblem* problem = frictionContactProblem_new_with_data(
      3, static_cast<int>(count), matrix, q.data(), friction.data());
  SolverOptions* options = solver_options_create(SICONOS_FRICTION_3D_NSGS);
  options->dparam[SICONOS_DPARAM_TOL] = 1e-12;
  options->iparam[SICONOS_IPARAM_MAX_ITER] = 100000;
  r.assign(n, 0.0);
  const int failed = fc3d_driver(problem, r.data(), u.data(), options);
  solver_options_delete(options);
  std::free(options);
  problem->q = nullptr;
  problem->mu = nullptr;
  frictionContactProblem_free(problem);
  if (failed != 0) return -1;

  ContactProblem ours = all.problem(mu);
  EXPECT_LE(ours.solve(1e-2, 1e-11, 100000).violation, 1e-11);
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec change = ours.velocity(ours.contacts()[i]) - load3(&u[3 * i]);
    most = std::max(most, norm(change));
  }
  return most;
}

TEST(Siconos, FindsTheSameVelocities) {
  int compared = 0;
  for (unsigned seed = 0; seed < 36; ++seed) {
    std::vector<double> r;
    const double apart = difference(random_contacts(4, 4, 40, 6, seed), 0.3, r);
    if (apart < 0) continue;
    ++compared;
    // Errors of 1e-12 of the forces, of a size of 1, through W of a size of 1e2.
    EXPECT_LE(apart, 1e-8) << seed;
  }
  EXPECT_GE(compared, 30);
}

TEST(Siconos, IsSatisfiedByOurSolutionsOfMoreContactsThanUnknowns) {
  int compared = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const RandomContacts all = random_contacts(2, 5, 6, 12, seed);
    std::vector<double> r;
    if (difference(random_contacts(2, 5, 6, 5, seed), 0.3, r) >= 0) ++compared;
    ContactProblem ours = all.problem();
    EXPECT_LE(ours.solve(1e-2, 1e-7, 100000).violation, 1e-7) << seed;
  }
  EXPECT_GT(compared, 0);
}

}  // namespace tress::test_siconos
