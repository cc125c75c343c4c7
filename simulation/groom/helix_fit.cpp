#include "simulation/groom/helix_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "math/helix.h"
#include "math/mat3.h"
#include "simulation/groom/frames.h"

namespace tress::simulation {
namespace {

constexpr int most_fit_steps = 12;
constexpr double enough_gain = 1e-3;  // of the sum of squares in a step

// Gauss-Legendre on [0, 1].
constexpr std::array<double, 3> gauss_at{0.5 - 0.38729833462074169, 0.5,
                                         0.5 + 0.38729833462074169};
constexpr std::array<double, 3> gauss_weight{5.0 / 18, 8.0 / 18, 5.0 / 18};

/// Helix from a frame at the origin, at arc length s, with K = [kappa]x:
///
///     R = 1 + S K + A K^2,   x = W e0,   W = int_0^s R = s + A K + B K^2
struct HelixPlace {
  HelixFunctions<double> f;
  Vec k;
  double s;

  HelixPlace(const Vec& kappa, double arc)
      : f(helix_functions(arc, dot(kappa, kappa), arc)), k(kappa), s(arc) {}
  Vec turned(const Vec& x) const {
    const Vec y = cross(k, x);
    return x + f.S * y + f.A * cross(k, y);
  }
  Frame frame() const {
    return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
  }
  Vec summed(const Vec& x) const {
    const Vec y = cross(k, x);
    return s * x + f.A * y + f.B * cross(k, y);
  }
  Vec place() const { return summed({1, 0, 0}); }
  /// d place() for d kappa.
  Vec moved(const Vec& dk) const {
    const Vec e0{1, 0, 0}, y = cross(k, e0), z = cross(k, y), dy = cross(dk, e0);
    const double along = dot(k, dk);
    return f.A * dy + f.B * (cross(dk, y) + cross(k, dy)) + (along * f.A1) * y +
           (along * f.B1) * z;
  }
};

constexpr Vec unit(std::size_t c) {
  return {c == 0 ? 1.0 : 0, c == 1 ? 1.0 : 0, c == 2 ? 1.0 : 0};
}

/// A small symmetric positive definite system, dense, by rows of its lower half.
class Normal {
 public:
  explicit Normal(std::size_t n) : n_(n), a_(n * n), b_(n) {}

  void clear() {
    std::ranges::fill(a_, 0.0);
    std::ranges::fill(b_, 0.0);
  }
  /// Adds a row J, zero from `used` on, of residual r.
  void add(const double* row, std::size_t used, double r) {
    for (std::size_t i = 0; i < used; ++i) {
      const double ji = row[i];
      double* const to = &a_[i * n_];
      for (std::size_t j = 0; j <= i; ++j) to[j] += ji * row[j];
      b_[i] -= ji * r;
    }
  }
  /// Solves with (1 + damping) times the diagonal; false: not positive definite.
  bool solve(double damping, std::vector<double>& x) {
    factor_ = a_;
    x = b_;
    for (std::size_t i = 0; i < n_; ++i) {
      double* const row = &factor_[i * n_];
      row[i] *= 1 + damping;
      for (std::size_t j = 0; j <= i; ++j) {
        const double* const other = &factor_[j * n_];
        double sum = row[j];
        for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
        if (j < i) {
          row[j] = sum / other[j];
        } else if (sum > 0) {
          row[i] = std::sqrt(sum);
        } else {
          return false;
        }
      }
      for (std::size_t k = 0; k < i; ++k) x[i] -= row[k] * x[k];
      x[i] /= row[i];
    }
    for (std::size_t i = n_; i-- > 0;) {
      x[i] /= factor_[i * n_ + i];
      for (std::size_t k = 0; k < i; ++k) x[k] -= factor_[i * n_ + k] * x[i];
    }
    return true;
  }

 private:
  std::size_t n_;
  std::vector<double> a_, b_, factor_;
};

/// The sum of squares, and its normal equations, of one curve. Unknowns: a rotation of
/// the root in space (rad), then the angles l kappa of each element (rad).
class HelixFitting {
 public:
  HelixFitting(const SpaceCurve& curve, std::span<const double> joints,
               const FitWeights& weights)
      : n_(joints.size() - 1),
        weights_(weights),
        length_(curve.length()),
        normal_(3 + 3 * n_) {
    for (std::size_t i = 0; i < n_; ++i) {
      lengths_.push_back(joints[i + 1] - joints[i]);
      for (const double at : gauss_at) {
        targets_.push_back(curve.position(curve.parameter(joints[i] + at * lengths_[i])));
      }
    }
  }

  double squares(const HelixChain& chain) {
    Vec x = chain.place;
    Frame frame = chain.root;
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double l = lengths_[i];
      for (std::size_t g = 0; g < 3; ++g) {
        const HelixPlace at(chain.darboux[i], gauss_at[g] * l);
        const Vec r = scale(i, g) * (x + frame * at.place() - targets_[3 * i + g]);
        sum += dot(r, r);
      }
      const HelixPlace tip(chain.darboux[i], l);
      x = x + frame * tip.place();
      frame = frame * tip.frame();
      const double tau = l * chain.darboux[i].x;
      sum += weights_.twist * tau * tau;
      if (i + 1 == n_) continue;
      const Vec jump = mean_length(i) * (chain.darboux[i + 1] - chain.darboux[i]);
      sum += weights_.jump * dot(jump, jump);
    }
    return sum;
  }

  void linearize(const HelixChain& chain) {
    normal_.clear();
    const std::size_t unknowns = 3 + 3 * n_;
    // Of the angles of the elements before: place x moves by moved - about x turned.
    std::vector<Vec> turned(unknowns), moved(unknowns);
    for (std::size_t c = 0; c < 3; ++c) {
      turned[c] = unit(c);
      moved[c] = -1.0 * cross(unit(c), chain.place);
    }
    std::vector<double> rows(3 * unknowns);
    Vec x = chain.place;
    Frame frame = chain.root;
    for (std::size_t i = 0; i < n_; ++i) {
      const double l = lengths_[i];
      const std::size_t own = 3 + 3 * i;
      const auto set = [&](std::size_t u, double by, const Vec& d) {
        rows[u] = by * d.x;
        rows[unknowns + u] = by * d.y;
        rows[2 * unknowns + u] = by * d.z;
      };
      for (std::size_t g = 0; g < 3; ++g) {
        const HelixPlace at(chain.darboux[i], gauss_at[g] * l);
        const Vec y = x + frame * at.place();
        const double by = scale(i, g);
        for (std::size_t u = 0; u < own; ++u) set(u, by, moved[u] + cross(turned[u], y));
        for (std::size_t c = 0; c < 3; ++c) {
          set(own + c, by / l, frame * at.moved(unit(c)));
        }
        const Vec r = by * (y - targets_[3 * i + g]);
        normal_.add(&rows[0], own + 3, r.x);
        normal_.add(&rows[unknowns], own + 3, r.y);
        normal_.add(&rows[2 * unknowns], own + 3, r.z);
      }
      const HelixPlace tip(chain.darboux[i], l);
      const Vec end = x + frame * tip.place();
      for (std::size_t c = 0; c < 3; ++c) {
        turned[own + c] = 1 / l * (frame * tip.summed(unit(c)));
        moved[own + c] =
            1 / l * (frame * tip.moved(unit(c))) - cross(turned[own + c], end);
      }
      x = end;
      frame = frame * tip.frame();
      add_weights(chain, i, rows);
    }
  }

  /// Goes from a chain to a better one of sum of squares `now`; false: there is none.
  bool step(HelixChain& chain, double& now, double& damping) {
    linearize(chain);
    for (int attempt = 0; attempt < 8; ++attempt, damping *= 8) {
      if (!normal_.solve(damping, change_)) continue;
      HelixChain next = chain;
      const Vec rotated = load3(change_.data());
      const double angle = norm(rotated);
      if (angle > 0) next.root = rotation(1 / angle * rotated, angle) * chain.root;
      for (std::size_t i = 0; i < n_; ++i) {
        next.darboux[i] =
            chain.darboux[i] + 1 / lengths_[i] * Vec(load3(&change_[3 + 3 * i]));
      }
      const double then = squares(next);
      if (!(then < now)) continue;
      const bool gained = then < (1 - enough_gain) * now;
      chain = std::move(next);
      now = then;
      damping /= 8;
      return gained;
    }
    return false;
  }

 private:
  double scale(std::size_t i, std::size_t g) const {
    return std::sqrt(gauss_weight[g] * lengths_[i] / length_) / length_;
  }
  double mean_length(std::size_t i) const { return (lengths_[i] + lengths_[i + 1]) / 2; }
  void add_weights(const HelixChain& chain, std::size_t i, std::vector<double>& rows) {
    const std::size_t own = 3 + 3 * i, used = std::min(own + 6, 3 + 3 * n_);
    std::fill_n(rows.begin(), used, 0.0);
    const double twist = std::sqrt(weights_.twist), jump = std::sqrt(weights_.jump);
    rows[own] = twist;
    normal_.add(&rows[0], own + 1, twist * lengths_[i] * chain.darboux[i].x);
    rows[own] = 0;
    if (i + 1 == n_) return;
    const double before = jump * mean_length(i) / lengths_[i];
    const double after = jump * mean_length(i) / lengths_[i + 1];
    const Vec r = mean_length(i) * (chain.darboux[i + 1] - chain.darboux[i]);
    const double of[3] = {r.x, r.y, r.z};
    for (std::size_t c = 0; c < 3; ++c) {
      rows[own + c] = -before;
      rows[own + 3 + c] = after;
      normal_.add(&rows[0], used, jump * of[c]);
      rows[own + c] = rows[own + 3 + c] = 0;
    }
  }

  std::size_t n_;
  FitWeights weights_;
  double length_;
  std::vector<double> lengths_, change_;
  std::vector<Vec> targets_;
  Normal normal_;
};

/// The twistless frames of the curve, as turns summed over each element.
HelixChain along(const SpaceCurve& curve, std::span<const double> joints) {
  HelixChain chain;
  chain.place = curve.position(0);
  chain.joint.assign(joints.begin(), joints.end());
  chain.darboux.resize(joints.size() - 1);
  const Vec start = curve.tangent(0);
  const Vec aside = std::abs(start.z) < 0.9 ? Vec{0, 0, 1} : Vec{1, 0, 0};
  chain.root = frame_of(start, across(start, aside));
  Frame frame = chain.root;
  const std::span<const double> u = curve.parameters(), s = curve.arcs();
  Vec x = chain.place;
  std::size_t element = 0;
  for (std::size_t i = 1; i < u.size(); ++i) {
    const Vec y = curve.position(u[i]);
    const Frame next = carried(frame, y - x, curve.tangent(u[i]));
    const double middle = 0.5 * (s[i - 1] + s[i]);
    while (element + 2 < joints.size() && joints[element + 1] < middle) ++element;
    const double l = joints[element + 1] - joints[element];
    chain.darboux[element] =
        chain.darboux[element] + 1 / l * rotation_between(frame, next);
    frame = next;
    x = y;
  }
  return chain;
}

}  // namespace

std::vector<double> turning(const SpaceCurve& curve) {
  std::vector<double> sum{0};
  const std::span<const double> u = curve.parameters();
  Vec before = curve.tangent(u[0]);
  for (std::size_t i = 1; i < u.size(); ++i) {
    const Vec after = curve.tangent(u[i]);
    sum.push_back(sum.back() +
                  std::atan2(norm(cross(before, after)), dot(before, after)));
    before = after;
  }
  return sum;
}

int elements_by_turning(double turning, double tolerance) {
  constexpr double most = 1e6;
  const double n = 1 + std::ceil(turning * std::sqrt(0.02 / tolerance));
  return n > 2 ? static_cast<int>(std::min(n, most)) : 2;
}

std::vector<double> cut_by_turning(const SpaceCurve& curve,
                                   std::span<const double> turning, int n) {
  const std::span<const double> s = curve.arcs();
  const double whole = turning.back() > 0 ? turning.back() : 1;
  const double half = turning.back() > 0 ? 0.5 : 1;
  const auto share = [&](std::size_t i) {
    return half * s[i] / s.back() + (1 - half) * turning[i] / whole;
  };
  std::vector<double> joints{0};
  std::size_t i = 1;
  for (int k = 1; k < n; ++k) {
    const double wanted = static_cast<double>(k) / n;
    while (i + 1 < s.size() && share(i) < wanted) ++i;
    const double low = share(i - 1), high = share(i);
    joints.push_back(std::lerp(s[i - 1], s[i], (wanted - low) / (high - low)));
  }
  joints.push_back(s.back());
  return joints;
}

std::vector<double> cut_equally(double length, int n) {
  std::vector<double> joints;
  for (int k = 0; k <= n; ++k) joints.push_back(length * k / n);
  return joints;
}

HelixChain fit_helices(const SpaceCurve& curve, std::span<const double> joints,
                       const FitWeights& weights) {
  HelixChain chain = along(curve, joints);
  HelixFitting fitting(curve, joints, weights);
  double now = fitting.squares(chain), damping = 1e-3;
  for (int k = 0; k < most_fit_steps && fitting.step(chain, now, damping); ++k) {
  }
  return chain;
}

double misfit(const SpaceCurve& curve, const HelixChain& chain) {
  return HelixFitting(curve, chain.joint, {}).squares(chain);
}

std::vector<Vec> places_on(const HelixChain& chain, std::span<const double> arcs) {
  std::vector<Vec> places;
  Vec x = chain.place;
  Frame frame = chain.root;
  std::size_t i = 0;
  for (const double s : arcs) {
    while (i + 1 < chain.darboux.size() && s > chain.joint[i + 1]) {
      const HelixPlace tip(chain.darboux[i], chain.joint[i + 1] - chain.joint[i]);
      x = x + frame * tip.place();
      frame = frame * tip.frame();
      ++i;
    }
    places.push_back(x +
                     frame * HelixPlace(chain.darboux[i], s - chain.joint[i]).place());
  }
  return places;
}

FitError distance(const SpaceCurve& curve, const HelixChain& chain, Between between) {
  const std::size_t n = curve.knots().size();
  std::vector<double> arcs;
  for (std::size_t i = 0; i < n; ++i) arcs.push_back(curve.arc_of_point(i));
  std::vector<Vec> places = places_on(chain, between == Between::helices
                                                 ? std::span<const double>(arcs)
                                                 : std::span<const double>(chain.joint));
  if (between == Between::edges) {
    const std::vector<Vec> nodes = std::move(places);
    places.clear();
    std::size_t k = 0;
    for (const double s : arcs) {
      while (k + 2 < nodes.size() && s > chain.joint[k + 1]) ++k;
      const double part = (s - chain.joint[k]) / (chain.joint[k + 1] - chain.joint[k]);
      places.push_back((1 - part) * nodes[k] + part * nodes[k + 1]);
    }
  }
  FitError error;
  double before = 0, integral = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec d = places[i] - curve.position(curve.knots()[i]);
    const double square = dot(d, d);
    error.largest = std::max(error.largest, std::sqrt(square));
    if (i > 0) integral += 0.5 * (arcs[i] - arcs[i - 1]) * (before + square);
    before = square;
  }
  error.rms = std::sqrt(integral / curve.length());
  return error;
}

}  // namespace tress::simulation
