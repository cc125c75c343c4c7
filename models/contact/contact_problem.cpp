#include "models/contact/contact_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/contact/cone.h"

namespace tress::models {
namespace {

Mat3 transposed(const Mat3& a) {
  return {{a.r0.x, a.r1.x, a.r2.x}, {a.r0.y, a.r1.y, a.r2.y}, {a.r0.z, a.r1.z, a.r2.z}};
}

// Contacts whose force would change their velocities by less than this part of the
// tolerance are left alone, for so many sweeps over the others: most settle at once, and
// a few take long.
constexpr double quiet_part = 0.5;
constexpr int busy_sweeps = 10;
// Where all are quiet and one violates the laws nevertheless, less is quiet.
constexpr double quieter = 0.1;

// Fewer contacts are judged before another thread has woken up.
constexpr std::size_t least_judged = 1000;

// The contacts about the worst one, unless they are more than these, are solved at once
// after so many sweeps; then after so many more where that solved them, else after twice
// as many as before.
constexpr int first_joint = 2, next_joint = 10, joint_steps = 6;
constexpr std::size_t most_joint = 32;

Vec first3(const Pack& x) { return {x[0], x[1], x[2]}; }

bool is_zero(const Vec& a) { return a.x == 0 && a.y == 0 && a.z == 0; }

/// Size of a change of a contact's velocity, the normal part as the laws weigh it.
double weighed(const Vec& u, double friction) {
  const double normal = u.x / std::clamp(friction, 0.1, 1.0);
  return std::sqrt(normal * normal + u.y * u.y + u.z * u.z);
}

}  // namespace

Mat3 axes_about(const Vec& normal) {
  const Vec aside = std::abs(normal.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  const Vec across = cross(normal, aside);
  const Vec first = (1 / norm(across)) * across;
  return {normal, first, cross(normal, first)};
}

void ContactProblem::Compliance::set(In blocks) {
  points_ = static_cast<std::size_t>(std::lround(std::sqrt(blocks.size() / 9)));
  columns_.resize(blocks.size() / 3);
  for (std::size_t i = 0; i < columns_.size(); i += 3) {
    const double* const block = &blocks[3 * i];
    for (std::size_t k = 0; k < 3; ++k) {
      columns_[i + k] = {block[k], block[3 + k], block[6 + k], 0};
    }
  }
}

void ContactProblem::clear() {
  used_ = 0;
  contacts_.clear();
  solved_.clear();
  columns_used_ = 0;
}

void ContactProblem::Body::respond_as(const Compliance& given) {
  compliance = &given;
  change.assign(given.points_, Pack(0));
  forces.assign(given.points_, Vec());
  renewed = true;
}

int ContactProblem::add_body(const Compliance& compliance) {
  if (used_ == bodies_.size()) bodies_.emplace_back();
  bodies_[used_].respond_as(compliance);
  return static_cast<int>(used_++);
}

void ContactProblem::renew_body(int body) {
  Body& renewed = bodies_[static_cast<std::size_t>(body)];
  renewed.respond_as(*renewed.compliance);
}

void ContactProblem::add(std::size_t count) {
  contacts_.resize(contacts_.size() + count);
  solved_.resize(contacts_.size());
}

void ContactProblem::add(const Contact& contact) {
  add(1);
  set(contacts_.size() - 1, contact);
}

void ContactProblem::set(std::size_t number, const Contact& contact) {
  Solved& solved = solved_[number];
  const Vec force = solved.solved ? contacts_[number].force : contact.force;
  contacts_[number] = contact;
  contacts_[number].force = force;
  solved.given = true;
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

Vec ContactProblem::velocity(const Solved& solved) {
  const Contact& contact = *solved.contact;
  Pack change(0);
  for (std::size_t i = 0; i < contact.ends.size(); ++i) {
    change += Pack(contact.ends[i].weight) * *solved.change[i];
  }
  return contact.free + contact.axes * first3(change);
}

void ContactProblem::push(const Solved::Pushed& on, const Vec& force) {
  const Pack normal(force.x), first(force.y), second(force.z);
  ++on.body->pushes;
  const Pack* column = on.columns;
  for (Pack& change : on.body->change) {
    change += column[0] * normal + column[1] * first + column[2] * second;
    column += 3;
  }
}

void ContactProblem::push(const Solved& solved, const Vec& force) {
  push(solved.bodies[0], force);
  if (solved.bodies[1].body != nullptr) push(solved.bodies[1], force);
}

/// How the bodies of a contact, and the contact itself, respond to forces along its axes.
void ContactProblem::combine(Solved& solved, double proximal) {
  Contact& contact = *solved.contact;
  const Mat3& axes = contact.axes;
  Mat3 world{};  // by axes of the force, rows
  for (const Solved::Pushed& on : solved.bodies) {
    if (on.body == nullptr) break;
    Pack* const to = &columns_[on.first];
    const std::size_t points = on.body->change.size();
    const Pack* from[4];
    double weight[4];
    std::size_t ends = 0;
    for (const End& end : contact.ends) {
      if (&bodies_[static_cast<std::size_t>(end.body)] != on.body || end.weight == 0) {
        continue;
      }
      from[ends] = on.body->compliance->columns_.data() +
                   3 * points * static_cast<std::size_t>(end.point);
      weight[ends++] = end.weight;
    }
    for (std::size_t k = 0; k < 3 * points; k += 3) {
      Pack x(0), y(0), z(0);  // by components of the force
      for (std::size_t end = 0; end < ends; ++end) {
        const Pack* const column = from[end] + k;
        x += Pack(weight[end]) * column[0];
        y += Pack(weight[end]) * column[1];
        z += Pack(weight[end]) * column[2];
      }
      to[k] = x * Pack(axes.r0.x) + y * Pack(axes.r0.y) + z * Pack(axes.r0.z);
      to[k + 1] = x * Pack(axes.r1.x) + y * Pack(axes.r1.y) + z * Pack(axes.r1.z);
      to[k + 2] = x * Pack(axes.r2.x) + y * Pack(axes.r2.y) + z * Pack(axes.r2.z);
    }
    for (const End& end : contact.ends) {
      if (&bodies_[static_cast<std::size_t>(end.body)] != on.body) continue;
      const Pack* const at = to + 3 * static_cast<std::size_t>(end.point);
      world = world + end.weight * Mat3{first3(at[0]), first3(at[1]), first3(at[2])};
    }
  }
  contact.local = axes * transposed(world);
  const double size = trace(contact.local);
  if (size == 0) contact.force = {};
  const double near = proximal * size / 3;
  solved.near = contact.local + diagonal({near, near, near});
  solved.wake();
}

/// Once on each body: one that was solved is not known to renewed bodies alone.
void ContactProblem::push_guess(Solved& solved) {
  if (!is_zero(solved.contact->force)) {
    for (const Solved::Pushed& on : solved.bodies) {
      if (on.body == nullptr) break;
      if (on.body->renewed || !solved.solved) push(on, solved.contact->force);
    }
  }
  solved.given = false;
  solved.solved = true;
}

/// Whether the velocities of its bodies are those of the visit at which it had settled.
bool ContactProblem::settled(const Solved& solved) {
  const auto& [first, second] = solved.bodies;
  return first.pushes == first.body->pushes &&
         (second.body == nullptr || second.pushes == second.body->pushes);
}

void ContactProblem::settle(Solved& solved) {
  auto& [first, second] = solved.bodies;
  first.pushes = first.body->pushes;
  if (second.body != nullptr) second.pushes = second.body->pushes;
}

/// Whatever it has seen, its next visit is a solution.
void ContactProblem::Solved::wake() {
  bodies[0].pushes = -1;
  left = std::numeric_limits<double>::infinity();
}

/// By how much a change of its force alone would change its velocity, m/s, as contacts
/// weigh the normal part; up to `quiet` the force stays. Where that is seen without a
/// solution, from how the velocity has changed since the last one, it is a bound.
double ContactProblem::visit(Solved& solved, double quiet) {
  solved.judged = false;
  Contact& contact = *solved.contact;
  const double friction = contact.friction;
  const Vec u = velocity(solved);
  const double at_most = solved.left + weighed(u - solved.seen, friction);
  if (at_most <= quiet) {
    settle(solved);
    return at_most;
  }
  solved.seen = u;
  solved.left = 0;
  if (!(u.x >= 0 && is_zero(contact.force)) && trace(contact.local) != 0) {
    const Vec force = contact_force(solved.near, u - solved.near * contact.force,
                                    friction, contact.force);
    const Vec change = force - contact.force, by_change = solved.near * change;
    const double change_of_u = weighed(by_change, friction);
    if (change_of_u > quiet) {
      contact.force = force;
      push(solved, change);
      const Vec changed = contact.local * change;
      solved.seen = u + changed;
      solved.left = weighed(by_change - changed, friction);
      if (solved.left <= quiet) settle(solved);
      return change_of_u;
    }
    solved.left = change_of_u;
  }
  settle(solved);
  return solved.left;
}

void ContactProblem::sweep(Part& part, double quiet) {
  part.busy.clear();
  part.violation = 0;
  part.visits = 0;
  for (Solved* const solved : part.contacts) {
    if (settled(*solved)) continue;
    ++part.visits;
    const double seen = visit(*solved, quiet);
    part.violation = std::max(part.violation, seen);
    if (seen > quiet) part.busy.push_back(solved);
  }
  for (int i = 0; i < busy_sweeps && part.busy.size() < part.contacts.size() / 2; ++i) {
    double seen = 0;
    for (Solved* const solved : part.busy) {
      if (settled(*solved)) continue;
      ++part.visits;
      seen = std::max(seen, visit(*solved, quiet));
    }
    if (seen <= quiet) break;
  }
}

double ContactProblem::largest_seen() const {
  double largest = 0;
  for (const Part& part : parts_) largest = std::max(largest, part.violation);
  return largest;
}

/// Contacts that obey the laws within the tolerance are left alone until their bodies
/// change.
double ContactProblem::worst(const Loop& loop, double tolerance) {
  const auto judge = [this, tolerance](std::size_t i) {
    Part& part = parts_[i];
    part.violation = 0;
    part.worst = nullptr;
    for (Solved* const solved : part.contacts) {
      const Contact& contact = *solved->contact;
      if (trace(contact.local) == 0) continue;
      if (!solved->judged || !settled(*solved)) {
        solved->judged = true;
        solved->seen = velocity(*solved);
        solved->violation = contact_violation(contact.local, solved->seen, contact.force,
                                              contact.friction);
        solved->left = solved->violation;
        if (solved->left <= tolerance) settle(*solved);
      }
      if (!(solved->violation > part.violation)) continue;
      part.violation = solved->violation;
      part.worst = solved;
    }
  };
  contacts_.size() < least_judged ? one_by_one(parts_.size(), judge)
                                  : loop(parts_.size(), judge);
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
/// sweeps between a few that bear each other may need hundreds to settle. After worst().
std::vector<const ContactProblem::Solved*> ContactProblem::about_the_worst() const {
  const Solved* const worst =
      std::ranges::max_element(parts_, {}, &Part::violation)->worst;
  std::vector<const Solved*> all;
  if (worst == nullptr) return all;
  const auto shares = [&](const Body* body) {
    return body != nullptr &&
           (body == worst->bodies[0].body || body == worst->bodies[1].body);
  };
  for (const Part& part : parts_) {
    for (const Solved* const solved : part.contacts) {
      if (is_zero(solved->contact->force) && solved != worst) continue;
      if (shares(solved->bodies[0].body) || shares(solved->bodies[1].body)) {
        all.push_back(solved);
      }
    }
  }
  return all;
}

/// Those about the worst one; too many are left as they are.
ContactProblem::Joint ContactProblem::solve_jointly(const Loop& loop, double tolerance) {
  worst(loop, tolerance);
  const std::vector<const Solved*> all = about_the_worst();
  if (all.size() > most_joint) return {};
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
  const double violation = joint_.solve(tolerance, joint_steps);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Contact& contact = *all[i]->contact;
    const Vec change = joint_.contacts()[i].force - contact.force;
    if (is_zero(change)) continue;
    contact.force = joint_.contacts()[i].force;
    push(*all[i], change);
  }
  return {violation, all.size() == contacts_.size()};
}

ContactProblem::Outcome ContactProblem::solve(double proximal, double tolerance,
                                              int most_sweeps, const Loop& loop) {
  link();
  divide();
  loop(parts_.size(), [&](std::size_t i) {
    for (Solved* const solved : parts_[i].contacts) {
      if (solved->given) combine(*solved, proximal);
    }
  });
  each_part(loop, [](Part& part) {
    for (Solved* const solved : part.contacts) {
      if (solved->given) push_guess(*solved);
    }
  });
  for (Body& body : std::span(bodies_).first(used_)) body.renewed = false;
  double quiet = quiet_part * tolerance;
  Outcome outcome;
  outcome.violation = worst(loop, tolerance);
  int wait = first_joint, joint = wait;  // sweeps
  while (outcome.violation > tolerance && outcome.sweeps < most_sweeps) {
    each_part(loop, [&](Part& part) { sweep(part, quiet); });
    ++outcome.sweeps;
    const double seen = largest_seen();
    if (seen > tolerance && outcome.sweeps >= joint) {
      const Joint about_worst = solve_jointly(loop, tolerance);
      const bool solved = about_worst.violation <= tolerance;
      wait = solved ? next_joint : 2 * wait;
      joint += wait;
      if (solved) {
        outcome.violation =
            about_worst.all ? about_worst.violation : worst(loop, tolerance);
      }
      continue;
    }
    // What each saw at its visit is an estimate; at the end it is what is left.
    if (seen > tolerance && outcome.sweeps < most_sweeps) continue;
    outcome.violation = worst(loop, tolerance);
    if (outcome.violation <= tolerance || seen > quiet) continue;
    quiet *= quieter;
    for (Solved& solved : solved_) solved.wake();
  }
  sum_forces();
  return outcome;
}

}  // namespace tress::models
