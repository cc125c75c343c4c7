#include "models/supports/support_rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "contract/input_error.h"
#include "models/supports/vec_parts.h"

namespace tress::models {
namespace {

std::string name_of(std::size_t i) { return "support " + std::to_string(i); }

MaterialPoints& points_of(System& strand) {
  refuse_if(strand.material_points() == nullptr, "the model has no material points",
            name_of(0), "use a model of a strand");
  return *strand.material_points();
}

}  // namespace

SupportRows::SupportRows(System& strand, std::vector<Support> supports)
    : strand_(strand),
      points_(points_of(strand)),
      accelerations_(point_accelerations(strand)),
      own_(strand.layout().constraints > 0 ? strand.constraint_form() : nullptr),
      own_rows_(static_cast<std::size_t>(strand.layout().constraints)),
      supports_(std::move(supports)) {
  const auto n = static_cast<std::size_t>(strand.layout().coordinates);
  for (auto* x : {&q_typ_, &v_typ_, &zero_, &shifted_, &ahead_, &behind_, &column_}) {
    x->assign(n, 0.0);
  }
  strand.scale(q_typ_, v_typ_);
  x_.resize(3 * static_cast<std::size_t>(points_.count()));
  pattern_.rows = static_cast<int>(n);
  pattern_.start = {0};
  if (own_ != nullptr) {
    pattern_ = own_->pattern();
    own_entries_ = static_cast<std::size_t>(pattern_.nonzeros());
  }
  turns_.assign(own_rows_, false);
  linear_ = points_.mean(0).has_value();
  std::vector<double> q(n), v(n);
  strand.initial_state(q, v);
  points_.positions(0, q, x_);
  for (std::size_t i = 3; i < x_.size(); i += 3) {
    length_ += norm(load3(&x_[i]) - load3(&x_[i - 3]));
  }
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    const Support& support = supports_[i];
    check(support.path, name_of(i));
    refuse_if(support.point < 0 || support.point >= points_.count(),
              "no point " + std::to_string(support.point), name_of(i),
              "give a point of 0 to " + std::to_string(points_.count() - 1));
    refuse_if(accelerations_ == nullptr,
              "the model does not compute the accelerations of its points", name_of(i),
              "use another model");
    for (std::size_t k = 0; k < i; ++k) {
      refuse_if(supports_[k].point == support.point, "a second support of one point",
                name_of(i), "give one of them");
    }
    held_.push_back({static_cast<std::size_t>(pattern_.cols)});
    add_place(support, i, q, column_);
    if (support.section == HeldPart::nothing) continue;
    HeldSection section(strand, support.point, support.path,
                        support.section == HeldPart::frame, support.hinge,
                        strand.sparse_form(), name_of(i));
    if (section.half_edge() || support.turn_sprung()) continue;
    for (std::size_t k = 0; k < section.components().size(); ++k) {
      add_row(section.coordinates(), true);
    }
    held_.back().section = std::move(section);
  }
}

void SupportRows::add_row(const std::vector<int>& coordinates, bool turns) {
  pattern_.row.insert(pattern_.row.end(), coordinates.begin(), coordinates.end());
  constant_.resize(pattern_.row.size() - own_entries_);
  pattern_.start.push_back(static_cast<int>(pattern_.row.size()));
  ++pattern_.cols;
  turns_.push_back(turns);
}

void SupportRows::add_place(const Support& support, std::size_t i, In q, Out column) {
  for (const Vec& axis : support.axes) {
    std::map<int, double> entries;
    if (linear_) {
      const auto mean = *points_.mean(support.point);
      for (std::size_t k = 0; k < static_cast<std::size_t>(mean.count); ++k) {
        for (int c = 0; c < 3; ++c) {
          const double value = mean.weight[k] * component(axis, c);
          if (value != 0) entries[mean.coordinate[k] + c] += value;
        }
      }
    } else {
      const double f[] = {axis.x, axis.y, axis.z};
      std::ranges::fill(column, 0.0);
      refuse_if(!points_.pull_back(0, q, {&support.point, 1}, f, column),
                "the model cannot hold a point of a strand with branches", name_of(i),
                "use a strand without branches");
      for (std::size_t k = 0; k < q.size(); ++k) entries[static_cast<int>(k)] = column[k];
    }
    refuse_if(
        entries.empty() || (support.point == 0 && !linear_ &&
                            std::ranges::all_of(column, [](double x) { return x == 0; })),
        "a support of the clamped root", name_of(i),
        "leave it out, or give [root] motion = \"free\"");
    if (support.sprung()) continue;
    std::vector<int> coordinates;
    for (const auto& entry : entries) coordinates.push_back(entry.first);
    add_row(coordinates, false);
    if (!linear_) continue;
    auto at = constant_.end() - std::ssize(entries);
    for (const auto& entry : entries) *at++ = entry.second;
  }
}

/// Lengths have the size of the strand, rotations that of one radian.
void SupportRows::scale(Out g_typ) const {
  if (own_ != nullptr) own_->scale(g_typ.first(own_rows_));
  for (std::size_t k = own_rows_; k < g_typ.size(); ++k) {
    g_typ[k] = turns_[k] ? 1 : length_;
  }
}

/// Rows of supports: axis . place(support), then the held components of turn(section).
template <class Read, class Turn>
void SupportRows::fill(const Read& place, const Turn& turn, Out rows) {
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    std::size_t row = held_[i].first;
    const Support& support = supports_[i];
    if (!support.rigid_axes().empty()) {
      const Vec d =
          place(load3(&x_[3 * static_cast<std::size_t>(support.point)]), support.path);
      for (const Vec& axis : support.rigid_axes()) rows[row++] = dot(axis, d);
    }
    if (!held_[i].section) continue;
    const Vec c = turn(*held_[i].section);
    for (const int k : held_[i].section->components()) rows[row++] = component(c, k);
  }
}

Status SupportRows::value(double t, In q, Out g) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->value(t, q, g.first(own_rows_));
    if (s != Status::ok) return s;
  }
  points_.positions(t, q, x_);
  fill([t](const Vec& x, const RootMotion& path) { return x - path.at(t).x; },
       [&](HeldSection& section) { return section.gap(t, q).value; }, g);
  return Status::ok;
}

/// Entries of supports in G^T += factor times those at (t, q), without constant ones.
void SupportRows::add_gradient(double t, In q, double factor, InOut entries) {
  const auto part = [&](std::size_t row) {
    const int first = pattern_.start[row];
    return entries.subspan(static_cast<std::size_t>(first) - own_entries_,
                           static_cast<std::size_t>(pattern_.start[row + 1] - first));
  };
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    std::size_t row = held_[i].first;
    for (const Vec& axis : supports_[i].rigid_axes()) {
      if (!linear_) pull(t, q, supports_[i], factor * axis, part(row));
      ++row;
    }
    if (!held_[i].section) continue;
    HeldSection& section = *held_[i].section;
    const SectionGap gap = section.gap(t, q);
    for (const int k : section.components()) {
      for (const int c : section.coordinates()) column_[static_cast<std::size_t>(c)] = 0;
      section.pull(t, q, gap, factor * Vec(k == 0, k == 1, k == 2), column_);
      const InOut to = part(row++);
      for (std::size_t c = 0; c < to.size(); ++c) {
        to[c] += column_[static_cast<std::size_t>(section.coordinates()[c])];
      }
    }
  }
}

Status SupportRows::gradient(double t, In q, Out gt) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->gradient(t, q, gt.first(own_entries_));
    if (s != Status::ok) return s;
  }
  const Out rest = gt.subspan(own_entries_);
  std::ranges::copy(constant_, rest.begin());
  add_gradient(t, q, 1, rest);
  return Status::ok;
}

Status SupportRows::rate(double t, In q, In v, Out g_dot) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->rate(t, q, v, g_dot.first(own_rows_));
    if (s != Status::ok) return s;
  }
  points_.velocities(t, q, v, x_);
  fill([t](const Vec& u, const RootMotion& path) { return u - path.at(t).v; },
       [&](HeldSection& section) { return section.gap(t, q, v, zero_).rate; }, g_dot);
  return Status::ok;
}

Status SupportRows::bias(double t, In q, In v, Out b) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->bias(t, q, v, b.first(own_rows_));
    if (s != Status::ok) return s;
  }
  accelerations_->accelerations(t, q, v, zero_, x_);
  fill([t](const Vec& a, const RootMotion& path) { return a - path.at(t).a; },
       [&](HeldSection& section) { return section.gap(t, q, v, zero_).acceleration; }, b);
  return Status::ok;
}

/// Time (s) in which the motion v changes no coordinate by more than difference_step of
/// its typical size, and turns no held section by more than that angle.
double SupportRows::step(double t, In q, In v) {
  double rate = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    rate = std::max(rate, (std::abs(v[i]) + v_typ_[i]) / q_typ_[i]);
  }
  for (Held& held : held_) {
    if (held.section) {
      rate = std::max(rate, norm(held.section->gap(t, q, v, zero_).rate));
    }
  }
  return difference_step / rate;
}

/// G depends on q and on the motion of the root and the supports. Second derivatives are
/// symmetric, so d(G v + g_t)/dq is the change of G^T along the motion.
Status SupportRows::rate_gradient(double t, In q, In v, Out values) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->rate_gradient(t, q, v, values.first(own_entries_));
    if (s != Status::ok) return s;
  }
  const Out rest = values.subspan(own_entries_);
  std::ranges::fill(rest, 0.0);
  const double h = step(t, q, v);
  for (const double side : {1.0, -1.0}) {
    for (std::size_t i = 0; i < q.size(); ++i) shifted_[i] = q[i] + side * h * v[i];
    add_gradient(t + side * h, shifted_, side / (2 * h), rest);
  }
  return Status::ok;
}

/// sum += G^T lambda of the held places.
void SupportRows::multiplied(double t, In q, In lambda, InOut sum) {
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    pull(t, q, supports_[i], force(i, lambda), sum);
  }
}

/// Force of support i.
Vec SupportRows::force(std::size_t i, In lambda) const {
  Vec sum;
  std::size_t row = held_[i].first;
  for (const Vec& axis : supports_[i].rigid_axes()) sum = sum + lambda[row++] * axis;
  return sum;
}

/// Multipliers of the rotation of support i, in the components of its wall.
Vec SupportRows::stress(std::size_t i, In lambda) const {
  double all[3] = {};
  std::size_t row = held_[i].first + supports_[i].rigid_axes().size();
  for (const int k : held_[i].section->components()) all[k] = lambda[row++];
  return load3(all);
}

SectionLoad SupportRows::load(double t, In q, In lambda, std::size_t i) {
  SectionLoad load;
  if (held_[i].section) {
    load = held_[i].section->load(t, q, stress(i, lambda));
  }
  load.point = supports_[i].point;
  load.force = force(i, lambda);
  return load;
}

Status SupportRows::add_curvature(double t, In q, In lambda, double factor,
                                  InOut s) noexcept {
  if (own_ != nullptr) {
    const Status done = own_->add_curvature(t, q, lambda.first(own_rows_), factor, s);
    if (done != Status::ok) return done;
  }
  const In of_supports = lambda.subspan(own_rows_);
  if (std::ranges::all_of(of_supports, [](double x) { return x == 0; })) {
    return Status::ok;
  }
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    if (!held_[i].section) continue;
    HeldSection& section = *held_[i].section;
    const Vec moment = stress(i, lambda);
    const auto force = [&](In x, InOut b) {
      section.pull(t, x, section.gap(t, x), moment, b);
    };
    section.add_derivative(t, q, true, factor, force, s);
  }
  if (linear_) return Status::ok;
  const std::size_t n = q.size();
  std::ranges::copy(q, shifted_.begin());
  for (std::size_t k = 0; k < n; ++k) {  // S is dense: its column k is s[n k ...]
    const double e = difference_step * q_typ_[k];
    std::ranges::fill(ahead_, 0.0);
    std::ranges::fill(behind_, 0.0);
    shifted_[k] = q[k] + e;
    multiplied(t, shifted_, lambda, ahead_);
    shifted_[k] = q[k] - e;
    multiplied(t, shifted_, lambda, behind_);
    shifted_[k] = q[k];
    for (std::size_t i = 0; i < n; ++i) {
      s[n * k + i] += factor * (ahead_[i] - behind_[i]) / (2 * e);
    }
  }
  return Status::ok;
}

}  // namespace tress::models
