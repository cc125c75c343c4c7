// A rope over a fixed cylinder, half a turn of it, pulled down at both ends: it slides
// when one pull exceeds the other by more than e^(mu phi) [Euler 1769; Eytelwein 1808].
//
// Its natural shape is that of the cylinder, so that bending carries nothing. A polyline
// with a contact at each of its vertices slides at the product of (1 + mu tan(d/2))/(1 -
// mu tan(d/2)) over its turns d, which exceeds e^(mu phi) by the square of a turn: at 16
// turns and mu = 0.3, by 0.3 %. The cylinder yields by 1e-4 of its radius. The least
// ratio that slides is found by bisection to 0.1 %, beside the polygon's to 0.01 %. A
// drum that turns slips under the rope at any ratio, and the same ratio is the one at
// which the rope stays.
//
// A heavy rope without pulls slides where the part that hangs down on one side has become
// long enough: with T the tension, w the weight per length and theta the angle from the
// top, dT/dtheta = mu (T + w R cos) - w R sin on the point of sliding, so that of hanging
// lengths a and b = a e^(mu pi) + 2 mu R/(1 + mu^2) (1 + e^(mu pi)).
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/numerics.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/test.h"
#include "models/effects/exact_body.h"
#include "models/effects/tether.h"

namespace tress::experiments::validation {
namespace {

constexpr double wrapped = std::numbers::pi;  // phi, rad
// A sixth of the strand hangs at either side.
const double rope_length = TestRod().length, radius = rope_length / (1.5 * wrapped),
             tail = rope_length / 6;
const double away = 0.02 * rope_length;  // a strand that has moved so far slides
// The same where 0.1 % is asked: still four times what the pulls stretch the rope by.
const double a_little_away = 0.004 * rope_length;

/// Up at one side, along which `hangs` of it hang, over the cylinder about y, down at the
/// other.
Strand rope(int elements, double hangs) {
  TestRod rod;
  const double end = hangs + wrapped * radius;
  rod.natural = [hangs, end](double s) {
    return s < hangs || s > end ? Vec{} : Vec{0, 1 / radius, 0};
  };
  Strand strand = rod.strand(elements, standing_clamp());
  strand.free_root = FreeRoot{{-radius, 0, -hangs}, standing_clamp(), {}, {}};
  return strand;
}

/// The cylinder, which yields by 1e-4 of its radius under the pull of a rope. It turns at
/// `rate` (rad/s) about y: at its top, against x.
std::shared_ptr<const Effect> cylinder(const ContactRun& run, const Strand& strand,
                                       double pulled, double friction, double rate = 0) {
  const double thick = strand.segments.front().section.a1, depth = 1e-4 * radius;
  const NormalContact normal{.stiffness = pulled / radius / depth, .offset = thick};
  // The capsule's axis is z of its frame.
  const StrandPlace axis{{}, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
  const ExactContact law{normal, run.is_rigid(false), friction};
  const Capsule capsule{radius - thick, radius};
  if (rate == 0) return std::make_shared<ExactBody>(capsule, run.place(axis), law);
  RootMotion drum;
  drum.rotations = {{run.turned * Vec{0, -1, 0}, [rate](double t) {
                       return SignalValue{rate * t, rate, 0};
                     }}};
  return std::make_shared<ExactBody>(capsule, run.place(axis), law, drum);
}

/// A strand that has slid is bent where it was straight and straight where it was bent,
/// which takes EI/R^2, 22 EI/L^2: 0.1 % of this. Until its vertices have moved by half an
/// element it takes a share of that in proportion.
const double pull = 20'000 * TestRod().force();

/// How far the rope has moved down at its tip, until it is farther than `distance`. The
/// pulls rise together in a fifth of the time; with 0.01 % more than the strand bears it
/// is `away` in the rest of the time. The cylinder makes `turns` turns in it,
/// towards the root.
double moved(const ModelTrial& trial, const Strand& strand, double ratio, double distance,
             double turns = 0) {
  const ContactRun& run = trial.contact;
  const double t_end = 0.1 / TestRod().rate();
  const double rate = 2 * std::numbers::pi * turns / t_end;
  const auto down = [&](double at, double force) {
    return std::make_shared<Tether>(
        Tether::Settings{.at = at,
                         .pull = force,
                         .target = run.turned * Vec{at > 0 ? radius : -radius, 0, -1e3},
                         .off = 1e6,
                         .ramp = 0.2 * t_end});
  };
  const auto system = on_strand(trial.variant, run.strand(strand),
                                {cylinder(run, strand, pull, trial.parameter, rate),
                                 down(0, pull), down(1, ratio * pull)});
  const double start = -tail;
  const auto gone = [&](double z) { return std::abs(z - start) > distance; };
  const Track tip =
      track(run.integrator, *system, t_end / 100, t_end, run.look(*system, -1, 2), gone);
  return start - tip.value.back();
}

bool slides(const ModelTrial& trial, const Strand& strand, double ratio,
            double distance) {
  return std::abs(moved(trial, strand, ratio, distance)) > distance;
}

double ratio_of(double friction) { return std::exp(friction * wrapped); }

/// The least ratio of pulls at which `slid` is true.
template <class Slid>
double least_ratio(const ModelTrial& trial, const Slid& slid, double width) {
  const double low = ratio_of(trial.parameter) / 1.1,
               high = ratio_of(trial.parameter) * 1.1;
  if (slid(low)) throw std::runtime_error("slides at much less pull");
  if (!slid(high)) throw std::runtime_error("holds against much more pull");
  return threshold(slid, low, high, width);
}

double found_ratio(const ModelTrial& trial, double distance, double width) {
  const Strand strand = rope(trial.elements, tail);
  return least_ratio(
      trial, [&](double ratio) { return slides(trial, strand, ratio, distance); }, width);
}

double measured_ratio(const ModelTrial& trial) { return found_ratio(trial, away, 1e-3); }

/// A drum slips under the rope all the time, so that the pulls balance at one ratio only.
double measured_ratio_on_drum(const ModelTrial& trial) {
  const Strand strand = rope(trial.elements, tail);
  const auto falls = [&](double ratio) {
    return moved(trial, strand, ratio, a_little_away, 1) > a_little_away;
  };
  return least_ratio(trial, falls, 1e-3);
}

/// Two thirds of the elements are on the cylinder; the first and the last of them turn by
/// half as much from the straight tails.
double ratio_of_polygon(double friction, int elements) {
  const double turns = std::round(elements / 1.5);
  const auto at_turn = [&](double angle) {
    const double t = friction * std::tan(angle / 2);
    return (1 + t) / (1 - t);
  };
  const double turn = wrapped / turns;
  return std::pow(at_turn(turn), turns - 1) * std::pow(at_turn(turn / 2), 2);
}

double measured_over_polygon(const ModelTrial& trial) {
  return found_ratio(trial, a_little_away, 1e-4) /
         ratio_of_polygon(trial.parameter, trial.elements);
}

constexpr std::array<std::string_view, 4> smooth = {
    "super_helix", "super_clothoid", "dynamic_spline", "articulated_chain"};

std::string not_a_polygon(const ModelVariant& variant) {
  return std::ranges::find(smooth, variant.model->id) == smooth.end()
             ? ""
             : "it touches the cylinder between its nodes too: no polygon";
}

// A rope so heavy that its bending is 0.1 % of its weight on the cylinder.
const double rope_gravity = TestRod().gravity(20'000);
const double both_hang = rope_length - wrapped * radius;

/// Gravity that begins slowly: at once it lets the rope jump, and slide as it does.
class Weight final : public Effect {
 public:
  Weight(double ramp, const Vec& down) : ramp_(ramp), down_(down) {}
  std::string_view name() const override { return "weight"; }
  Needs needs() const override { return {}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override {
    const double g = rope_gravity * std::fmin(1, t / ramp_);
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      store3(load3(&f[3 * i]) + (p.mass[i] * g) * down_, &f[3 * i]);
    }
  }
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  double ramp_;  // s
  Vec down_;     // of length 1
};

bool slides_by_weight(const ModelTrial& trial, double friction) {
  const ContactRun& run = trial.contact;
  const double hangs = trial.parameter * both_hang;
  const Strand strand = rope(trial.elements, both_hang - hangs);
  const double weight = TestRod().line_mass() * rope_length * rope_gravity;
  const double t_end = 15 * std::sqrt(rope_length / rope_gravity);
  const auto system =
      on_strand(trial.variant, run.strand(strand),
                {std::make_shared<Weight>(0.3 * t_end, run.turned * Vec{0, 0, -1}),
                 cylinder(run, strand, weight / 3, friction)});
  const double start = hangs - both_hang;
  const auto gone = [&](double z) { return std::abs(z - start) > away; };
  const Track root =
      track(run.integrator, *system, t_end / 500, t_end, run.look(*system, 0, 2), gone);
  return gone(root.value.back());
}

/// Share of what hangs on the longer side when it slides.
double longer_share(double friction) {
  const double e = std::exp(friction * wrapped);
  const double more = 2 * friction * radius / (1 + friction * friction) * (1 + e);
  return (both_hang * e + more) / ((1 + e) * both_hang);
}

double holding_friction(double share) {
  return find_root([&](double friction) { return longer_share(friction) - share; }, 0, 1);
}

double measured_friction(const ModelTrial& trial) {
  const auto holds = [&](double friction) { return !slides_by_weight(trial, friction); };
  const double least = holding_friction(trial.parameter);
  const double low = least / 1.2, high = least * 1.2;
  if (holds(low)) throw std::runtime_error("holds with much less friction");
  if (!holds(high)) throw std::runtime_error("slides against much more friction");
  return threshold(holds, low, high, 1e-3);
}

}  // namespace

std::vector<ValidationTest> capstan_tests() {
  const std::vector<std::string_view> claimed = {
      "super_helix",   "super_clothoid", "der",         "corde",
      "xpbd_cosserat", "dynamic_spline", "mass_spring", "inextensible_strand"};
  return {
      {
          .name = "capstan",
          .what =
              "a rope over a cylinder, pulled at both ends, slides at one ratio of pulls",
          .source = "Euler 1769; Eytelwein 1808",
          .parameter = "friction coefficient mu",
          .quantity = "ratio of pulls that slides",
          .range = {0.01, 1},
          .quick = {{0.3}, {24}},
          .usual = {{0.1, 0.3, 0.5}, {12, 24}},
          .full = {{0.1, 0.3, 0.5, 0.7}, {12, 24, 48}},
          .tolerance = 0.01,
          .why =
              "0.3 % of a polyline of 16 turns, 0.1 % of the search, and the cylinder's "
              "yield",
          .judged_from = 24,
          .claimed = claimed,
          .reference = ratio_of,
          .measure = measured_ratio,
      },
      {
          .name = "capstan_drum",
          .what = "a rope over a drum that turns against the larger pull balances at one "
                  "ratio of pulls",
          .source = "Euler 1769; Eytelwein 1808",
          .parameter = "friction coefficient mu",
          .quantity = "ratio of pulls in balance",
          .range = {0.01, 1},
          .quick = {{0.3}, {24}},
          .usual = {{0.1, 0.3}, {12, 24}},
          .full = {{0.1, 0.3, 0.5}, {12, 24, 48}},
          .tolerance = 0.01,
          .why = "that of the cylinder at rest",
          .judged_from = 24,
          .claimed = claimed,
          .reference = ratio_of,
          .measure = measured_ratio_on_drum,
      },
      {
          .name = "capstan_polygon",
          .what = "the same beside the ratio of a polygon with friction at its vertices",
          .source = "balance of a vertex: the product of (1 + mu tan(d/2))/(1 - mu "
                    "tan(d/2)) over turns d",
          .parameter = "friction coefficient mu",
          .quantity = "ratio of pulls that slides over that of the polygon",
          // With more, pulls stretch the rope by as much as counts as sliding.
          .range = {0.01, 0.5},
          .quick = {{0.3}, {24}},
          .usual = {{0.1, 0.3, 0.5}, {24, 48}},
          .full = {{0.1, 0.2, 0.3, 0.4, 0.5}, {24, 36, 48}},
          .tolerance = 1e-3,
          .why = "bending takes a fifth of 0.1 % of the pulls over so short a way, the "
                 "cylinder's yield and the search 0.01 % each",
          .judged_from = 24,
          .claimed = {"der", "corde", "xpbd_cosserat", "mass_spring",
                      "inextensible_strand"},
          .reference = [](double /*friction*/) { return 1.0; },
          .refusal = not_a_polygon,
          .measure = measured_over_polygon,
      },
      {
          .name = "heavy_strand",
          .what = "a heavy rope over a cylinder slides where one side hangs down too far",
          .source = "statics of a heavy rope on a rough cylinder, in closed form",
          .parameter = "share on the longer side of what hangs",
          .quantity = "least friction coefficient that holds",
          .range = {0.51, 0.95},
          // Of eighths, where elements begin and end at the cylinder.
          .quick = {{0.75}, {48}},
          .usual = {{0.625, 0.75}, {24, 48}},
          .full = {{0.625, 0.75, 0.875}, {12, 24, 48, 96}},
          .tolerance = 0.02,
          .why = "0.1 % of the search; nodes round off the two places where the natural "
                 "shape begins to turn, 1 % of 16 turns",
          .judged_from = 48,
          .claimed = claimed,
          .reference = holding_friction,
          .measure = measured_friction,
      }};
}

}  // namespace tress::experiments::validation
