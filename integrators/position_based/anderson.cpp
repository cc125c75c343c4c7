#include "integrators/position_based/anderson.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tress::integrators {
namespace {

double product(In x, In y) {
  return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
}

void subtract(double factor, In x, InOut y) {
  for (std::size_t i = 0; i < x.size(); ++i) y[i] -= factor * x[i];
}

}  // namespace

AndersonMixing::AndersonMixing(int depth, std::size_t size, std::vector<double> weights)
    : roots_(std::move(weights)),
      columns_(static_cast<std::size_t>(depth)),
      f_(roots_.size()),
      f_last_(roots_.size()),
      g_last_(size),
      rest_(roots_.size()) {
  for (double& root : roots_) root = std::sqrt(root);
  for (Column& column : columns_) {
    column.df.resize(roots_.size());
    column.dg.resize(size);
    column.basis.resize(roots_.size());
    column.along.resize(columns_.size());
  }
}

void AndersonMixing::restart() {
  count_ = 0;
  begun_ = false;
}

/// The difference from the last iteration becomes the newest column.
void AndersonMixing::remember(In g) {
  newest_ = (newest_ + 1) % columns_.size();
  count_ = std::min(count_ + 1, columns_.size());
  Column& column = columns_[newest_];
  for (std::size_t i = 0; i < f_.size(); ++i) column.df[i] = f_[i] - f_last_[i];
  for (std::size_t i = 0; i < g.size(); ++i) column.dg[i] = g[i] - g_last_[i];
}

/// gamma of all columns, by Gram-Schmidt from the newest to the oldest.
void AndersonMixing::project() {
  const auto at = [this](std::size_t age) -> Column& {
    return columns_[(newest_ + columns_.size() - age) % columns_.size()];
  };
  rest_ = f_;
  for (std::size_t c = 0; c < count_; ++c) {
    Column& column = at(c);
    column.basis = column.df;
    const double whole = std::sqrt(product(column.df, column.df));
    for (std::size_t b = 0; b < c; ++b) {
      if (!at(b).independent) continue;
      column.along[b] = product(at(b).basis, column.basis);
      subtract(column.along[b], at(b).basis, column.basis);
    }
    const double length = std::sqrt(product(column.basis, column.basis));
    column.independent = length > rounding * whole;
    column.gamma = 0;
    if (!column.independent) continue;
    column.along[c] = length;
    for (double& entry : column.basis) entry /= length;
    column.gamma = product(column.basis, rest_);
    subtract(column.gamma, column.basis, rest_);
  }
  for (std::size_t c = count_; c-- > 0;) {
    if (!at(c).independent) continue;
    at(c).gamma /= at(c).along[c];
    for (std::size_t b = 0; b < c; ++b) {
      if (at(b).independent) at(b).gamma -= at(c).along[b] * at(c).gamma;
    }
  }
}

void AndersonMixing::mix(In from, InOut g) {
  if (!active()) return;
  for (std::size_t i = 0; i < f_.size(); ++i) f_[i] = roots_[i] * (g[i] - from[i]);
  const bool grown = product(f_, f_) > growth * growth * product(f_last_, f_last_);
  if (begun_ && grown) restart();
  if (begun_) remember(g);
  begun_ = true;
  f_last_ = f_;
  std::ranges::copy(g, g_last_.begin());
  project();
  for (std::size_t c = 0; c < count_; ++c) {
    const Column& column = columns_[(newest_ + columns_.size() - c) % columns_.size()];
    subtract(column.gamma, column.dg, g);
  }
}

}  // namespace tress::integrators
