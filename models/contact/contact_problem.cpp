#include "models/contact/contact_problem.h"

#include <algorithm>
#include <utility>

#include "models/contact/cone.h"

namespace tress::models {
namespace {

Mat3 transposed(const Mat3& a) {
  return {{a.r0.x, a.r1.x, a.r2.x}, {a.r0.y, a.r1.y, a.r2.y}, {a.r0.z, a.r1.z, a.r2.z}};
}

// Contacts that violate the laws by less than this part of the tolerance are left alone
// for so many sweeps over the others: most settle at once, and a few take long.
constexpr double quiet = 0.1;
constexpr int busy_sweeps = 10;

}  // namespace

void ContactProblem::clear() {
  bodies_.clear();
  contacts_.clear();
}

int ContactProblem::add_body(std::vector<Mat3> compliance, int points) {
  const std::vector<Vec> none(static_cast<std::size_t>(points));
  bodies_.push_back({std::move(compliance), none, none});
  return static_cast<int>(bodies_.size()) - 1;
}

Vec ContactProblem::velocity(const Contact& contact) const {
  Vec change;
  for (const End& end : contact.ends) {
    const Body& body = bodies_[static_cast<std::size_t>(end.body)];
    change = change + end.weight * body.change[static_cast<std::size_t>(end.point)];
  }
  return contact.free + contact.axes * change;
}

void ContactProblem::push(const Contact& contact, const Vec& force) {
  const Vec world = force * contact.axes;
  for (const End& end : contact.ends) {
    if (end.weight == 0) continue;
    Body& body = bodies_[static_cast<std::size_t>(end.body)];
    const std::size_t points = body.change.size();
    const Mat3* column =
        body.compliance.data() + points * static_cast<std::size_t>(end.point);
    const Vec on_point = end.weight * world;
    for (std::size_t p = 0; p < points; ++p) {
      body.change[p] = body.change[p] + column[p] * on_point;
    }
  }
}

double ContactProblem::worst() const {
  double most = 0;
  for (const Contact& contact : contacts_) {
    if (trace(contact.local) == 0) continue;
    most = std::max(most, contact_violation(contact.local, velocity(contact),
                                            contact.force, contact.friction));
  }
  return most;
}

ContactProblem::Outcome ContactProblem::solve(double proximal, double tolerance,
                                              int most_sweeps) {
  for (Body& body : bodies_) std::ranges::fill(body.change, Vec());
  for (Contact& contact : contacts_) {
    Mat3 world{};
    for (const End& a : contact.ends) {
      for (const End& b : contact.ends) {
        if (a.body != b.body) continue;
        const Body& body = bodies_[static_cast<std::size_t>(a.body)];
        const Mat3& block =
            body.compliance[body.change.size() * static_cast<std::size_t>(b.point) +
                            static_cast<std::size_t>(a.point)];
        world = world + (a.weight * b.weight) * block;
      }
    }
    contact.local = contact.axes * world * transposed(contact.axes);
    if (trace(contact.local) == 0) contact.force = {};
    push(contact, contact.force);
  }
  const auto visit = [&](Contact& contact) {
    if (trace(contact.local) == 0) return 0.0;
    const Vec u = velocity(contact);
    const double violation =
        contact_violation(contact.local, u, contact.force, contact.friction);
    if (violation <= quiet * tolerance) return violation;
    const double near = proximal * trace(contact.local) / 3;
    const Mat3 local = contact.local + diagonal({near, near, near});
    const Vec force =
        contact_force(local, u - local * contact.force, contact.friction, contact.force);
    const Vec change = force - contact.force;
    contact.force = force;
    if (dot(change, change) > 0) push(contact, change);
    return violation;
  };
  Outcome outcome;
  outcome.violation = worst();
  std::vector<Contact*> busy;
  while (outcome.violation > tolerance && outcome.sweeps < most_sweeps) {
    busy.clear();
    outcome.violation = 0;
    for (Contact& contact : contacts_) {
      const double seen = visit(contact);
      outcome.violation = std::max(outcome.violation, seen);
      if (seen > quiet * tolerance) busy.push_back(&contact);
    }
    ++outcome.sweeps;
    for (int i = 0; i < busy_sweeps && busy.size() < contacts_.size() / 2; ++i) {
      double seen = 0;
      for (Contact* const contact : busy) seen = std::max(seen, visit(*contact));
      if (seen <= quiet * tolerance) break;
    }
    // What each saw at its visit is an estimate; at the end it is what is left.
    if (outcome.violation <= tolerance || outcome.sweeps == most_sweeps) {
      outcome.violation = worst();
    }
  }
  for (Body& body : bodies_) std::ranges::fill(body.forces, Vec());
  for (const Contact& contact : contacts_) {
    const Vec world = contact.force * contact.axes;
    for (const End& end : contact.ends) {
      Vec& to = bodies_[static_cast<std::size_t>(end.body)]
                    .forces[static_cast<std::size_t>(end.point)];
      to = to + end.weight * world;
    }
  }
  return outcome;
}

}  // namespace tress::models
