#include "models/contact/contact_problem.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "models/contact/cone.h"

namespace tress::models {
namespace {

Mat3 transposed(const Mat3& a) {
  return {{a.r0.x, a.r1.x, a.r2.x}, {a.r0.y, a.r1.y, a.r2.y}, {a.r0.z, a.r1.z, a.r2.z}};
}

// Contacts whose force would change their velocities by less than this part of the
// tolerance are left alone, for so many sweeps over the others: most settle at once, and
// a few take long.
constexpr double quiet_part = 0.25;
constexpr int busy_sweeps = 10;
// Where all are quiet and one violates the laws nevertheless, less is quiet.
constexpr double quieter = 0.1;

// Parts are not worth a thread with fewer contacts; more parts have more between them.
constexpr std::size_t least_part = 500, most_parts = 4;
// Pairs of parts, so that two that follow each other share none.
constexpr std::pair<std::size_t, std::size_t> pairs_of_parts[] = {{0, 1}, {2, 3}, {0, 2},
                                                                  {1, 3}, {0, 3}, {1, 2}};

// The contacts about the worst one, unless they are more than these, are solved at once
// after so many sweeps; then after so many more where that solved them, else after twice
// as many as before.
constexpr int first_joint = 2, next_joint = 10, joint_steps = 6;
constexpr std::size_t most_joint = 32;

Pack packed(const Vec& x) { return {x.x, x.y, x.z, 0}; }
Vec first3(const Pack& x) { return {x[0], x[1], x[2]}; }

bool is_zero(const Vec& a) { return a.x == 0 && a.y == 0 && a.z == 0; }

}  // namespace

void ContactProblem::Compliance::set(std::span<const Mat3> blocks) {
  points_ = static_cast<std::size_t>(std::lround(std::sqrt(blocks.size())));
  columns_.resize(3 * blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Mat3 columns = transposed(blocks[i]);
    columns_[3 * i] = packed(columns.r0);
    columns_[3 * i + 1] = packed(columns.r1);
    columns_[3 * i + 2] = packed(columns.r2);
  }
}

void ContactProblem::clear() {
  bodies_.clear();
  contacts_.clear();
}

int ContactProblem::add_body(const Compliance& compliance) {
  bodies_.push_back({&compliance, std::vector<Pack>(compliance.points_, Pack(0)),
                     std::vector<Vec>(compliance.points_)});
  return static_cast<int>(bodies_.size()) - 1;
}

Vec ContactProblem::change(std::size_t body, std::size_t point) const {
  return first3(bodies_[body].change[point]);
}

/// Of its velocity by all forces, in the world's axes.
Vec ContactProblem::change(const Contact& contact) const {
  Pack change(0);
  for (const End& end : contact.ends) {
    const Body& body = bodies_[static_cast<std::size_t>(end.body)];
    change += Pack(end.weight) * body.change[static_cast<std::size_t>(end.point)];
  }
  return first3(change);
}

Vec ContactProblem::velocity(const Contact& contact) const {
  return contact.free + contact.axes * change(contact);
}

void ContactProblem::push(const Solved& solved, const Vec& force) {
  const Pack normal(force.x), first(force.y), second(force.z);
  for (const Solved::Pushed& on : solved.bodies) {
    if (on.body == nullptr) break;
    ++on.body->pushes;
    const Pack* column = on.columns;
    for (Pack& change : on.body->change) {
      change += column[0] * normal + column[1] * first + column[2] * second;
      column += 3;
    }
  }
}

/// Parts of neighbours: bodies in the order in which contacts lead from one to the next,
/// as many for each part as have an equal share of the contacts.
void ContactProblem::divide() {
  const std::size_t count =
      std::clamp<std::size_t>(contacts_.size() / least_part, 1, most_parts);
  rounds_ = {count};
  if (count == most_parts) rounds_.insert(rounds_.end(), {2, 2, 2});
  if (count < most_parts) rounds_.resize(1 + count * (count - 1) / 2, 1);
  parts_.resize(std::accumulate(rounds_.begin(), rounds_.end(), std::size_t{0}));
  for (Part& part : parts_) part.contacts.clear();
  std::size_t part_between[most_parts][most_parts] = {};
  std::size_t between = count;
  for (const auto& [a, b] : pairs_of_parts) {
    if (b < count) part_between[a][b] = part_between[b][a] = between++;
  }
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
    const std::size_t first = part_of[a], second = part_of[b];
    Solved& solved = parts_[first == second ? first : part_between[first][second]]
                         .contacts.emplace_back();
    solved.contact = &contact;
    solved.bodies[0].body = &bodies_[a];
    solved.bodies[1].body = a == b ? nullptr : &bodies_[b];
  }
}

void ContactProblem::each_part(const Loop& loop, const std::function<void(Part&)>& act) {
  std::size_t first = 0;
  for (const std::size_t count : rounds_) {
    loop(count, [&](std::size_t i) { act(parts_[first + i]); });
    first += count;
  }
}

/// How bodies of contacts, and the contacts themselves, respond to forces along their
/// axes.
void ContactProblem::combine(Part& part, double proximal) {
  std::size_t count = 0;
  for (const Solved& solved : part.contacts) {
    for (const Solved::Pushed& on : solved.bodies) {
      if (on.body != nullptr) count += 3 * on.body->change.size();
    }
  }
  part.columns.resize(count);
  Pack* to = part.columns.data();
  for (Solved& solved : part.contacts) {
    Contact& contact = *solved.contact;
    const Mat3& axes = contact.axes;
    Mat3 world{};  // by axes of the force, rows
    for (Solved::Pushed& on : solved.bodies) {
      if (on.body == nullptr) break;
      on.columns = to;
      const std::size_t points = on.body->change.size();
      std::fill_n(to, 3 * points, Pack(0));
      for (const End& end : contact.ends) {
        if (&bodies_[static_cast<std::size_t>(end.body)] != on.body || end.weight == 0) {
          continue;
        }
        const Pack* from = on.body->compliance->columns_.data() +
                           3 * points * static_cast<std::size_t>(end.point);
        const Mat3 weighted = end.weight * axes;
        for (std::size_t k = 0; k < points; ++k, from += 3) {
          Pack* const sum = to + 3 * k;
          sum[0] += from[0] * Pack(weighted.r0.x) + from[1] * Pack(weighted.r0.y) +
                    from[2] * Pack(weighted.r0.z);
          sum[1] += from[0] * Pack(weighted.r1.x) + from[1] * Pack(weighted.r1.y) +
                    from[2] * Pack(weighted.r1.z);
          sum[2] += from[0] * Pack(weighted.r2.x) + from[1] * Pack(weighted.r2.y) +
                    from[2] * Pack(weighted.r2.z);
        }
      }
      for (const End& end : contact.ends) {
        if (&bodies_[static_cast<std::size_t>(end.body)] != on.body) continue;
        const Pack* const at = to + 3 * static_cast<std::size_t>(end.point);
        world = world + end.weight * Mat3{first3(at[0]), first3(at[1]), first3(at[2])};
      }
      to += 3 * points;
    }
    contact.local = axes * transposed(world);
    const double size = trace(contact.local);
    if (size == 0) contact.force = {};
    const double near = proximal * size / 3;
    solved.near = contact.local + diagonal({near, near, near});
    if (!is_zero(contact.force)) push(solved, contact.force);
  }
}

/// By how much a change of its force alone would change its velocity, m/s, as contacts
/// weigh the normal part; up to `quiet` the force stays.
double ContactProblem::visit(Solved& solved, double quiet) {
  Contact& contact = *solved.contact;
  auto& [first, second] = solved.bodies;
  if (first.pushes == first.body->pushes &&
      (second.body == nullptr || second.pushes == second.body->pushes)) {
    return 0;
  }
  const Vec u = velocity(contact);
  double change_of_u = 0;
  if (!(u.x >= 0 && is_zero(contact.force)) && trace(contact.local) != 0) {
    const Vec force = contact_force(solved.near, u - solved.near * contact.force,
                                    contact.friction, contact.force);
    const Vec change = force - contact.force;
    const Vec by_change = solved.near * change;
    const double normal = by_change.x / std::clamp(contact.friction, 0.1, 1.0);
    change_of_u = std::hypot(normal, by_change.y, by_change.z);
    if (change_of_u > quiet) {
      contact.force = force;
      push(solved, change);
      return change_of_u;
    }
  }
  first.pushes = first.body->pushes;
  if (second.body != nullptr) second.pushes = second.body->pushes;
  return change_of_u;
}

void ContactProblem::sweep(Part& part, double quiet) {
  part.busy.clear();
  part.violation = 0;
  for (Solved& solved : part.contacts) {
    const double seen = visit(solved, quiet);
    part.violation = std::max(part.violation, seen);
    if (seen > quiet) part.busy.push_back(&solved);
  }
  for (int i = 0; i < busy_sweeps && part.busy.size() < part.contacts.size() / 2; ++i) {
    double seen = 0;
    for (Solved* const solved : part.busy) seen = std::max(seen, visit(*solved, quiet));
    if (seen <= quiet) break;
  }
}

double ContactProblem::largest_seen() const {
  double largest = 0;
  for (const Part& part : parts_) largest = std::max(largest, part.violation);
  return largest;
}

double ContactProblem::worst(const Loop& loop) {
  each_part(loop, [this](Part& part) {
    part.violation = 0;
    for (const Solved& solved : part.contacts) {
      const Contact& contact = *solved.contact;
      if (trace(contact.local) == 0) continue;
      part.violation =
          std::max(part.violation, contact_violation(contact.local, velocity(contact),
                                                     contact.force, contact.friction));
    }
  });
  return largest_seen();
}

/// Velocity of a contact by unit forces along another one's axes, in its own.
Mat3 ContactProblem::response(const Contact& contact, const Solved& to) const {
  Pack by_axis[3] = {Pack(0), Pack(0), Pack(0)};
  for (const Solved::Pushed& pushed : to.bodies) {
    if (pushed.body == nullptr) break;
    for (const End& end : contact.ends) {
      if (&bodies_[static_cast<std::size_t>(end.body)] != pushed.body) continue;
      const Pack* const at = pushed.columns + 3 * static_cast<std::size_t>(end.point);
      for (std::size_t k = 0; k < 3; ++k) by_axis[k] += Pack(end.weight) * at[k];
    }
  }
  return contact.axes *
         transposed({first3(by_axis[0]), first3(by_axis[1]), first3(by_axis[2])});
}

/// Those contacts with forces that share a body with the one that violates the laws most:
/// sweeps between a few that bear each other may need hundreds to settle.
std::vector<const ContactProblem::Solved*> ContactProblem::about_the_worst() const {
  const Solved* worst = nullptr;
  double most = 0;
  for (const Part& part : parts_) {
    for (const Solved& solved : part.contacts) {
      const Contact& contact = *solved.contact;
      if (trace(contact.local) == 0) continue;
      const double violation = contact_violation(contact.local, velocity(contact),
                                                 contact.force, contact.friction);
      if (!(violation > most)) continue;
      most = violation;
      worst = &solved;
    }
  }
  std::vector<const Solved*> all;
  if (worst == nullptr) return all;
  const auto shares = [&](const Body* body) {
    return body != nullptr &&
           (body == worst->bodies[0].body || body == worst->bodies[1].body);
  };
  for (const Part& part : parts_) {
    for (const Solved& solved : part.contacts) {
      if (is_zero(solved.contact->force) && &solved != worst) continue;
      if (shares(solved.bodies[0].body) || shares(solved.bodies[1].body)) {
        all.push_back(&solved);
      }
    }
  }
  return all;
}

/// Whether they obey the laws then.
bool ContactProblem::solve_jointly(double tolerance) {
  const std::vector<const Solved*> all = about_the_worst();
  if (all.size() > most_joint) return false;
  joint_.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Contact& contact = *all[i]->contact;
    Vec free = velocity(contact);
    for (std::size_t j = 0; j < all.size(); ++j) {
      joint_.block(i, j) = response(contact, *all[j]);
      free = free - joint_.block(i, j) * all[j]->contact->force;
    }
    joint_.contacts()[i] = {contact.friction, free, contact.force};
  }
  const bool solved = joint_.solve(tolerance, joint_steps) <= tolerance;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Contact& contact = *all[i]->contact;
    const Vec change = joint_.contacts()[i].force - contact.force;
    if (is_zero(change)) continue;
    contact.force = joint_.contacts()[i].force;
    push(*all[i], change);
  }
  return solved;
}

ContactProblem::Outcome ContactProblem::solve(double proximal, double tolerance,
                                              int most_sweeps, const Loop& loop) {
  divide();
  for (Body& body : bodies_) std::ranges::fill(body.change, Pack(0));
  each_part(loop, [&](Part& part) { combine(part, proximal); });
  double quiet = quiet_part * tolerance;
  Outcome outcome;
  outcome.violation = worst(loop);
  int wait = first_joint, joint = wait;  // sweeps
  while (outcome.violation > tolerance && outcome.sweeps < most_sweeps) {
    each_part(loop, [&](Part& part) { sweep(part, quiet); });
    ++outcome.sweeps;
    const double seen = largest_seen();
    if (seen > tolerance && outcome.sweeps >= joint) {
      wait = solve_jointly(tolerance) ? next_joint : 2 * wait;
      joint += wait;
      outcome.violation = worst(loop);
      continue;
    }
    // What each saw at its visit is an estimate; at the end it is what is left.
    if (seen > tolerance && outcome.sweeps < most_sweeps) continue;
    outcome.violation = worst(loop);
    if (outcome.violation <= tolerance || seen > quiet) continue;
    quiet *= quieter;
    for (Part& part : parts_) {
      for (Solved& solved : part.contacts) solved.bodies[0].pushes = -1;
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
