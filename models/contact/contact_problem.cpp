#include "models/contact/contact_problem.h"

#include <algorithm>
#include <numeric>
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

// Parts are not worth a thread with fewer contacts; more parts have more between them.
constexpr std::size_t least_part = 500, most_parts = 4;

Pack packed(const Vec& x) { return {x.x, x.y, x.z, 0}; }
Vec first3(const Pack& x) { return {x[0], x[1], x[2]}; }

}  // namespace

void ContactProblem::clear() {
  bodies_.clear();
  contacts_.clear();
}

int ContactProblem::add_body(std::span<const Mat3> compliance, int points) {
  Body& body = bodies_.emplace_back();
  const auto count = static_cast<std::size_t>(points);
  body.compliance.resize(3 * count * count);
  for (std::size_t of = 0; of < count; ++of) {
    for (std::size_t on = 0; on < count; ++on) {
      const Mat3 columns = transposed(compliance[count * of + on]);
      Pack* const to = &body.compliance[3 * (count * of + on)];
      to[0] = packed(columns.r0);
      to[1] = packed(columns.r1);
      to[2] = packed(columns.r2);
    }
  }
  body.change.assign(count, Pack(0));
  body.forces.assign(count, Vec());
  return static_cast<int>(bodies_.size()) - 1;
}

Vec ContactProblem::change(std::size_t body, std::size_t point) const {
  return first3(bodies_[body].change[point]);
}

Vec ContactProblem::velocity(const Contact& contact) const {
  Pack change(0);
  for (const End& end : contact.ends) {
    const Body& body = bodies_[static_cast<std::size_t>(end.body)];
    change += Pack(end.weight) * body.change[static_cast<std::size_t>(end.point)];
  }
  return contact.free + contact.axes * first3(change);
}

void ContactProblem::push(const Contact& contact, const Vec& force) {
  const Vec world = force * contact.axes;
  for (const End& end : contact.ends) {
    if (end.weight == 0) continue;
    Body& body = bodies_[static_cast<std::size_t>(end.body)];
    const std::size_t points = body.change.size();
    const Pack* column =
        body.compliance.data() + 3 * points * static_cast<std::size_t>(end.point);
    const Pack x(end.weight * world.x), y(end.weight * world.y), z(end.weight * world.z);
    for (Pack& change : body.change) {
      change += column[0] * x + column[1] * y + column[2] * z;
      column += 3;
    }
  }
}

/// Parts of neighbours: bodies in the order in which contacts lead from one to the next,
/// as many for each part as have an equal share of the contacts.
void ContactProblem::divide() {
  const std::size_t count =
      std::clamp<std::size_t>(contacts_.size() / least_part, 1, most_parts);
  parts_.resize(count + 1);
  for (Part& part : parts_) part.contacts.clear();
  const auto bodies_of = [](const Contact& contact) {
    return std::pair(static_cast<std::size_t>(contact.ends[0].body),
                     static_cast<std::size_t>(contact.ends[2].body));
  };
  std::vector<std::size_t> part_of(bodies_.size(), 0);
  if (count > 1) {
    // Neighbours of body b: neighbours[start[b] ... start[b + 1]).
    std::vector<std::size_t> start(bodies_.size() + 2, 0);
    for (const Contact& contact : contacts_) {
      const auto [a, b] = bodies_of(contact);
      ++start[a + 2];
      ++start[b + 2];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::size_t> neighbours(start.back());
    for (const Contact& contact : contacts_) {
      const auto [a, b] = bodies_of(contact);
      neighbours[start[a + 1]++] = b;
      neighbours[start[b + 1]++] = a;
    }
    std::vector<std::size_t> order;
    std::vector<char> met(bodies_.size(), 0);
    std::size_t ends = 0;
    for (std::size_t root = 0; root < bodies_.size(); ++root) {
      if (met[root] != 0) continue;
      met[root] = 1;
      order.push_back(root);
      for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
        const std::size_t body = order[next];
        part_of[body] = std::min(count - 1, ends * count / neighbours.size());
        ends += start[body + 1] - start[body];
        for (std::size_t i = start[body]; i < start[body + 1]; ++i) {
          if (std::exchange(met[neighbours[i]], 1) == 0) order.push_back(neighbours[i]);
        }
      }
    }
  }
  for (Contact& contact : contacts_) {
    const auto [a, b] = bodies_of(contact);
    const std::size_t part = part_of[a] == part_of[b] ? part_of[a] : count;
    parts_[part].contacts.push_back(&contact);
  }
}

/// The last part comes after the others.
void ContactProblem::each_part(const Loop& loop, const std::function<void(Part&)>& act) {
  loop(parts_.size() - 1, [&](std::size_t i) { act(parts_[i]); });
  act(parts_.back());
}

/// Its own compliance, and what its guess does.
void ContactProblem::begin(Contact& contact) {
  Mat3 world{};
  for (const End& a : contact.ends) {
    for (const End& b : contact.ends) {
      if (a.body != b.body || a.weight * b.weight == 0) continue;
      const Body& body = bodies_[static_cast<std::size_t>(a.body)];
      const Pack* const block =
          &body.compliance[3 * (body.change.size() * static_cast<std::size_t>(b.point) +
                                static_cast<std::size_t>(a.point))];
      const Mat3 columns{first3(block[0]), first3(block[1]), first3(block[2])};
      world = world + (a.weight * b.weight) * transposed(columns);
    }
  }
  contact.local = contact.axes * world * transposed(contact.axes);
  if (trace(contact.local) == 0) contact.force = {};
  if (dot(contact.force, contact.force) > 0) push(contact, contact.force);
}

double ContactProblem::violation(const Contact& contact) const {
  return contact_violation(contact.local, velocity(contact), contact.force,
                           contact.friction);
}

/// How much it violated the laws before.
double ContactProblem::visit(Contact& contact, const Limits& limits) {
  if (trace(contact.local) == 0) return 0;
  const Vec u = velocity(contact);
  const double violation =
      contact_violation(contact.local, u, contact.force, contact.friction);
  if (violation <= limits.quiet) return violation;
  const double near = limits.proximal * trace(contact.local) / 3;
  const Mat3 local = contact.local + diagonal({near, near, near});
  const Vec force =
      contact_force(local, u - local * contact.force, contact.friction, contact.force);
  const Vec change = force - contact.force;
  contact.force = force;
  if (dot(change, change) > 0) push(contact, change);
  return violation;
}

void ContactProblem::sweep(Part& part, const Limits& limits) {
  part.busy.clear();
  part.violation = 0;
  for (Contact* const contact : part.contacts) {
    const double seen = visit(*contact, limits);
    part.violation = std::max(part.violation, seen);
    if (seen > limits.quiet) part.busy.push_back(contact);
  }
  for (int i = 0; i < busy_sweeps && part.busy.size() < part.contacts.size() / 2; ++i) {
    double seen = 0;
    for (Contact* const contact : part.busy) {
      seen = std::max(seen, visit(*contact, limits));
    }
    if (seen <= limits.quiet) break;
  }
}

double ContactProblem::worst(const Loop& loop) {
  each_part(loop, [this](Part& part) {
    part.violation = 0;
    for (const Contact* const contact : part.contacts) {
      if (trace(contact->local) == 0) continue;
      part.violation = std::max(part.violation, violation(*contact));
    }
  });
  return std::ranges::max(parts_, {}, &Part::violation).violation;
}

ContactProblem::Outcome ContactProblem::solve(double proximal, double tolerance,
                                              int most_sweeps, const Loop& loop) {
  divide();
  for (Body& body : bodies_) std::ranges::fill(body.change, Pack(0));
  each_part(loop, [this](Part& part) {
    for (Contact* const contact : part.contacts) begin(*contact);
  });
  const Limits limits{proximal, quiet * tolerance};
  Outcome outcome;
  outcome.violation = worst(loop);
  while (outcome.violation > tolerance && outcome.sweeps < most_sweeps) {
    each_part(loop, [&](Part& part) { sweep(part, limits); });
    outcome.violation = std::ranges::max(parts_, {}, &Part::violation).violation;
    ++outcome.sweeps;
    // What each saw at its visit is an estimate; at the end it is what is left.
    if (outcome.violation <= tolerance || outcome.sweeps == most_sweeps) {
      outcome.violation = worst(loop);
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
