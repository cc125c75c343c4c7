#include "experiments/validation/plectoneme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "contract/input_error.h"
#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/numerics.h"
#include "experiments/validation/rods/rod.h"
#include "models/effects/linear_drag.h"
#include "models/effects/self_contact.h"
#include "models/effects/tether.h"

namespace tress::experiments::validation {
namespace {

using std::numbers::pi;

// Rubber; only T R^2/EI matters.
constexpr double length = 0.5, radius = 5e-4;  // m
constexpr double ply_radius = HeldThread::ply_radius;
constexpr double thread_separation = 0.03;  // m
// At half the speed, or half the step, the angle changes by less than 0.3 %.
constexpr double turning = 2, waiting = 3;  // s
constexpr Material material{
    .density = 1000, .youngs_modulus = 1e6, .shear_modulus = 1e6 / 3};

struct Held {
  int first, corner, tip;  // held nodes of the handle
};

Held handle(int elements) {
  const int n = std::max(4, elements / 25);  // per arm
  if (elements < 10 * n) {
    throw InputError("no room for a handle", "plectoneme", "give 40 or more elements");
  }
  return {elements - 2 * n, elements - n, elements};
}

Strand thread(int elements, double turns) {
  // Slightly bent, so that it bows out to one side.
  Strand strand =
      make_strand(material, {radius, radius}, {.elements = elements, .length = length},
                  uniform_shape({0, 0.01 / length, 0}));
  const Held held = handle(elements);
  const double arm = (held.tip - held.corner) * length / elements;
  for (int i = held.first; i < elements; ++i) {
    Segment& segment = strand.segments[static_cast<std::size_t>(i)];
    segment.section = {4 * radius, 4 * radius};
    segment.natural = segment.initial = i < held.corner ? Vec{} : Vec{0, 0, pi / 2 / arm};
  }
  strand.root.rotations.push_back({{1, 0, 0}, smooth_step(2 * pi * turns, 0, turning)});
  strand.root.translations.push_back(
      {{1, 0, 0}, smooth_step(0.3 * length, turning, turning)});
  return strand;
}

/// Positions of all nodes at the start (m).
std::vector<double> start_places(const ModelVariant& variant, const Strand& strand) {
  const auto system = on_strand(variant, strand, {});
  MaterialPoints& points = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  points.positions(0, initial_state(*system).q, x);
  return x;
}

double measured_angle(const ModelTrial& trial) {
  const HeldThread thread = held_thread(trial.variant, trial.elements, trial.parameter);
  Effects effects;
  for (const HeldThread::Hand& hand : thread.hands) {
    effects.push_back(std::make_shared<Tether>(
        Tether::Settings{.at = static_cast<double>(hand.node) / trial.elements,
                         .stiffness = HeldThread::stiffness,
                         .target = hand.place,
                         .off = 1e9}));
  }
  const ContactLaw law({.stiffness = 200,
                        .viscosity = 1e-3,
                        .inner = 2 * ply_radius,
                        .outer = 2.5 * ply_radius},
                       "plectoneme");
  effects.push_back(std::make_shared<SelfContact>(law, thread_separation));
  effects.push_back(std::make_shared<LinearDrag>(1e-3));
  const auto system = on_strand(trial.variant, thread.strand, effects);

  MaterialPoints& points = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  const Look look = [&](double t, In q, In) {
    if (t >= thread.settled) points.positions(t, q, x);
    return t;
  };
  // One linear solve a step: Newton's iteration does not converge on the snap.
  const Track run = track("linearly_implicit_euler", *system, 2e-3, thread.settled, look,
                          [&](double) { return trial.deadline.passed(); });
  if (run.t.back() < thread.settled) {
    throw std::runtime_error("the time for the row was over");
  }
  return thread.angle_over_equilibrium(x);
}

}  // namespace

HeldThread held_thread(const ModelVariant& variant, int elements, double turns) {
  HeldThread made{thread(elements, turns), {}, 2 * turning + waiting};
  const std::vector<double> x = start_places(variant, made.strand);
  const Held held = handle(elements);
  const int nodes[] = {held.first, held.corner, held.tip};
  for (std::size_t k = 0; k < made.hands.size(); ++k) {
    made.hands[k] = {nodes[k], load3(&x[3 * static_cast<std::size_t>(nodes[k])])};
  }
  return made;
}

Vec HeldThread::pull(const Hand& hand, std::span<const double> x) const {
  return stiffness * (hand.place - load3(&x[3 * static_cast<std::size_t>(hand.node)]));
}

double HeldThread::tension(std::span<const double> x) const {
  double sum = 0;
  for (const Hand& hand : hands) sum += pull(hand, x).x;
  return sum;
}

double HeldThread::moment(std::span<const double> x) const {
  double sum = 0;
  for (const Hand& hand : hands) {
    sum -= cross(load3(&x[3 * static_cast<std::size_t>(hand.node)]), pull(hand, x)).x;
  }
  return sum;
}

double HeldThread::angle_over_equilibrium(std::span<const double> x) const {
  const auto free_points = 3 * static_cast<std::size_t>(hands.front().node);
  const double tension = this->tension(x);
  const Ply found = ply(x.first(free_points), strand.segments.front().length,
                        thread_separation, 2.4 * ply_radius);
  if (found.pairs == 0 || !(tension > 0)) {
    throw std::runtime_error("it makes no plectoneme");
  }
  const double bending = models::stiffness(material, {radius, radius}).y;
  return found.angle / ply_angle(tension * found.radius * found.radius / bending);
}

double ply_angle(double tension) {
  const auto off = [tension](double a) {
    return std::pow(std::sin(a), 4) * (0.5 + 1 / std::cos(2 * a)) - tension;
  };
  return find_root(off, 0, pi / 4 * (1 - 1e-9));
}

Ply ply(std::span<const double> x, double apart, double separation, double reach) {
  std::vector<Vec> middles, tangents;
  std::vector<double> distances;
  const std::size_t count = x.size() / 3;
  const auto far = static_cast<std::size_t>(std::ceil(separation / apart));
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const Vec here = load3(&x[3 * i]);
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t edge_of_it = 0;
    Vec other;
    for (std::size_t j = i + far; j + 1 < count; ++j) {
      // The nearest point of the edge, so that the result is independent of node
      // positions.
      const Vec from = load3(&x[3 * j]), edge = load3(&x[3 * j + 3]) - from;
      const double at = std::clamp(dot(here - from, edge) / dot(edge, edge), 0.0, 1.0);
      const Vec gap = from + at * edge - here;
      const double distance = norm(gap);
      if (distance < nearest) {
        nearest = distance;
        edge_of_it = j;
        other = from + at * edge;
      }
    }
    // At the limit of the range there may be nearer ones: the loop at the end.
    if (nearest > reach || edge_of_it == i + far) continue;
    const Vec tangent = load3(&x[3 * i + 3]) - (i > 0 ? load3(&x[3 * i - 3]) : here);
    middles.push_back(0.5 * (here + other));
    tangents.push_back(tangent);
    distances.push_back(nearest);
  }
  constexpr std::size_t ends = 3;
  Ply all;
  for (std::size_t i = ends; i + ends < middles.size(); ++i) {
    const Vec axis = middles[i + 2] - middles[i - 2], t = tangents[i];
    all.angle += std::acos(
        std::min(1.0, std::abs(dot(axis, t)) / std::sqrt(dot(axis, axis) * dot(t, t))));
    all.radius += distances[i] / 2;
    ++all.pairs;
  }
  if (all.pairs == 0) return all;
  all.angle /= all.pairs;
  all.radius /= all.pairs;
  return all;
}

std::vector<ValidationTest> plectoneme_tests() {
  return {{
      .name = "plectoneme",
      .what = "a twisted thread that is let in winds itself up",
      .source = "Bertails-Descoubes 2010, plectoneme; Clauvelin, Audoly & Neukirch 2009",
      .parameter = "turns of the clamp",
      .quantity = "angle of the plies over that of the equilibrium",
      .range = {4, 30},
      .quick = {{12}, {125}},
      .usual = {{12}, {125}},
      .full = {{11, 12, 13}, {125}},
      .tolerance = 0.05,
      .why = "the tension goes with the fourth power of the angle: 5 % are 20 % of it. A "
             "ply of one turn is not uniform (its ends bend more than its middle) and a "
             "turn has 15 chords",
      .judged_from = 125,
      .claimed = {"der", "corde"},
      .reference = [](double) { return 1.0; },
      .refusal = no_twist,
      // A full matrix of 375 unknowns, factored in every step.
      .slow = {"super_helix", "super_clothoid", "articulated_chain", "force_transport",
               "kirchhoff_nodal"},
      .measure = measured_angle,
  }};
}

}  // namespace tress::experiments::validation
