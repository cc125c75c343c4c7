#include "models/joints/joined_rows.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

std::size_t count(int n) { return static_cast<std::size_t>(n); }

}  // namespace

JoinedRows::JoinedRows(std::vector<Member> members, std::vector<JointPair>& joints)
    : members_(std::move(members)), joints_(joints) {
  pattern_.start = {0};
  for (const Member& member : members_) {
    SupportRows& own = member.strand->rows();
    const Pattern& pattern = own.pattern();
    const Place place{member.first,        count(pattern.rows), count(pattern_.cols),
                      count(pattern.cols), pattern_.row.size(), pattern.row.size()};
    for (const int row : pattern.row) {
      pattern_.row.push_back(row + static_cast<int>(place.first));
    }
    for (std::size_t k = 1; k <= place.rows; ++k) {
      pattern_.start.push_back(static_cast<int>(place.entry) + pattern.start[k]);
    }
    pattern_.cols += pattern.cols;
    pattern_.rows += pattern.rows;
    length_ = std::max(length_, own.length());
    std::vector<double> q(place.size), v(place.size);
    member.strand->scale(q, v);
    q_typ_.insert(q_typ_.end(), q.begin(), q.end());
    v_typ_.insert(v_typ_.end(), v.begin(), v.end());
    places_.push_back(place);
  }
  first_joint_ = count(pattern_.cols);
  for (JointPair& joint : joints_) {
    joint_rows_.push_back({count(pattern_.cols), pattern_.row.size()});
    std::vector<int> coordinates;
    const JointEnd *low = &joint.end(0), *high = &joint.end(1);
    if (low->first() > high->first()) std::swap(low, high);
    for (const JointEnd* end : {low, high}) {
      if (end == high && high->first() == low->first()) break;
      for (std::size_t i = 0; i < end->size(); ++i) {
        coordinates.push_back(static_cast<int>(end->first() + i));
      }
    }
    for (int k = 0; k < joint.rows(); ++k) {
      pattern_.row.insert(pattern_.row.end(), coordinates.begin(), coordinates.end());
      pattern_.start.push_back(static_cast<int>(pattern_.row.size()));
      ++pattern_.cols;
    }
  }
  joint_rows_.push_back({count(pattern_.cols), pattern_.row.size()});
  for (auto* x : {&shifted_, &column_, &ahead_, &behind_}) {
    x->assign(count(pattern_.rows), 0.0);
  }
  gt_.resize(pattern_.row.size());
}

bool JoinedRows::turns(int row) const {
  for (std::size_t k = joints_.size(); k-- > 0;) {
    const auto first = static_cast<int>(joint_rows_[k].row);
    if (row >= first) return joints_[k].turns(row - first);
  }
  return false;
}

In JoinedRows::of_strand(In lambda, std::size_t k) const {
  if (lambda.empty()) return {};
  return lambda.subspan(places_[k].row, places_[k].rows);
}

In JoinedRows::of_joint(In lambda, std::size_t k) const {
  if (lambda.empty()) return {};
  return lambda.subspan(joint_rows_[k].row, joint_rows_[k + 1].row - joint_rows_[k].row);
}

/// act(rows of a strand, its place) of every strand with constraints.
template <class Act>
Status JoinedRows::each_strand(const Act& act) noexcept {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    if (places_[k].rows == 0) continue;
    const Status s = act(members_[k].strand->rows(), places_[k]);
    if (s != Status::ok) return s;
  }
  return Status::ok;
}

/// act(joint, its part of g) of every joint.
template <class Act>
void JoinedRows::each_joint(Out g, const Act& act) noexcept {
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    act(joints_[k], g.subspan(joint_rows_[k].row, count(joints_[k].rows())));
  }
}

void JoinedRows::scale(Out g_typ) const {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    members_[k].strand->rows().scale(g_typ.subspan(places_[k].row, places_[k].rows));
  }
  for (std::size_t k = first_joint_; k < g_typ.size(); ++k) {
    g_typ[k] = turns(static_cast<int>(k)) ? 1 : length_;
  }
}

Status JoinedRows::value(double t, In q, Out g) noexcept {
  const Status s = each_strand([&](SupportRows& rows, const Place& at) {
    return rows.value(t, q.subspan(at.first, at.size), g.subspan(at.row, at.rows));
  });
  each_joint(g, [&](JointPair& joint, Out own) { joint.value(t, q, own); });
  return s;
}

Status JoinedRows::rate(double t, In q, In v, Out g_dot) noexcept {
  const Status s = each_strand([&](SupportRows& rows, const Place& at) {
    return rows.rate(t, q.subspan(at.first, at.size), v.subspan(at.first, at.size),
                     g_dot.subspan(at.row, at.rows));
  });
  each_joint(g_dot, [&](JointPair& joint, Out own) { joint.rate(t, q, v, own); });
  return s;
}

Status JoinedRows::bias(double t, In q, In v, Out b) noexcept {
  const Status s = each_strand([&](SupportRows& rows, const Place& at) {
    return rows.bias(t, q.subspan(at.first, at.size), v.subspan(at.first, at.size),
                     b.subspan(at.row, at.rows));
  });
  each_joint(b, [&](JointPair& joint, Out own) { joint.bias(t, q, v, own); });
  return s;
}

/// Entries of the joints in G^T += factor times those at (t, q).
void JoinedRows::add_gradient(double t, In q, double factor, InOut entries) noexcept {
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    for (int row = 0; row < joints_[k].rows(); ++row) {
      std::ranges::fill(column_, 0.0);
      joints_[k].add_gradient(t, q, row, factor, column_);
      const std::size_t at = joint_rows_[k].row + count(row);
      for (auto p = count(pattern_.start[at]); p < count(pattern_.start[at + 1]); ++p) {
        entries[p] += column_[count(pattern_.row[p])];
      }
    }
  }
}

Status JoinedRows::gradient(double t, In q, Out gt) noexcept {
  const Status s = each_strand([&](SupportRows& rows, const Place& at) {
    return rows.gradient(t, q.subspan(at.first, at.size),
                         gt.subspan(at.entry, at.entries));
  });
  std::ranges::fill(gt.subspan(joint_rows_.front().entry), 0.0);
  add_gradient(t, q, 1, gt);
  return s;
}

/// Second derivatives are symmetric, so d(G v)/dq is the change of G^T along the motion.
Status JoinedRows::rate_gradient(double t, In q, In v, Out values) noexcept {
  const Status s = each_strand([&](SupportRows& rows, const Place& at) {
    return rows.rate_gradient(t, q.subspan(at.first, at.size),
                              v.subspan(at.first, at.size),
                              values.subspan(at.entry, at.entries));
  });
  std::ranges::fill(values.subspan(joint_rows_.front().entry), 0.0);
  double rate = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    rate = std::max(rate, (std::abs(v[i]) + v_typ_[i]) / q_typ_[i]);
  }
  for (JointPair& joint : joints_) {
    rate = std::max(rate, norm(joint.turning_rate(t, q, v)));
  }
  const double h = difference_step / rate;
  for (const double side : {1.0, -1.0}) {
    for (std::size_t i = 0; i < q.size(); ++i) shifted_[i] = q[i] + side * h * v[i];
    add_gradient(t + side * h, shifted_, side / (2 * h), values);
  }
  return s;
}

Status JoinedRows::add_curvature(double t, In q, In lambda, double factor,
                                 InOut s) noexcept {
  if (std::ranges::all_of(lambda, [](double x) { return x == 0; })) return Status::ok;
  const std::size_t n = q.size();
  std::ranges::copy(q, shifted_.begin());
  const auto multiplied = [&](std::vector<double>& sum) {
    const Status done = gradient(t, shifted_, gt_);
    std::ranges::fill(sum, 0.0);
    for (std::size_t k = 0; k < lambda.size(); ++k) {
      for (auto p = count(pattern_.start[k]); p < count(pattern_.start[k + 1]); ++p) {
        sum[count(pattern_.row[p])] += lambda[k] * gt_[p];
      }
    }
    return done;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const double e = difference_step * q_typ_[k];
    shifted_[k] = q[k] + e;
    if (const Status done = multiplied(ahead_); done != Status::ok) return done;
    shifted_[k] = q[k] - e;
    if (const Status done = multiplied(behind_); done != Status::ok) return done;
    shifted_[k] = q[k];
    for (std::size_t i = 0; i < n; ++i) {
      s[n * k + i] += factor * (ahead_[i] - behind_[i]) / (2 * e);
    }
  }
  return Status::ok;
}

}  // namespace tress::models
