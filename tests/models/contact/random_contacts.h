#pragma once

#include <random>
#include <span>
#include <vector>

#include "models/contact/contact_problem.h"

namespace tress::test_contact {

using namespace models;

inline Vec random_vec(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

/// a^T a of a random a, made less singular by a part of the identity.
inline Mat3 random_compliance(std::mt19937& random) {
  const Vec a = random_vec(random), b = random_vec(random), c = random_vec(random);
  return outer(a, a) + outer(b, b) + outer(c, c) + diagonal({0.1, 0.1, 0.1});
}

inline Mat3 random_axes(std::mt19937& random) {
  const Vec a = random_vec(random), b = random_vec(random);
  const Vec n = (1 / norm(a)) * a;
  const Vec across = cross(n, b);
  const Vec t = (1 / norm(across)) * across;
  return {n, t, cross(n, t)};
}

inline ContactProblem::Compliance compliance_of(std::span<const Mat3> blocks) {
  std::vector<double> rows(9 * blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    store3(blocks[i].r0, &rows[9 * i]);
    store3(blocks[i].r1, &rows[9 * i + 3]);
    store3(blocks[i].r2, &rows[9 * i + 6]);
  }
  return ContactProblem::Compliance(rows);
}

/// Bodies of points that respond as one to each other (rank `rank` of 3 points), and
/// contacts between random points of two of them.
struct RandomContacts {
  struct Body {
    int points;
    std::vector<Mat3> compliance;
    ContactProblem::Compliance response = compliance_of(compliance);
  };
  std::vector<Body> bodies;
  std::vector<ContactProblem::Contact> contacts;

  /// Valid while this lives.
  ContactProblem problem(double friction = 0.3) const {
    ContactProblem all;
    for (const Body& body : bodies) all.add_body(body.response);
    for (auto contact : contacts) {
      contact.friction = friction;
      all.add(contact);
    }
    return all;
  }
};

inline RandomContacts random_contacts(int bodies, int points, int rank, int contacts,
                                      unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  RandomContacts all;
  for (int k = 0; k < bodies; ++k) {
    // W = sum over `rank` random modes of (u u^T), u a vector per point.
    std::vector<Mat3> compliance(static_cast<std::size_t>(points * points));
    for (int mode = 0; mode < rank; ++mode) {
      std::vector<Vec> u(static_cast<std::size_t>(points));
      for (Vec& of_point : u) of_point = random_vec(random);
      for (int of = 0; of < points; ++of) {
        for (int on = 0; on < points; ++on) {
          Mat3& block = compliance[static_cast<std::size_t>(of * points + on)];
          block = block +
                  outer(u[static_cast<std::size_t>(on)], u[static_cast<std::size_t>(of)]);
        }
      }
    }
    all.bodies.push_back({points, compliance});
  }
  std::uniform_int_distribution<int> any_body(0, bodies - 1), any_point(0, points - 2);
  std::uniform_real_distribution<double> part(0, 1);
  for (int c = 0; c < contacts; ++c) {
    const int a = any_body(random);
    const int b = bodies == 1 ? a : (a + 1 + any_body(random) % (bodies - 1)) % bodies;
    const double s = part(random), t = part(random);
    const int i = any_point(random), j = any_point(random);
    all.contacts.push_back(
        {.ends = {{{a, i, 1 - s}, {a, i + 1, s}, {b, j, t - 1}, {b, j + 1, -t}}},
         .friction = 0,
         .axes = random_axes(random),
         .free = random_vec(random),
         .force = {},
         .local = {}});
  }
  return all;
}

}  // namespace tress::test_contact
