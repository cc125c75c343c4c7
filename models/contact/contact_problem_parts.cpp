// How the contacts of a ContactProblem are divided among threads.
#include <algorithm>
#include <numeric>
#include <utility>

#include "models/contact/contact_problem.h"

namespace tress::models {
namespace {

// Parts are not worth a thread with fewer contacts; more parts have more between them.
constexpr std::size_t least_part = 500, most_parts = 4;
// Fewer visits are made before another thread has woken up.
constexpr std::size_t least_visits = 300;
// Contacts that have settled cost a visit this part of one.
constexpr std::size_t settled_per_visit = 32;
// Pairs of parts, so that two that follow each other share none.
constexpr std::pair<std::size_t, std::size_t> pairs_of_parts[] = {{0, 1}, {2, 3}, {0, 2},
                                                                  {1, 3}, {0, 3}, {1, 2}};

// Of stop_driving(): so often friction is reduced by no more than its contact needs.
constexpr int gentle_rounds = 16;

}  // namespace

/// Where contacts find their bodies and columns, with room for those of contacts given
/// since the last solution.
void ContactProblem::link() {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    Contact& contact = contacts_[i];
    Solved& solved = solved_[i];
    solved.contact = &contact;
    const auto a = static_cast<std::size_t>(contact.ends[0].body),
               b = static_cast<std::size_t>(contact.ends[2].body);
    solved.bodies[0].body = &bodies_[a];
    solved.bodies[1].body = a == b ? nullptr : &bodies_[b];
    for (std::size_t k = 0; k < contact.ends.size(); ++k) {
      const End& end = contact.ends[k];
      solved.change[k] = &bodies_[static_cast<std::size_t>(end.body)]
                              .change[static_cast<std::size_t>(end.point)];
    }
    for (Solved::Pushed& on : solved.bodies) {
      if (!solved.given || on.body == nullptr) break;
      on.first = columns_used_;
      columns_used_ += 3 * on.body->change.size();
    }
  }
  if (columns_.size() < columns_used_) columns_.resize(columns_used_);
  for (Solved& solved : solved_) {
    for (Solved::Pushed& on : solved.bodies) on.columns = &columns_[on.first];
  }
}

/// Divides the contacts into parts of neighbours. Bodies are in the order in which
/// contacts lead from one to the next; each part has an equal share of the contacts.
void ContactProblem::divide() {
  const std::size_t count =
      std::clamp<std::size_t>(contacts_.size() / least_part, 1, most_parts);
  rounds_ = {count};
  if (count == most_parts) rounds_.insert(rounds_.end(), {2, 2, 2});
  if (count < most_parts) rounds_.resize(1 + count * (count - 1) / 2, 1);
  parts_.resize(std::accumulate(rounds_.begin(), rounds_.end(), std::size_t{0}));
  for (Part& part : parts_) {
    part.contacts.clear();
    part.visits = 0;
  }
  std::size_t part_between[most_parts][most_parts] = {};
  std::size_t between = count;
  for (const auto& [a, b] : pairs_of_parts) {
    if (b < count) part_between[a][b] = part_between[b][a] = between++;
  }
  const auto bodies_of = [](const Contact& contact) {
    return std::pair(static_cast<std::size_t>(contact.ends[0].body),
                     static_cast<std::size_t>(contact.ends[2].body));
  };
  std::vector<std::size_t> part_of(used_, 0);
  if (count > 1) {
    // Neighbours of body b: neighbours[start[b] ... start[b + 1]).
    std::vector<std::size_t> start(used_ + 2, 0);
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
    std::vector<char> met(used_, 0);
    std::size_t ends = 0;
    for (std::size_t root = 0; root < used_; ++root) {
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
  for (Solved& solved : solved_) {
    const auto [a, b] = bodies_of(*solved.contact);
    const std::size_t first = part_of[a], second = part_of[b];
    Part& part = parts_[first == second ? first : part_between[first][second]];
    part.contacts.push_back(&solved);
    part.visits += solved.given ? 1 : 0;
  }
}

/// `act` may change velocities of the bodies of a part.
void ContactProblem::each_part(const Loop& loop, const std::function<void(Part&)>& act) {
  std::size_t first = 0;
  for (const std::size_t count : rounds_) {
    std::size_t visits = 0;
    for (std::size_t i = first; i < first + count; ++i) {
      visits += parts_[i].visits + parts_[i].contacts.size() / settled_per_visit;
    }
    const auto of_part = [&](std::size_t i) { act(parts_[first + i]); };
    visits < least_visits ? one_by_one(count, of_part) : loop(count, of_part);
    first += count;
  }
}

double ContactProblem::stop_driving(double tolerance, const Loop& loop) {
  bool driven = true;
  for (int round = 0; driven; ++round) {
    driven = false;
    for (Solved& solved : solved_) {
      Contact& contact = *solved.contact;
      const Vec friction{0, contact.force.y, contact.force.z};
      const double work = dot(friction, velocity(solved));
      const double most = contact.friction * std::max(0.0, contact.force.x);
      if (!(work > tolerance * most)) continue;
      driven = true;
      // Without a part p of the friction T it does (T - p T).(u - p W T), 0 at p =
      // T.u/TWT.
      const double all = dot(friction, contact.local * friction);
      const double part = round < gentle_rounds && work < all ? work / all : 1;
      contact.force = contact.force - part * friction;
      push(solved, -part * friction);
    }
  }
  sum_forces();
  return worst(loop, tolerance);
}

/// On the points of bodies.
void ContactProblem::sum_forces() {
  for (Body& body : std::span(bodies_).first(used_))
    std::ranges::fill(body.forces, Vec());
  for (const Contact& contact : contacts_) {
    const Vec world = contact.force * contact.axes;
    for (const End& end : contact.ends) {
      Vec& to = bodies_[static_cast<std::size_t>(end.body)]
                    .forces[static_cast<std::size_t>(end.point)];
      to = to + end.weight * world;
    }
  }
}

}  // namespace tress::models
