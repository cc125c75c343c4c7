#include "models/supports/support_rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "contract/input_error.h"

namespace tress::models {
namespace {

/// Step of central differences in units of typical sizes: the cube root of the roundoff.
constexpr double difference_step = 6e-6;

std::string name_of(std::size_t i) { return "support " + std::to_string(i); }

MaterialPoints& points_of(System& strand) {
  MaterialPoints* const points = strand.material_points();
  if (points != nullptr) return *points;
  throw InputError("the model has no material points", name_of(0),
                   "use a model of a strand");
}

double component(const Vec& x, int i) { return i == 0 ? x.x : i == 1 ? x.y : x.z; }

}  // namespace

SupportRows::SupportRows(System& strand, std::vector<Support> supports)
    : strand_(strand),
      points_(points_of(strand)),
      accelerations_(point_accelerations(strand)),
      own_(strand.layout().constraints > 0 ? strand.constraint_form() : nullptr),
      own_rows_(strand.layout().constraints),
      supports_(std::move(supports)) {
  const auto n = static_cast<std::size_t>(strand.layout().coordinates);
  for (auto* x : {&q_typ_, &v_typ_, &zero_, &shifted_, &ahead_, &behind_}) {
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
  linear_ = points_.mean(0).has_value();
  std::vector<double> q(n), v(n), column(n);
  strand.initial_state(q, v);
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
        for (std::size_t k = 0; k < n; ++k) entries[static_cast<int>(k)] = column[k];
      }
      refuse_if(entries.empty() ||
                    (support.point == 0 && !linear_ &&
                     std::ranges::all_of(column, [](double x) { return x == 0; })),
                "a support of the clamped root", name_of(i),
                "leave it out, or give [root] motion = \"free\"");
      for (const auto& [row, value] : entries) {
        pattern_.row.push_back(row);
        if (linear_) constant_.push_back(value);
      }
      pattern_.start.push_back(static_cast<int>(pattern_.row.size()));
      ++pattern_.cols;
    }
  }
}

void SupportRows::scale(Out g_typ) const {
  if (own_ != nullptr) own_->scale(g_typ.first(static_cast<std::size_t>(own_rows_)));
  std::vector<double> q(q_typ_.size()), v(q_typ_.size()), x(x_.size());
  strand_.initial_state(q, v);
  points_.positions(0, q, x);
  double length = 0;
  for (std::size_t i = 3; i < x.size(); i += 3) {
    length += norm(load3(&x[i]) - load3(&x[i - 3]));
  }
  std::ranges::fill(g_typ.subspan(static_cast<std::size_t>(own_rows_)), length);
}

/// rows = axis . (point of x - place of the path), for each support.
template <class Read>
void SupportRows::fill(const std::vector<double>& x, const Read& place, Out rows) const {
  auto row = static_cast<std::size_t>(own_rows_);
  for (const Support& support : supports_) {
    const Vec d =
        load3(&x[3 * static_cast<std::size_t>(support.point)]) - place(support.path);
    for (const Vec& axis : support.axes) rows[row++] = dot(axis, d);
  }
}

Status SupportRows::value(double t, In q, Out g) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->value(t, q, g.first(static_cast<std::size_t>(own_rows_)));
    if (s != Status::ok) return s;
  }
  points_.positions(t, q, x_);
  fill(
      x_, [t](const RootMotion& path) { return path.at(t).x; }, g);
  return Status::ok;
}

void SupportRows::pull(double t, In q, const Support& support, const Vec& axis,
                       InOut column) {
  const double f[] = {axis.x, axis.y, axis.z};
  static_cast<void>(points_.pull_back(t, q, {&support.point, 1}, f, column));
}

Status SupportRows::gradient(double t, In q, Out gt) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->gradient(t, q, gt.first(own_entries_));
    if (s != Status::ok) return s;
  }
  Out rest = gt.subspan(own_entries_);
  if (linear_) {
    std::ranges::copy(constant_, rest.begin());
    return Status::ok;
  }
  std::ranges::fill(rest, 0.0);
  for (const Support& support : supports_) {
    for (const Vec& axis : support.axes) {
      pull(t, q, support, axis, rest.first(q.size()));
      rest = rest.subspan(q.size());
    }
  }
  return Status::ok;
}

Status SupportRows::rate(double t, In q, In v, Out g_dot) noexcept {
  if (own_ != nullptr) {
    const Status s =
        own_->rate(t, q, v, g_dot.first(static_cast<std::size_t>(own_rows_)));
    if (s != Status::ok) return s;
  }
  points_.velocities(t, q, v, x_);
  fill(
      x_, [t](const RootMotion& path) { return path.at(t).v; }, g_dot);
  return Status::ok;
}

Status SupportRows::bias(double t, In q, In v, Out b) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->bias(t, q, v, b.first(static_cast<std::size_t>(own_rows_)));
    if (s != Status::ok) return s;
  }
  accelerations_->accelerations(t, q, v, zero_, x_);
  fill(
      x_, [t](const RootMotion& path) { return path.at(t).a; }, b);
  return Status::ok;
}

/// Time (s) in which the motion v changes no coordinate by more than difference_step of
/// its typical size.
double SupportRows::step(In v) const {
  double rate = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    rate = std::max(rate, (std::abs(v[i]) + v_typ_[i]) / q_typ_[i]);
  }
  return difference_step / rate;
}

/// G depends on q and on the root's motion: d(G v + g_t)/dq is the change of G^T along
/// the motion, since second derivatives are symmetric.
Status SupportRows::rate_gradient(double t, In q, In v, Out values) noexcept {
  if (own_ != nullptr) {
    const Status s = own_->rate_gradient(t, q, v, values.first(own_entries_));
    if (s != Status::ok) return s;
  }
  Out rest = values.subspan(own_entries_);
  std::ranges::fill(rest, 0.0);
  if (linear_) return Status::ok;
  const double h = step(v);
  for (const Support& support : supports_) {
    for (const Vec& axis : support.axes) {
      const Out column = rest.first(q.size());
      for (const double side : {1.0, -1.0}) {
        for (std::size_t i = 0; i < q.size(); ++i) shifted_[i] = q[i] + side * h * v[i];
        pull(t + side * h, shifted_, support, (side / (2 * h)) * axis, column);
      }
      rest = rest.subspan(q.size());
    }
  }
  return Status::ok;
}

/// sum += G^T lambda of the supports.
void SupportRows::multiplied(double t, In q, In lambda, InOut sum) {
  std::size_t row = 0;
  for (const Support& support : supports_) {
    Vec force;
    for (const Vec& axis : support.axes) force = force + lambda[row++] * axis;
    pull(t, q, support, force, sum);
  }
}

Status SupportRows::add_curvature(double t, In q, In lambda, double factor,
                                  InOut s) noexcept {
  if (own_ != nullptr) {
    const Status done = own_->add_curvature(
        t, q, lambda.first(static_cast<std::size_t>(own_rows_)), factor, s);
    if (done != Status::ok) return done;
  }
  const In of_supports = lambda.subspan(static_cast<std::size_t>(own_rows_));
  if (linear_ || std::ranges::all_of(of_supports, [](double x) { return x == 0; })) {
    return Status::ok;
  }
  const std::size_t n = q.size();
  std::ranges::copy(q, shifted_.begin());
  for (std::size_t k = 0; k < n; ++k) {  // S is dense: its column k is s[n k ...]
    const double e = difference_step * q_typ_[k];
    std::ranges::fill(ahead_, 0.0);
    std::ranges::fill(behind_, 0.0);
    shifted_[k] = q[k] + e;
    multiplied(t, shifted_, of_supports, ahead_);
    shifted_[k] = q[k] - e;
    multiplied(t, shifted_, of_supports, behind_);
    shifted_[k] = q[k];
    for (std::size_t i = 0; i < n; ++i) {
      s[n * k + i] += factor * (ahead_[i] - behind_[i]) / (2 * e);
    }
  }
  return Status::ok;
}

}  // namespace tress::models
