#include "experiments/statics/equilibrium_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "experiments/statics/path_newton.h"

namespace tress::experiments::statics {
namespace {

using Eigen::Index;

constexpr double least_step = 1e-7;   // of the first one
constexpr double least_cosine = 0.9;  // between tangents of successive points
constexpr double located = 1e-7;      // of the step, of a limit point or bifurcation
constexpr double apart = 1e-3;        // of the step, between different bifurcations
constexpr int most_probes = 40, most_crossings = 4;
/// Of a step, between a point and the chord that passes it. A chord is off the path by an
/// eighth of a step times the angle between tangents, acos(least_cosine) at most: 0.056.
constexpr double passed_by = 0.06;
constexpr double first_branch_step = 0.02, usual_iterations = 6;

/// A point with all that its neighbours need.
struct Station {
  PathPoint point;
  Direction tangent;
  std::vector<double> memory;
};

class Follower {
 public:
  Follower(StaticStrand& strand, const PathOptions& options)
      : strand_(strand), options_(options), newton_(strand) {}

  std::vector<PathPoint> follow() {
    try {
      Station station = start();
      add(station.point);
      begin_branch(station);
      step_ = longest_step(station);
      shortest_ = least_step * step_;
      while (!over_) station = next(std::move(station));
      say_what_is_missing();
    } catch (const std::runtime_error& error) {
      fail(error.what());
    }
    return std::move(all_);
  }

 private:
  double range() const { return strand_.varied().range(); }
  int neutral_modes() const { return static_cast<int>(newton_.neutral.cols()); }

  static Balance along(const Balance& from, const Direction& d, double s) {
    return {from.q + s * d.q, from.lambda, from.value + s * d.value};
  }

  void fail(const std::string& why) {
    PathPoint point;
    point.event = Event::end;
    point.at.value = all_.empty() ? strand_.varied().from : all_.back().at.value;
    point.failure = why;
    all_.push_back(std::move(point));
    over_ = true;
  }
  /// A row with the reason, where a path ends before what was asked for.
  void say_what_is_missing() {
    const PathPoint& last = all_.back();
    if (!last.failure.empty() || last.event == Event::end ||
        last.event == Event::closed) {
      if (bifurcations_ >= std::abs(options_.branch) || !last.failure.empty()) return;
      fail("the path has " + std::to_string(bifurcations_) +
           (bifurcations_ == 1 ? " bifurcation" : " bifurcations") +
           ", and branch asks for number " + std::to_string(std::abs(options_.branch)));
    } else if (std::ssize(all_) >= options_.points) {
      fail("the largest number of points, before the end of the range; give more points");
    }
  }
  void add(const PathPoint& point) {
    all_.push_back(point);
    if (std::ssize(all_) >= options_.points) over_ = true;
  }

  Station start() {
    Balance at = strand_.start();
    newton_.neutral = stability(strand_, at).neutral;
    const Newton newton = newton_.correct(at, newton_.fixed(), at);
    if (!newton.converged) {
      throw std::runtime_error("no equilibrium at the first value of the parameter");
    }
    strand_.accept(at);
    Station first{measured_point(strand_, at, newton, -1), {}, strand_.memory()};
    first.point.event = Event::start;
    newton_.neutral = first.point.stability.neutral;
    first.tangent = newton_.tangent(
        at, {Eigen::VectorXd::Zero(at.q.size()), strand_.varied().direction() * range()});
    return first;
  }

  double longest_step(const Station& from) {
    const std::vector<double> u = strand_.displacements(from.point.at, from.tangent.q);
    double fastest = 0;
    for (std::size_t i = 0; i < u.size(); i += 3) {
      fastest = std::max(fastest, norm(load3(&u[i])));
    }
    return options_.resolution /
           std::max(fastest / strand_.length(), std::abs(from.tangent.value) / range());
  }

  /// Points from here on belong to one branch.
  void begin_branch(const Station& first) {
    branch_first_ = {first.point.at, first.tangent};
    may_close_ = false;
  }
  /// Whether the path passes the first point of its branch between two points.
  bool closes(const Balance& from, const Balance& to) {
    const Direction chord{to.q - from.q, to.value - from.value};
    const Balance& first = branch_first_->first;
    Direction off{first.q - from.q, first.value - from.value};
    const double square = newton_.product(chord, chord);
    const double part = newton_.product(off, chord) / square;
    off.q -= part * chord.q;
    off.value -= part * chord.value;
    const bool passes = part >= 0 && part < 1 &&
                        newton_.product(chord, branch_first_->second) > 0 &&
                        newton_.product(off, off) <= passed_by * passed_by * square;
    // The first step begins at that point.
    const bool may = std::exchange(may_close_, true);
    return passes && may;
  }

  /// The point at a step s from a station; none: it is no equilibrium.
  std::optional<Station> probe(const Station& from, double s) {
    strand_.recall(from.memory);
    Balance at = along(from.point.at, from.tangent, s);
    const Newton newton = newton_.correct(at, newton_.row(from.tangent), at);
    if (!newton.converged) return {};
    Station found{measured_point(strand_, at, newton, neutral_modes()), {}, {}};
    if (!found.point.failure.empty()) {
      why_ = found.point.failure;
      return {};
    }
    found.tangent = newton_.tangent(at, from.tangent);
    found.point.arclength = from.point.arclength + s;
    return found;
  }

  /// One step, halved until it succeeds.
  Station next(Station from) {
    if (options_.over()) {
      fail("the time for the path is over");
      return from;
    }
    step_ = std::min(step_, longest_step(from));
    why_ = "no equilibrium was found near the last one";
    for (;; step_ /= 2) {
      if (step_ < shortest_) {
        fail("the step vanishes: " + why_);
        return from;
      }
      try {
        std::optional<Station> to = probe(from, step_);
        if (!to || newton_.product(from.tangent, to->tangent) < least_cosine) continue;
        const Stability& now = to->point.stability;
        if (!now.apart ||
            (now.lifted > 0 && now.negative != from.point.stability.negative)) {
          why_ = "neutral modes and others change their stiffness at once";
          continue;
        }
        auto events = events_between(from, *to, step_);
        if (events) return arrive(from, std::move(*to), std::move(*events));
      } catch (const std::runtime_error& error) {
        why_ = error.what();
      }
    }
  }

  Station arrive(const Station& from, Station to, std::vector<Station> events) {
    const Balance raw = to.point.at;
    const double end = end_between(from.point.at.value, raw.value);
    for (Station& event : events) {
      const double value = event.point.at.value;
      if (std::isfinite(end) && (value - end) * (raw.value - end) > 0) continue;
      add(event.point);
      if (event.point.event == Event::limit_point) {
        ++limit_points_;
        if (limit_points_ == options_.limit_points) over_ = true;
        if (over_) return to;
        continue;
      }
      ++bifurcations_;
      if (bifurcations_ == std::abs(options_.branch)) return leave(from, event);
    }
    if (std::isfinite(end)) return finish(from, raw, end);
    if (closes(from.point.at, raw)) {
      to.point.event = Event::closed;
      over_ = true;
    }
    strand_.recall(from.memory);
    static_cast<void>(strand_.residual(raw));
    count_lifted(to.point);
    strand_.accept(to.point.at);
    to.memory = strand_.memory();
    newton_.neutral = to.point.stability.neutral;
    to.tangent = newton_.tangent(to.point.at, to.tangent);
    add(to.point);
    const double ease = std::sqrt(usual_iterations / std::max(1, to.point.iterations));
    step_ *= std::clamp(ease, 0.5, 1.5);
    return to;
  }

  /// Counts modes that a load has lifted among those that are not neutral.
  void count_lifted(PathPoint& point) {
    const int lifted = point.stability.lifted;
    if (lifted > 0) {
      point.stability = stability(strand_, point.at, neutral_modes() - lifted);
    }
  }

  /// The end of the range that lies between two values; NaN: none.
  double end_between(double before, double after) const {
    const Varied& of = strand_.varied();  // supports rest before their first row
    const double ahead = of.direction();
    const double first =
        of.from - (of.kind == Varied::Kind::supports ? 0 : ahead * range());
    if (ahead * after >= ahead * of.to && ahead * before < ahead * of.to) return of.to;
    if (ahead * after <= ahead * first && ahead * before > ahead * first) return first;
    return std::nan("");
  }

  /// The equilibrium at the end of the range.
  Station finish(const Station& from, const Balance& beyond, double end) {
    over_ = true;
    strand_.recall(from.memory);
    const double part =
        (end - from.point.at.value) / (beyond.value - from.point.at.value);
    Balance at{from.point.at.q + part * (beyond.q - from.point.at.q), beyond.lambda, end};
    const Newton newton = newton_.correct(at, newton_.fixed(), at);
    if (!newton.converged) {
      fail("no equilibrium at the last value of the parameter");
      return from;
    }
    Station last{measured_point(strand_, at, newton, neutral_modes()), {}, {}};
    count_lifted(last.point);
    last.point.event = Event::end;
    last.point.arclength = from.point.arclength + part * step_;
    add(last.point);
    return last;
  }

  /// Goes from a bifurcation a little along the mode that loses its stiffness.
  Station leave(const Station& from, const Station& event) {
    const Stability& critical = event.point.stability;
    if (critical.shapes.cols() == 0) {
      fail(
          "the other branch is not known: no mode of the bifurcation was found, as for "
          "loads that follow the strand");
      return from;
    }
    Index least = 0;
    critical.values.cwiseAbs().minCoeff(&least);
    Direction mode{critical.shapes.col(least), 0};
    mode.q *= (options_.branch > 0 ? 1 : -1) / std::sqrt(newton_.product(mode, mode));
    strand_.recall(from.memory);
    for (double s = first_branch_step; s > shortest_; s /= 2) {
      Balance at = along(event.point.at, mode, s);
      Newton newton = newton_.correct(at, newton_.row(mode), at);
      if (!newton.converged) continue;
      strand_.accept(at);
      Station on{measured_point(strand_, at, newton, -1), {}, strand_.memory()};
      newton_.neutral = on.point.stability.neutral;
      on.point.event = Event::branch;
      on.point.arclength = event.point.arclength + s;
      on.tangent = newton_.tangent(at, mode);
      add(on.point);
      begin_branch(on);
      step_ = s;
      return on;
    }
    fail("no equilibrium was found on the other branch of the bifurcation");
    return from;
  }

  /// s in (0, to) where f of the point at s vanishes, and that point: Illinois.
  template <class F>
  std::optional<std::pair<double, Station>> zero_of(const Station& from, double to,
                                                    double f_from, double f_to, F f) {
    double a = 0, b = to;
    std::optional<std::pair<double, Station>> best;
    for (int i = 0; i < most_probes && std::abs(b - a) > located * to; ++i) {
      const double s = i % 5 == 4 ? (a + b) / 2 : b - f_to * (b - a) / (f_to - f_from);
      std::optional<Station> there = probe(from, s);
      if (!there) return {};
      const double f_s = f(*there), moved = std::abs(s - b);
      best.emplace(s, std::move(*there));
      if (f_s == 0 || moved <= located * to) break;
      if ((f_s < 0) == (f_to < 0)) {
        f_from /= 2;
      } else {
        a = b;
        f_from = f_to;
      }
      b = s;
      f_to = f_s;
    }
    return best;
  }

  /// None: the step is too long to tell them apart.
  std::optional<std::vector<Station>> events_between(const Station& from,
                                                     const Station& to, double s) {
    std::vector<std::pair<double, Station>> found;
    const double before = from.tangent.value, after = to.tangent.value;
    std::optional<double> limit;
    if (before * after < 0) {
      auto at = zero_of(from, s, before, after,
                        [](const Station& there) { return there.tangent.value; });
      if (!at) return {};
      limit = at->first;
      at->second.point.event = Event::limit_point;
      at->second.point.crossing = 1;
      found.push_back(std::move(*at));
    }
    std::vector<std::pair<double, Station>> crossings;
    const auto& old_values = from.point.stability.values;
    const auto& new_values = to.point.stability.values;
    const auto [few, many] =
        std::minmax(from.point.stability.negative, to.point.stability.negative);
    if (many - few > most_crossings) {
      why_ = fmt::format("{} eigenvalues cross 0 at once, as where a strand is taut",
                         many - few);
      return {};
    }
    for (Index j = few; j < many; ++j) {
      auto at = zero_of(from, s, old_values[j], new_values[j], [j](const Station& there) {
        return there.point.stability.values[j];
      });
      if (!at) return {};
      crossings.push_back(std::move(*at));
    }
    // The eigenvalue that vanishes at the limit point.
    if (limit && !crossings.empty()) {
      crossings.erase(std::ranges::min_element(
          crossings, {}, [&](const auto& one) { return std::abs(one.first - *limit); }));
    }
    for (auto& one : crossings) {
      one.second.point.event = Event::bifurcation;
      one.second.point.crossing = 1;
      const bool same = !found.empty() &&
                        found.back().second.point.event == Event::bifurcation &&
                        std::abs(found.back().first - one.first) < apart * s;
      if (same) {
        ++found.back().second.point.crossing;
      } else {
        found.push_back(std::move(one));
      }
    }
    std::ranges::sort(found, {}, [](const auto& one) { return one.first; });
    std::vector<Station> all;
    for (auto& one : found) all.push_back(std::move(one.second));
    return all;
  }

  StaticStrand& strand_;
  const PathOptions& options_;
  PathNewton newton_;
  std::vector<PathPoint> all_;
  double step_ = 0, shortest_ = 0;
  std::optional<std::pair<Balance, Direction>> branch_first_;
  bool may_close_ = false;
  int bifurcations_ = 0, limit_points_ = 0;
  std::string why_;  // the last step failed
  bool over_ = false;
};

}  // namespace

std::vector<PathPoint> equilibrium_path(StaticStrand& strand,
                                        const PathOptions& options) {
  return Follower(strand, options).follow();
}

}  // namespace tress::experiments::statics
