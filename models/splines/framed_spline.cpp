#include "models/splines/framed_spline.h"

#include <algorithm>
#include <numeric>

#include "models/maximal/strained.h"

namespace tress::models {
namespace {

using Span = FramedSpline::Span;

/// Where (r'-, r'+, r', r'') start in the coordinates of SplineBend, and the angles.
constexpr int vectors[4] = {0, 4, 8, 11}, theta_before = 3, theta_behind = 7;

}  // namespace

FramedSpline::FramedSpline(std::vector<Span> spans,
                           std::vector<SplineElasticity::Point> stretching,
                           const Shape& natural, std::vector<Frame> initial, bool clamped)
    : spans_(std::move(spans)),
      stretching_(spans_.size(), std::move(stretching)),
      references_at_start_(std::move(initial)),
      references_(references_at_start_),
      clamped_(clamped) {
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    Span& span = spans_[i];
    double x[most] = {};
    store3(natural.frames[i].e0, x);
    store3(natural.frames[i + 1].e0, x + 4);
    const auto measure = [&](auto& part) {
      part.reference = &natural.frames[i];
      part.strain(x, part.rest);  // `rest` is 0 as yet
      part.reference = &references_[i];
    };
    measure(span.twist);
    for (Span::Point& point : span.points) {
      store3(of_controls(point.first, &natural.controls[3 * i]), x + 8);
      store3(of_controls(point.second, &natural.controls[3 * i]), x + 11);
      measure(point.bend);
    }
    if (held(i)) span.start = {};  // the clamp's frame does not follow from controls
  }
}

std::vector<double> FramedSpline::natural() const {
  std::vector<double> all;
  each_strain(*this, [&all](double rest, double) { all.push_back(rest); });
  return all;
}

void FramedSpline::set_natural(In values) {
  std::size_t k = 0;
  each_strain(*this, [&](double& rest, double) { rest = values[k++]; });
}

std::vector<double> FramedSpline::natural_stiffness() const {
  std::vector<double> all;
  each_strain(*this, [&all](double, double stiffness) { all.push_back(stiffness); });
  return all;
}

std::vector<std::vector<int>> FramedSpline::groups() const {
  std::vector<std::vector<int>> all = stretching_.groups();
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    std::vector<int> group(12);
    std::iota(group.begin(), group.end(), static_cast<int>(3 * i));
    group.push_back(static_cast<int>(angle(i + 1)));
    if (!held(i)) group.push_back(static_cast<int>(angle(i)));
    all.push_back(std::move(group));
  }
  return all;
}

void FramedSpline::at_knots(const Placement& p, std::size_t i,
                            Local& local) const noexcept {
  const auto gather = [&](In z, double* x) {
    if (!held(i)) {
      store3(of_controls(spans_[i].start, &z[3 * i]), x);
      x[theta_before] = z[angle(i)];
    }
    store3(of_controls(spans_[i].end, &z[3 * i]), x + 4);
    x[theta_behind] = z[angle(i + 1)];
  };
  gather(p.z, local.x);
  gather(p.rate, local.rate);
  if (!held(i)) return;
  const Vec t = p.root.frame.e0;
  store3(t, local.x);
  local.x[theta_before] = 0;
  store3(cross(p.root.omega, t), local.rate);
  local.rate[theta_before] = dot(p.root.omega, t);
}

void FramedSpline::at_point(const Placement& p, std::size_t span,
                            const Span::Point& point, Local& local) noexcept {
  const auto gather = [&](In z, double* x) {
    store3(of_controls(point.first, &z[3 * span]), x + 8);
    store3(of_controls(point.second, &z[3 * span]), x + 11);
  };
  gather(p.z, local.x);
  gather(p.rate, local.rate);
}

void FramedSpline::add_force(const Placement& p, InOut f) noexcept {
  if (clamped_) references_[0] = p.root.frame;
  stretching_.add_force(p, f);
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const Span& span = spans_[i];
    Local local;
    double force[most] = {};
    const auto onto_controls = [&](const std::array<double, 4>& weight, int from) {
      for (std::size_t k = 0; k < 4; ++k) {
        double* to = &f[3 * (i + k)];
        store3(load3(to) + weight[k] * load3(force + from), to);
      }
    };
    at_knots(p, i, local);
    Strained(span.twist, local.x, local.rate).add_force(force);
    for (const Span::Point& point : span.points) {
      at_point(p, i, point, local);
      std::fill(force + vectors[2], force + most, 0.0);
      Strained(point.bend, local.x, local.rate).add_force(force);
      onto_controls(point.first, vectors[2]);
      onto_controls(point.second, vectors[3]);
    }
    onto_controls(span.start, vectors[0]);
    onto_controls(span.end, vectors[1]);
    if (!held(i)) f[angle(i)] += force[theta_before];
    f[angle(i + 1)] += force[theta_behind];
  }
}

/// sum (size x size) += B^T h B, B from the coordinates of a group to those of a strain.
void FramedSpline::pull_back(const Span& span, const Span::Point& point, const Square& h,
                             std::size_t size, double* sum) noexcept {
  const std::array<double, 4>* weight[4] = {&span.start, &span.end, &point.first,
                                            &point.second};
  const auto back = [&](auto&& from, auto&& to) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        double total = 0;
        for (std::size_t u = 0; u < 4; ++u) {
          total += (*weight[u])[k] * from(static_cast<std::size_t>(vectors[u]) + c);
        }
        to(3 * k + c, total);
      }
    }
    to(12, from(theta_behind));
    if (size == most) to(13, from(theta_before));
  };
  double half[most][most];
  for (std::size_t r = 0; r < most; ++r) {
    back([&](std::size_t k) { return h[r][k]; },
         [&](std::size_t k, double x) { half[r][k] = x; });
  }
  for (std::size_t c = 0; c < size; ++c) {
    back([&](std::size_t k) { return half[k][c]; },
         [&](std::size_t k, double x) { sum[size * k + c] += x; });
  }
}

void FramedSpline::add_tangent(const Placement& p, double pos, double vel,
                               GroupSum& s) noexcept {
  if (clamped_) references_[0] = p.root.frame;
  stretching_.add_tangent(p, pos, vel, s);
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const Span& span = spans_[i];
    Local local;
    double sum[most * most] = {};
    at_knots(p, i, local);
    for (const Span::Point& point : span.points) {
      at_point(p, i, point, local);
      Square h;
      Strained(point.bend, local.x, local.rate).tangent(pos, vel, h);
      if (&point == span.points.data()) {  // twist has the first eight coordinates
        double of_twist[8][8];
        Strained(span.twist, local.x, local.rate).tangent(pos, vel, of_twist);
        for (int k = 0; k < 8; ++k) {
          for (int l = 0; l < 8; ++l) h[k][l] += of_twist[k][l];
        }
      }
      pull_back(span, point, h, size(i), sum);
    }
    s.add(spans_.size() + i, sum);
  }
}

double FramedSpline::energy(const Placement& p) noexcept {
  if (clamped_) references_[0] = p.root.frame;
  double total = stretching_.energy(p);
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    Local local;
    at_knots(p, i, local);
    total += strain_energy(spans_[i].twist, local.x);
    for (const Span::Point& point : spans_[i].points) {
      at_point(p, i, point, local);
      total += strain_energy(point.bend, local.x);
    }
  }
  return total;
}

double FramedSpline::power(const Placement& p) noexcept {
  if (clamped_) references_[0] = p.root.frame;
  double total = 0;
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    Local local;
    double force[most] = {};
    const auto add = [&](const auto& strained) {
      total += strained.friction_power();
      strained.add_force(force);
    };
    at_knots(p, i, local);
    add(Strained(spans_[i].twist, local.x, local.rate));
    for (const Span::Point& point : spans_[i].points) {
      at_point(p, i, point, local);
      add(Strained(point.bend, local.x, local.rate));
    }
    if (held(i)) total += std::inner_product(force, force + 4, local.rate, 0.0);
  }
  return total;
}

Vec FramedSpline::spin(const Placement& p, In inertia) noexcept {
  Vec sum;
  for (std::size_t knot = first_angle(); knot < references_.size(); ++knot) {
    const EdgeTurn turn(references_[knot].e0, direction(p.z, knot));
    const Vec spin = turn.spin(direction(p.rate, knot), p.rate[angle(knot)]);
    sum = sum + (inertia[knot - first_angle()] * dot(spin, turn.t)) * turn.t;
  }
  return sum;
}

std::optional<Frame> FramedSpline::end_frame(const Placement& p) noexcept {
  const std::size_t knot = spans_.size();
  return edge_frame(references_[knot], direction(p.z, knot), p.z[angle(knot)]);
}

void FramedSpline::reset() {
  references_ = references_at_start_;
  for (Span& span : spans_) span.twist.near = 0;
}

bool FramedSpline::rebase(const RootPose& root, InOut z, InOut rate) {
  if (clamped_) references_[0] = root.frame;
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    Local local;
    at_knots({root, z, rate}, i, local);
    double twist = 0;
    spans_[i].twist.strain(local.x, &twist);
    spans_[i].twist.near = twist;
  }
  replaced_.clear();
  for (std::size_t knot = first_angle(); knot < references_.size(); ++knot) {
    const Frame before = references_[knot];
    if (renew_reference(references_[knot], direction(z, knot), direction(rate, knot),
                        z[angle(knot)], rate[angle(knot)])) {
      replaced_.push_back({knot, before});
    }
  }
  return !replaced_.empty();
}

void FramedSpline::carry(InOut z, InOut rate, InOut second) const {
  for (const auto& [knot, before] : replaced_) {
    refer(before, references_[knot], direction(z, knot), direction(rate, knot),
          direction(second, knot), z[angle(knot)], rate[angle(knot)],
          second[angle(knot)]);
  }
}

void FramedSpline::displace(const Displacement& by, InOut z, InOut rate) {
  for (std::size_t knot = first_angle(); knot < references_.size(); ++knot) {
    models::displace(by, direction(z, knot), references_[knot], rate[angle(knot)]);
  }
}

std::vector<double> FramedSpline::memory() const {
  std::vector<double> all(9 * (references_.size() - first_angle()));
  double* to = all.data();
  for (std::size_t knot = first_angle(); knot < references_.size(); ++knot, to += 9) {
    store9(references_[knot], to);
  }
  for (const Span& span : spans_) all.push_back(span.twist.near);
  return all;
}

void FramedSpline::recall(In memory) {
  const double* from = memory.data();
  for (std::size_t knot = first_angle(); knot < references_.size(); ++knot, from += 9) {
    references_[knot] = load9(from);
  }
  for (Span& span : spans_) span.twist.near = *from++;
}

}  // namespace tress::models
