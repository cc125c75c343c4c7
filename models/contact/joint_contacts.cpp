#include "models/contact/joint_contacts.h"

#include <algorithm>
#include <cmath>

#include "linear/dense_lu.h"
#include "models/contact/cone.h"

namespace tress::models {
namespace {

// Of a contact's own compliance: far above rounding, far below what is singular only
// almost.
constexpr double proximal = 1e-9;

}  // namespace

void JointContacts::resize(std::size_t count) {
  contacts_.resize(count);
  blocks_.resize(count * count);
  velocity_.resize(count);
}

/// Of the forces, whose velocities it sets.
double JointContacts::violation() {
  double worst = 0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& contact = contacts_[i];
    Vec u = contact.free;
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      u = u + block(i, j) * contacts_[j].force;
    }
    velocity_[i] = u;
    worst = std::max(worst,
                     contact_violation(block(i, i), u, contact.force, contact.friction));
  }
  return worst;
}

/// Which of the laws' cases each contact is in, and its equations there.
void JointContacts::linearize() {
  active_.clear();
  std::size_t first = 0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& contact = contacts_[i];
    const Vec& r = contact.force;
    const double m = trace(block(i, i)) / 3;
    if (!(m > 0)) continue;
    const Vec s = r - (1 / m) * velocity_[i];
    if (!(s.x > 0)) continue;
    const double near = proximal * m, pull = std::sqrt(s.y * s.y + s.z * s.z);
    const double most = contact.friction * s.x;
    Active& active = active_.emplace_back();
    active.contact = i;
    active.first = first;
    if (pull <= most && contact.friction > 0) {
      active.unknowns = 3;
      active.column[0] = active.row[0] = {1, 0, 0};
      active.column[1] = active.row[1] = {0, 1, 0};
      active.column[2] = active.row[2] = {0, 0, 1};
      const double known[] = {r.x, r.y, r.z};
      for (std::size_t k = 0; k < 3; ++k) {
        active.own[k] = near;
        active.known[k] = near * known[k];
      }
    } else {
      const double c = pull > 0 ? s.y / pull : 1, d = pull > 0 ? s.z / pull : 0;
      // Across the slide, where s has no part: r_e = turns (r - u/m)_e.
      const double turns = pull > 0 ? most / pull : 0;
      active.unknowns = 2;
      active.column[0] = {1, contact.friction * c, contact.friction * d};
      active.row[0] = {1, 0, 0};
      active.own[0] = near;
      active.known[0] = near * r.x;
      active.column[1] = {0, -d, c};
      active.row[1] = (turns / m) * active.column[1];
      active.own[1] = 1 - turns;
      active.known[1] = 0;
    }
    first += static_cast<std::size_t>(active.unknowns);
  }
}

/// False: its equations are singular.
bool JointContacts::step() {
  linearize();
  const Eigen::Index size =
      active_.empty()
          ? 0
          : static_cast<Eigen::Index>(active_.back().first) + active_.back().unknowns;
  Eigen::MatrixXd matrix(size, size);
  Eigen::VectorXd unknown(size);
  for (const Active& on : active_) {
    for (int k = 0; k < on.unknowns; ++k) {
      const auto row = static_cast<Eigen::Index>(on.first) + k;
      unknown[row] = on.known[k] - dot(on.row[k], contacts_[on.contact].free);
    }
  }
  for (const Active& of : active_) {
    for (int l = 0; l < of.unknowns; ++l) {
      double* const column = &matrix(0, static_cast<Eigen::Index>(of.first) + l);
      for (const Active& on : active_) {
        // Its first row is (1, 0, 0), and so on where it sticks.
        const Vec u = block(on.contact, of.contact) * of.column[l];
        double* const to = column + on.first;
        to[0] = u.x;
        if (on.unknowns == 3) {
          to[1] = u.y;
          to[2] = u.z;
        } else {
          to[1] = dot(on.row[1], u);
        }
      }
      column[of.first + static_cast<std::size_t>(l)] += of.own[l];
    }
  }
  DenseLu lu(size);
  if (!(lu.factor(matrix) > 0)) return false;
  lu.solve(unknown);
  for (Contact& contact : contacts_) contact.force = {};
  for (const Active& on : active_) {
    Vec& force = contacts_[on.contact].force;
    for (int k = 0; k < on.unknowns; ++k) {
      force = force + unknown[static_cast<Eigen::Index>(on.first) + k] * on.column[k];
    }
  }
  return unknown.allFinite();
}

double JointContacts::solve(double tolerance, int most_steps) {
  double least = violation();
  const auto keep = [this] {
    best_.clear();
    for (const Contact& contact : contacts_) best_.push_back(contact.force);
  };
  keep();
  for (int i = 0; i < most_steps && least > tolerance && step(); ++i) {
    const double now = violation();
    if (!(now < least)) continue;
    least = now;
    keep();
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) contacts_[i].force = best_[i];
  return least;
}

}  // namespace tress::models
