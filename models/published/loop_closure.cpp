#include "models/published/loop_closure.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tress::models {
namespace {

// Sums a per-coordinate vector in the same way as the term's angle.
double along(const LoopTerm& term, In x) {
  return term.j < 0 ? x[term.i] : x[term.i] + x[term.j];
}

// Derivative of the given order of length * trig(angle) with respect to the angle.
double turned(const LoopTerm& term, In q, int order) {
  const double angle = along(term, q);
  const int quarter = term.trig == LoopTerm::Trig::sine ? order + 3 : order;
  switch (quarter % 4) {
    case 0:
      return term.length * std::cos(angle);
    case 1:
      return -term.length * std::sin(angle);
    case 2:
      return -term.length * std::cos(angle);
    default:
      return term.length * std::sin(angle);
  }
}

}  // namespace

LoopClosure::LoopClosure(int coordinates, std::span<const LoopTerm> terms,
                         std::span<const double> targets, double typical_length)
    : coordinates_(coordinates),
      terms_(terms.begin(), terms.end()),
      targets_(targets.begin(), targets.end()),
      typical_length_(typical_length) {
  pattern_.rows = coordinates;
  pattern_.cols = count();
  pattern_.start.push_back(0);
  for (int k = 0; k < count(); ++k) {
    std::set<int> touched;
    for (const LoopTerm& term : terms_) {
      if (term.constraint != k) continue;
      touched.insert(term.i);
      if (term.j >= 0) touched.insert(term.j);
    }
    pattern_.row.insert(pattern_.row.end(), touched.begin(), touched.end());
    pattern_.start.push_back(static_cast<int>(pattern_.row.size()));
  }
  const auto slot = [&](int constraint, int coordinate) {
    const auto column = pattern_.row.begin() + pattern_.start[constraint];
    const auto found = std::find(column, pattern_.row.end(), coordinate);
    return static_cast<int>(found - pattern_.row.begin());
  };
  for (const LoopTerm& term : terms_) {
    slots_.push_back(
        {slot(term.constraint, term.i), term.j < 0 ? -1 : slot(term.constraint, term.j)});
  }
}

void LoopClosure::scale(Out g_typ) const {
  std::fill(g_typ.begin(), g_typ.end(), typical_length_);
}

Status LoopClosure::value(double, In q, Out g) noexcept {
  for (int k = 0; k < count(); ++k) g[k] = -targets_[k];
  for (const LoopTerm& term : terms_) g[term.constraint] += turned(term, q, 0);
  return Status::ok;
}

Status LoopClosure::gradient(double, In q, Out gt) noexcept {
  std::fill(gt.begin(), gt.end(), 0.0);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double slope = turned(terms_[k], q, 1);
    gt[slots_[k].i] += slope;
    if (slots_[k].j >= 0) gt[slots_[k].j] += slope;
  }
  return Status::ok;
}

Status LoopClosure::rate(double, In q, In v, Out g_dot) noexcept {
  std::fill(g_dot.begin(), g_dot.end(), 0.0);
  for (const LoopTerm& term : terms_) {
    g_dot[term.constraint] += turned(term, q, 1) * along(term, v);
  }
  return Status::ok;
}

Status LoopClosure::bias(double, In q, In v, Out b) noexcept {
  std::fill(b.begin(), b.end(), 0.0);
  for (const LoopTerm& term : terms_) {
    const double spin = along(term, v);
    b[term.constraint] += turned(term, q, 2) * spin * spin;
  }
  return Status::ok;
}

Status LoopClosure::rate_gradient(double, In q, In v, Out values) noexcept {
  std::fill(values.begin(), values.end(), 0.0);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double slope = turned(terms_[k], q, 2) * along(terms_[k], v);
    values[slots_[k].i] += slope;
    if (slots_[k].j >= 0) values[slots_[k].j] += slope;
  }
  return Status::ok;
}

Status LoopClosure::add_curvature(double, In q, In lambda, double factor,
                                  InOut s) noexcept {
  for (const LoopTerm& term : terms_) {
    const double bend = factor * lambda[term.constraint] * turned(term, q, 2);
    for (const int column : {term.i, term.j}) {
      for (const int row : {term.i, term.j}) {
        if (row >= 0 && column >= 0) s[coordinates_ * column + row] += bend;
      }
    }
  }
  return Status::ok;
}

}  // namespace tress::models
