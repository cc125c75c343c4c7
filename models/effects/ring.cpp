#include "models/effects/ring.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "math/mat3.h"
#include "math/vec3.h"
#include "models/motion/signals.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_ring[] = {
    {.name = "keyframes",
     .help =
         "rows of t, x, y, z (s, m): places of the ring in the world, t ascending. It "
         "moves in straight lines, quintic in time, and rests at each. One row: a "
         "fixed place",
     .min = -1e6,
     .max = 1e6,
     .components = 4,
     .rows = true,
     .fallback = "0,0,0,0"},
    {.name = "stiffness_n_per_m",
     .help = "force over the distance of the strand from the ring (N/m)",
     .number = 1,
     .min = 1e-12,
     .max = 1e12},
    {.name = "damping_n_s_per_m",
     .help = "force over the velocity across the strand, relative to the ring (N s/m)",
     .number = 0,
     .min = 0,
     .max = 1e12}};

/// Newton's method for s*, and steps to a neighbouring interval, end after this number.
constexpr int most_iterations = 30;
/// An s* that moves less than this part of the length is found.
constexpr double found = 1e-14;
/// The tangent leaves out the motion of s* where the strand curves about the ring more
/// closely than this part of the radius of curvature allows.
constexpr double least_slope = 0.05;

RootMotion path_of(In rows) {
  std::vector<double> t, x[3];
  for (std::size_t i = 0; i + 3 < rows.size(); i += 4) {
    t.push_back(rows[i]);
    refuse_if(
        t.size() > 1 && !(t.back() > t[t.size() - 2]),
        "keyframe " + std::to_string(t.size()) + " is not later than the one before",
        "effect ring", "give each a later time than the one before");
    for (std::size_t k = 0; k < 3; ++k) x[k].push_back(rows[i + 1 + k]);
  }
  refuse_if(t.empty(), "a ring without a place", "effect ring",
            "give keyframes, such as [[0, 0.05, 0, 0]]");
  RootMotion path;
  path.position = {x[0][0], x[1][0], x[2][0]};
  constexpr Vec axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t k = 0; k < 3 && t.size() > 1; ++k) {
    std::vector<double> ways = x[k];
    for (double& way : ways) way -= x[k][0];
    path.translations.push_back({axes[k], rests(t, ways)});
  }
  return path;
}

/// Whether point i and the one after it are neighbours on the strand. Points that only
/// fill a pack carry no length.
bool joined(const Points& p, std::size_t i) {
  return p.length[i] > 0 && p.length[i + 1] > 0 && p.arc[i] < p.arc[i + 1];
}

}  // namespace

std::span<const Parameter> ring_parameters() { return parameters_of_ring; }

std::unique_ptr<const Effect> make_ring(const Parameters& parameters, const RootMotion&) {
  return std::make_unique<Ring>(Ring::Settings{parameters.number("stiffness_n_per_m"),
                                               parameters.number("damping_n_s_per_m"),
                                               path_of(parameters.numbers("keyframes"))});
}

Ring::Ring(Settings settings) : s_(std::move(settings)) {
  refuse_if(!(s_.stiffness > 0) || !(s_.damping >= 0) ||
                !std::isfinite(s_.stiffness + s_.damping),
            "the stiffness is not above 0, or the damping is negative", "effect ring",
            "give stiffness_n_per_m > 0 and damping_n_s_per_m >= 0");
  check(s_.path, "effect ring");
}

/// Weights of the points around an interval at s, and the place there.
Ring::Inside Ring::at(double s, std::size_t interval, const Vec& ring,
                      const Points& p) const noexcept {
  Inside in;
  in.s = s;
  std::size_t first = interval, last = std::min(interval + 1, p.arc.size() - 1);
  // Neighbours on both sides; at an end, two on the other side.
  const auto extend = [&](bool back) {
    if (back && first > 0 && joined(p, first - 1)) --first;
    if (!back && last + 1 < p.arc.size() && joined(p, last)) ++last;
  };
  extend(true);
  extend(false);
  if (last - first < 3) extend(true);
  if (last - first < 3) extend(false);
  in.first = first;
  in.count = last - first + 1;
  in.d = -1.0 * ring;
  for (std::size_t j = 0; j < in.count; ++j) {
    // Product of (s - s_m)/(s_j - s_m) with its first and second derivatives.
    double value = 1, slope = 0, curve = 0;
    for (std::size_t m = 0; m < in.count; ++m) {
      if (m == j) continue;
      const double scale = 1 / (p.arc[first + j] - p.arc[first + m]),
                   factor = (s - p.arc[first + m]) * scale;
      curve = curve * factor + 2 * slope * scale;
      slope = slope * factor + value * scale;
      value *= factor;
    }
    const Vec x = load3(&p.x[3 * (first + j)]);
    in.weight[j] = value;
    in.slope[j] = slope;
    in.d = in.d + value * x;
    in.tangent = in.tangent + slope * x;
    in.second = in.second + curve * x;
  }
  in.curvature = dot(in.d, in.second);
  return in;
}

Ring::Inside Ring::inside(double t, const Points& p) const noexcept {
  const Vec ring = s_.path.at(t).x;
  const std::size_t count = p.arc.size();
  // The nearest chord.
  double least = std::numeric_limits<double>::infinity(), s = p.arc[0];
  std::size_t interval = 0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    if (!joined(p, i)) continue;
    const Vec x = load3(&p.x[3 * i]), chord = load3(&p.x[3 * i + 3]) - x;
    const double square = dot(chord, chord);
    const double part =
        square > 0 ? std::clamp(dot(ring - x, chord) / square, 0.0, 1.0) : 0;
    const double distance = norm(x + part * chord - ring);
    if (!(distance < least)) continue;
    least = distance;
    interval = i;
    s = std::lerp(p.arc[i], p.arc[i + 1], part);
  }
  Inside in = at(s, interval, ring, p);
  if (in.count < 2) {
    in.at_end = true;
    return in;
  }
  int turned = 0;  // 1: on to the next interval, without a way; -1: back
  for (int k = 0; k < most_iterations; ++k) {
    const double slope = dot(in.tangent, in.tangent) + in.curvature;
    // Where the distance has no minimum nearby, along the strand towards the ring.
    const double step = -dot(in.d, in.tangent) /
                        std::max(slope, least_slope * dot(in.tangent, in.tangent));
    const bool begins = interval == 0 || !joined(p, interval - 1),
               ends = interval + 2 >= count || !joined(p, interval + 1);
    const double low = begins ? 0 : p.arc[interval],
                 high = ends ? p.longest : p.arc[interval + 1];
    const double next = std::clamp(in.s + step, low, high);
    const bool moved = std::abs(next - in.s) > found * p.longest;
    const bool on = in.s + step > high && !ends, back = in.s + step < low && !begins;
    in = at(next, interval, ring, p);
    const int turns = moved ? 0 : on ? 1 : back ? -1 : 0;
    if (turns != 0 && turns == -turned) {  // away from the point on neither side
      if (back) in = at(next, --interval, ring, p);
      in.at_point = true;
      break;
    }
    turned = turns;
    in.at_end = (begins && next == low) || (ends && next == high);
    if (!moved && !on && !back) break;
    if (on) in = at(next, ++interval, ring, p);
    if (back) in = at(next, --interval, ring, p);
  }
  return in;
}

/// Velocity of the material relative to the ring.
Vec Ring::relative(double t, const Points& p, const Inside& in) const noexcept {
  Vec u = -1.0 * s_.path.at(t).v;
  for (std::size_t j = 0; j < in.count; ++j) {
    u = u + in.weight[j] * load3(&p.v[3 * (in.first + j)]);
  }
  return u;
}

/// Its part across the strand; at an end all components.
Vec Ring::slip(double t, const Points& p, const Inside& in) const noexcept {
  const Vec u = relative(t, p, in);
  const double square = dot(in.tangent, in.tangent);
  if (in.at_end || square == 0) return u;
  return u - (dot(u, in.tangent) / square) * in.tangent;
}

Vec Ring::force(double t, const Points& p, const Inside& in) const noexcept {
  const Vec spring = -s_.stiffness * in.d;
  return s_.damping > 0 ? spring - s_.damping * slip(t, p, in) : spring;
}

void Ring::add_load(double t, const Points& p, InOut f) const noexcept {
  const Inside in = inside(t, p);
  const Vec all = force(t, p, in);
  for (std::size_t j = 0; j < in.count; ++j) {
    double* const load = &f[3 * (in.first + j)];
    store3(load3(load) + in.weight[j] * all, load);
  }
}

/// The force at fixed s*, and its change with s*, -k (d w_j' + x' w_j) ds*. With F =
/// d.x'(s) = 0, ds* = -(w_l x' + w_l' d).dx_l/(x'.x' + d.x'').
/// The damper adds -c (w_j' P u ds* + w_j d(P u)). With q = x'.x',
///
///     d(P u) = P v' ds* - G dx',   dx' = w_l' dx_l + x'' ds*,
///     G = (x'.u I + x' u^T - 2 x'.u x' x'^T/q)/q.
Coupling Ring::coupling(double t, const Points& p, const Inside& in) const noexcept {
  const Vec axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double square = dot(in.tangent, in.tangent), slope = square + in.curvature;
  const bool slides = !in.at_end && !in.at_point && slope > least_slope * square;
  const bool projects = !in.at_end && square > 0;
  const auto across = [&](const Vec& x) {
    return projects ? x - (dot(x, in.tangent) / square) * in.tangent : x;
  };
  const bool damps = s_.damping > 0;
  const Vec u = damps ? relative(t, p, in) : Vec{};
  const double along_u = projects ? dot(u, in.tangent) / square : 0;
  // Row r of G.
  const auto turning = [&](std::size_t r) {
    const double component = dot(axes[r], in.tangent) / square;
    return along_u * axes[r] + component * (u - (2 * along_u) * in.tangent);
  };
  // -c d(P u)/ds*, and what f adds to d with the weights' change.
  Vec by_sliding, held = in.d;
  if (damps && slides) {
    for (std::size_t j = 0; j < in.count; ++j) {
      by_sliding = by_sliding -
                   (s_.damping * in.slope[j]) * across(load3(&p.v[3 * (in.first + j)]));
    }
    for (std::size_t r = 0; r < 3; ++r) {
      by_sliding = by_sliding + (s_.damping * dot(turning(r), in.second)) * axes[r];
    }
    held = held + (s_.damping / s_.stiffness) * across(u);
  }
  Coupling made;
  for (std::size_t j = 0; j < made.ends.size(); ++j) {
    Coupling::End& end = made.ends[j];
    // Points that are not there repeat the last one, without a share.
    end.point = in.first + std::min(j, in.count - 1);
    const double w = j < in.count ? in.weight[j] : 0,
                 by_s = j < in.count ? in.slope[j] : 0;
    const Vec along = w * in.tangent + by_s * in.d;
    for (std::size_t r = 0; r < 3; ++r) {
      end.onto[r] = w * axes[r];
      end.by_place[r] = (-s_.stiffness * w) * axes[r];
      end.by_velocity[r] = (-s_.damping * w) * across(axes[r]);
      if (!damps || !projects) continue;
      end.by_place[r] = end.by_place[r] + (s_.damping * by_s) * turning(r);
      if (!slides) continue;
      end.by_place[r] = end.by_place[r] - (dot(axes[r], by_sliding) / slope) * along;
    }
    if (!slides) continue;
    end.onto[3] = w * in.tangent + by_s * held;
    end.by_place[3] = (s_.stiffness / slope) * along;
  }
  return made;
}

void Ring::add_couplings(double t, const Points& p, std::vector<Coupling>& all) const {
  all.push_back(coupling(t, p, inside(t, p)));
}

void Ring::add_derivatives(double t, const Points& p, double pos, double vel,
                           InOut blocks) const noexcept {
  const Inside in = inside(t, p);
  const Coupling all = coupling(t, p, in);
  for (std::size_t j = 0; j < in.count; ++j) {
    all.add_block(j, j, pos, vel, &blocks[9 * (in.first + j)]);
  }
}

double Ring::potential(double t, const Points& p) const noexcept {
  const Inside in = inside(t, p);
  return s_.stiffness / 2 * dot(in.d, in.d);
}

double Ring::power(double t, const Points& p) const noexcept {
  const Inside in = inside(t, p);
  const Vec moves = s_.path.at(t).v;
  double sum = -s_.stiffness * dot(in.d, moves);
  if (s_.damping == 0) return sum;
  return sum - s_.damping * dot(slip(t, p, in), relative(t, p, in) + moves);
}

}  // namespace tress::models
