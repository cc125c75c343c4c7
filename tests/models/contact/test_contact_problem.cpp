// The laws of Signorini and Coulomb, at one contact and at many.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "models/contact/cone.h"
#include "models/contact/joint_contacts.h"
#include "tests/models/contact/random_contacts.h"

namespace tress::test_contact_problem {

using namespace models;
using namespace test_contact;

double tangential(const Vec& a) { return std::hypot(a.y, a.z); }

TEST(ContactForce, ObeysTheLawsOfARandomContact) {
  std::mt19937 random(1);
  int open = 0, sticking = 0, sliding = 0;
  for (int i = 0; i < 20000; ++i) {
    const Mat3 w = random_compliance(random);
    const Vec b = random_vec(random);
    const double mu = std::uniform_real_distribution<double>(0, 0.5)(random);
    const Vec r = contact_force(w, b, mu), u = w * r + b;
    // Rounding of w r, whose terms cancel against b.
    const double rounding = 1e-11 * (norm(b) + trace(w) * norm(r));
    if (norm(r) == 0) {
      ++open;
      EXPECT_GE(u.x, 0);
      continue;
    }
    EXPECT_GT(r.x, 0);
    EXPECT_NEAR(u.x, 0, rounding);
    if (tangential(r) < (1 - 1e-9) * mu * r.x) {
      ++sticking;
      EXPECT_LE(tangential(u), rounding);
    } else {
      // Where W couples strongly there may be no slide: the measure tells.
      if (contact_violation(w, u, r, mu) > 1e-6 * (1 + norm(b))) continue;
      ++sliding;
      EXPECT_NEAR(tangential(r), mu * r.x, 1e-11 * r.x);
      // u_t = -s r_t with s >= 0.
      EXPECT_NEAR(u.y * r.y + u.z * r.z, -tangential(u) * tangential(r),
                  1e-7 * norm(r) * (norm(b) + rounding));
    }
  }
  EXPECT_GT(open, 5000);
  EXPECT_GT(sticking, 200);
  EXPECT_GT(sliding, 5000);
  // What is left has no solution or none was found.
  EXPECT_GE(open + sticking + sliding, 19990);
}

TEST(ContactForce, DoesNotDependOnTheGuess) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const Mat3 w = random_compliance(random);
    const Vec b = random_vec(random), guess = random_vec(random);
    const Vec r = contact_force(w, b, 0.3), again = contact_force(w, b, 0.3, guess);
    EXPECT_LE(norm(r - again), 1e-7 * (1 + norm(r))) << i;
  }
}

TEST(ContactViolation, IsZeroWhereTheLawsHoldAndASpeedWhereNot) {
  const Mat3 w = diagonal({2, 2, 2});
  const double mu = 0.5;
  EXPECT_NEAR(contact_violation(w, {1, 0.3, 0}, {}, mu), 0, 1e-15);          // open
  EXPECT_NEAR(contact_violation(w, {}, {1, 0.2, 0.1}, mu), 0, 1e-15);        // sticks
  EXPECT_NEAR(contact_violation(w, {0, 3, 0}, {1, -0.5, 0}, mu), 0, 1e-14);  // slides
  // One speed too much, in proportion.
  for (const double speed : {1e-8, 1e-3}) {
    const double creeps = contact_violation(w, {0, speed, 0}, {1, 0.2, 0}, mu);
    EXPECT_GT(creeps, 0.1 * speed);
    EXPECT_LT(creeps, 10 * speed);
    const double sinks = contact_violation(w, {-speed, 0, 0}, {}, mu);
    EXPECT_GT(sinks, speed);
    EXPECT_LT(sinks, 10 * speed);
  }
  EXPECT_GT(contact_violation(w, {}, {1, 0.6, 0}, mu), 0.01);        // beyond the cone
  EXPECT_GT(contact_violation(w, {0, 3, 0}, {1, 0.5, 0}, mu), 0.1);  // pushes along
  EXPECT_GT(contact_violation(w, {1, 0, 0}, {1, 0, 0}, mu), 0.1);    // pulls away
}

TEST(ContactProblem, SolvesContactsOfRegularCompliance) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const RandomContacts all = random_contacts(4, 4, 40, 6, seed);
    ContactProblem problem = all.problem();
    const auto outcome = problem.solve(1e-2, 1e-10, 2000);
    EXPECT_LE(outcome.violation, 1e-10) << seed;
    for (const auto& contact : problem.contacts()) {
      EXPECT_LE(
          contact_violation(contact.local, problem.velocity(contact), contact.force, 0.3),
          1e-10);
    }
  }
}

/// A solution that was cut short.
TEST(ContactProblem, EndsWithoutFrictionThatDrivesASlide) {
  constexpr double tolerance = 1e-8;
  double drove = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RandomContacts all = random_contacts(2, 5, 6, 12, seed);
    ContactProblem problem = all.problem();
    if (problem.solve(1e-2, tolerance, 1).violation <= tolerance) continue;
    const auto drive = [&](const ContactProblem::Contact& contact) {
      const Vec u = problem.velocity(contact), &f = contact.force;
      return f.y * u.y + f.z * u.z - tolerance * contact.friction * f.x;
    };
    for (const auto& contact : problem.contacts()) {
      drove = std::max(drove, drive(contact));
    }
    problem.stop_driving(tolerance);
    for (const auto& contact : problem.contacts()) {
      EXPECT_LE(drive(contact), 0) << seed;
      EXPECT_LE(std::hypot(contact.force.y, contact.force.z),
                contact.friction * contact.force.x * (1 + 1e-12));
    }
    for (std::size_t k = 0; k < problem.bodies(); ++k) {
      for (std::size_t p = 0; p < problem.forces(k).size(); ++p) {
        Vec expected;
        for (std::size_t of = 0; of < problem.forces(k).size(); ++of) {
          expected =
              expected + all.bodies[k].compliance[5 * of + p] * problem.forces(k)[of];
        }
        EXPECT_LE(norm(problem.change(k, p) - expected), 1e-11 * (1 + norm(expected)));
      }
    }
  }
  EXPECT_GT(drove, 0);
}

TEST(ContactProblem, SolvesMoreContactsThanUnknowns) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    // Two bodies of 6 unknowns each, 36 components of contacts.
    const RandomContacts all = random_contacts(2, 5, 6, 12, seed);
    ContactProblem problem = all.problem();
    const auto outcome = problem.solve(1e-2, 1e-6, 20000);
    EXPECT_LE(outcome.violation, 1e-6) << seed;
  }
}

/// Two contacts at points that move as one but for 1 - `together`: each sweep leaves
/// together^2 of the error, so that sweeps alone need hundreds to gain a digit.
void add_stiff_pair(ContactProblem& problem, const ContactProblem::Compliance& response) {
  const int body = problem.add_body(response);
  for (int i = 0; i < 2; ++i) {
    problem.add({.ends = {{{body, i, 1}, {body, i, 0}, {body, 0, 0}, {body, 0, 0}}},
                 .friction = 0.3,
                 .axes = identity(),
                 .free = {-1, 0.05, 0.1 * i},
                 .force = {},
                 .local = {}});
  }
}

TEST(ContactProblem, SolvesContactsThatBearEachOtherAtOnce) {
  constexpr double together = 0.999;
  const Mat3 one = identity(), both = together * one;
  const auto pair = compliance_of(std::vector<Mat3>{one, both, both, one});
  ContactProblem alone;
  add_stiff_pair(alone, pair);
  const auto outcome = alone.solve(1e-2, 1e-10, 100);
  EXPECT_LE(outcome.violation, 1e-10);
  // Among others, of which it is the worst when they have settled.
  const RandomContacts all = random_contacts(40, 4, 40, 60, 5);
  ContactProblem many = all.problem();
  add_stiff_pair(many, pair);
  const auto among = many.solve(1e-2, 1e-8, 100);
  EXPECT_LE(among.violation, 1e-8);
}

// What it says of its forces is so, and never worse than the guess.
TEST(JointContacts, FindsForcesThatObeyTheLaws) {
  std::mt19937 random(3);
  int found = 0;
  constexpr std::size_t count = 6;
  constexpr int problems = 50;
  for (int k = 0; k < problems; ++k) {
    // W = J J^T of rank 12, of 18: singular.
    std::array<std::array<Vec, 12>, count> j;
    for (auto& row : j) {
      for (Vec& mode : row) mode = random_vec(random);
    }
    JointContacts joint;
    joint.resize(count);
    double guess = 0;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        Mat3 block{};
        for (std::size_t m = 0; m < 12; ++m) block = block + outer(j[a][m], j[b][m]);
        joint.block(a, b) = block;
      }
      const Vec free = random_vec(random);
      joint.contacts()[a] = {0.3, free, {}};
      guess = std::max(guess, contact_violation(joint.block(a, a), free, {}, 0.3));
    }
    const double said = joint.solve(1e-9, 20);
    double is = 0, size = 1;
    for (std::size_t a = 0; a < count; ++a) {
      const JointContacts::Contact& contact = joint.contacts()[a];
      Vec u = contact.free;
      for (std::size_t b = 0; b < count; ++b) {
        u = u + joint.block(a, b) * joint.contacts()[b].force;
      }
      is = std::max(is, contact_violation(joint.block(a, a), u, contact.force, 0.3));
      size = std::max(size, trace(joint.block(a, a)) * norm(contact.force));
    }
    EXPECT_NEAR(said, is, 1e-14 * size);  // rounding of W r, some 20 terms
    EXPECT_LE(said, guess);
    if (said <= 1e-9) ++found;
  }
  // Newton's method from no forces at all, without any sweeps.
  EXPECT_GT(found, problems / 2);
}

TEST(ContactProblem, ForcesOfItsContactsChangeTheVelocities) {
  const RandomContacts all = random_contacts(3, 4, 30, 5, 7);
  ContactProblem problem = all.problem(0.4);
  problem.solve(1e-2, 1e-10, 2000);
  Vec sum;
  double size = 0;
  for (std::size_t body = 0; body < 3; ++body) {
    const auto forces = problem.forces(body);
    for (std::size_t p = 0; p < 4; ++p) {
      sum = sum + forces[p];
      size += norm(forces[p]);
      Vec expected;
      for (std::size_t of = 0; of < 4; ++of) {
        expected = expected + all.bodies[body].compliance[4 * of + p] * forces[of];
      }
      EXPECT_LE(norm(problem.change(body, p) - expected), 1e-11 * (1 + norm(expected)));
    }
  }
  EXPECT_GT(size, 0.01);
  EXPECT_LE(norm(sum), 1e-14 * size);  // action is reaction
}

TEST(ContactProblem, GoesOnFromForcesThatAreRight) {
  const RandomContacts all = random_contacts(4, 4, 40, 8, 3);
  ContactProblem problem = all.problem();
  problem.solve(1e-2, 1e-10, 2000);
  ContactProblem again;
  for (const auto& body : all.bodies) again.add_body(body.response);
  for (const auto& contact : problem.contacts()) again.add(contact);
  EXPECT_EQ(again.solve(1e-2, 1e-9, 2000).sweeps, 0);
}

/// Contacts that are added to a solved problem, some of them at points that their bodies
/// did not have: the forces are those of all at once, which are unique here, and what
/// they do to velocities is theirs alone.
TEST(ContactProblem, GoesOnWithMoreContactsAtMorePoints) {
  constexpr int points = 5, known = 3, contacts = 8;
  double renewed_forces = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomContacts all = random_contacts(4, points, 40, contacts, seed);
    // The first half touches the first points of bodies 0 to 2; the rest anything.
    for (int c = 0; c < contacts / 2; ++c) {
      for (int end = 0; end < 4; ++end) {
        auto& at =
            all.contacts[static_cast<std::size_t>(c)].ends[static_cast<std::size_t>(end)];
        at.body = (c + end / 2) % 3;
        at.point %= known;
      }
    }
    ContactProblem at_once = all.problem();
    ASSERT_LE(at_once.solve(1e-2, 1e-12, 5000).violation, 1e-12);

    std::vector<ContactProblem::Compliance> responses;
    responses.reserve(4);
    ContactProblem problem;
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<Mat3> first;
      for (std::size_t of = 0; of < known; ++of) {
        for (std::size_t on = 0; on < known; ++on) {
          first.push_back(all.bodies[k].compliance[points * of + on]);
        }
      }
      // Body 2 is touched at all points from the start.
      responses.push_back(k == 2 ? all.bodies[k].response : compliance_of(first));
      problem.add_body(responses.back());
    }
    const auto given = [&](int c) {
      auto contact = all.contacts[static_cast<std::size_t>(c)];
      contact.friction = 0.3;
      return contact;
    };
    for (int c = 0; c < contacts / 2; ++c) problem.add(given(c));
    ASSERT_LE(problem.solve(1e-2, 1e-12, 5000).violation, 1e-12);
    for (std::size_t k = 0; k < 2; ++k) {
      responses[k] = all.bodies[k].response;
      problem.renew_body(static_cast<int>(k));
      for (const Vec& force : problem.forces(k)) renewed_forces += norm(force);
    }
    responses.push_back(all.bodies[3].response);
    problem.add_body(responses[3]);
    for (int c = 0; c < contacts / 2; ++c) {
      problem.set(static_cast<std::size_t>(c), given(c));  // all are on renewed bodies
    }
    for (int c = contacts / 2; c < contacts; ++c) problem.add(given(c));
    EXPECT_LE(problem.solve(1e-2, 1e-12, 5000).violation, 1e-12) << seed;
    for (std::size_t c = 0; c < contacts; ++c) {
      const auto& contact = problem.contacts()[c];
      EXPECT_LE(
          contact_violation(contact.local, problem.velocity(contact), contact.force, 0.3),
          1e-12);
      EXPECT_LE(norm(contact.force - at_once.contacts()[c].force), 1e-9) << seed;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t p = 0; p < points; ++p) {
        Vec expected;
        for (std::size_t of = 0; of < points; ++of) {
          expected = expected +
                     all.bodies[k].compliance[points * of + p] * problem.forces(k)[of];
        }
        EXPECT_LE(norm(problem.change(k, p) - expected), 1e-11 * (1 + norm(expected)));
      }
    }
  }
  EXPECT_EQ(renewed_forces, 0) << "they hold none until the next solution";
}

TEST(ContactProblem, OfManyContactsDoesNotDependOnWhoVisitsItsParts) {
  constexpr int bodies = 500, contacts = 2500;  // enough for several parts
  RandomContacts all = random_contacts(bodies, 4, 12, contacts, 5);
  for (int c = 0; c < contacts; ++c) {
    auto& ends = all.contacts[static_cast<std::size_t>(c)].ends;
    ends[0].body = ends[1].body = c % bodies;
    ends[2].body = ends[3].body = (c + 1 + c % 7) % bodies;
  }
  const auto solved = [&](const Loop& loop) {
    ContactProblem problem = all.problem();
    const auto outcome = problem.solve(1e-2, 1e-8, 5000, loop);
    EXPECT_LE(outcome.violation, 1e-8);
    return problem;
  };
  std::size_t parts = 0;
  const ContactProblem forward = solved([&](std::size_t count, const auto& work) {
    parts = std::max(parts, count);
    for (std::size_t i = 0; i < count; ++i) work(i);
  });
  EXPECT_GT(parts, 1u);
  const ContactProblem backward = solved([](std::size_t count, const auto& work) {
    for (std::size_t i = count; i-- > 0;) work(i);
  });
  const ContactProblem at_once = solved([](std::size_t count, const auto& work) {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&, i] { work(i); });
  });
  for (std::size_t c = 0; c < contacts; ++c) {
    const auto& contact = forward.contacts()[c];
    EXPECT_LE(
        contact_violation(contact.local, forward.velocity(contact), contact.force, 0.3),
        1e-8);
    for (const ContactProblem* other : {&backward, &at_once}) {
      EXPECT_EQ(norm(contact.force - other->contacts()[c].force), 0);
    }
  }
}

}  // namespace tress::test_contact_problem
