#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "models/affine_numbers.h"
#include "models/effects/catalogue.h"
#include "models/motion/root_motion.h"
#include "tests/models/effects/cloud.h"
#include "tests/models/effects/sphere_grid.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/support/tested.h"

// What every effect of the catalogue keeps, with every word of every choice.
namespace tress::test_effect_contract {

using namespace models;

using testing_support::as_obj;
using testing_support::as_text;
using testing_support::ball;
using testing_support::Cloud;
using testing_support::derivatives;
using testing_support::load;
using testing_support::sphere_samples;
using testing_support::write_file;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double now = 0.37;  // s, no time at which anything is special

using Settings = std::map<std::string, std::string>;

/// Numbers that make an effect act on a Cloud; an effect that is not here has its
/// defaults.
Settings lively(std::string_view id) {
  if (id == "constant_force")
    return {{"force_n_m", "1,-2,0.5"}, {"force_n_kg", "2,1,-3"}};
  if (id == "linear_drag") return {{"drag_kg_m_s", "0.7"}, {"mass_damping_per_s", "0.4"}};
  if (id == "quadratic_drag") return {{"strand_radius_m", "0.1"}};
  if (id == "wind") {
    return {{"velocity_m_s", "1.5,-0.4,0.7"}, {"frequency_hz", "0.6"},
            {"gust_speed_m_s", "1.1"},        {"gust_length_m", "1.3"},
            {"drag_kg_m_s", "0.7"},           {"force_n_m", "1.7"},
            {"strand_radius_m", "0.1"}};
  }
  if (id == "tether") {
    return {{"at", "0.4"},           {"stiffness_n_m", "30"},
            {"damping_n_s_m", "2"},  {"pull_n", "3"},
            {"soft_m", "0.1"},       {"target_m", "1,0.5,-0.2"},
            {"t_on_s", "0.1"},       {"amplitude_m", "0.3,0,0.1"},
            {"frequency_hz", "0.7"}, {"ramp_s", "0.5"}};
  }
  if (id == "point_force") {
    return {{"at", "0.4"},
            {"force_n", "1,-2,0.5"},
            {"follower_n", "0.7"},
            {"factor_over_time", "0,0.5;1,2"}};
  }
  if (id == "distributed_load") {
    return {{"from", "0.2"},
            {"to", "0.8"},
            {"force_n_per_m", "1,-2,0.5"},
            {"along_n_per_m", "0.7"},
            {"turned_n_per_m", "0.4,1,-0.6"},
            {"factor_over_time", "0,0.5;1,2"}};
  }
  if (id == "body") {
    setenv("XDG_CACHE_HOME", TRESS_BINARY_DIR "/mesh_cache/contract", 1);
    return {{"centre_m", "0.1,-0.05,0.08"},
            {"rotation_rad", "0.3,-0.5,0.2"},
            {"radius_m", "0.6"},
            {"length_m", "0.7"},
            {"half_axes_m", "0.5,0.8,0.65"},
            {"sdf_file", write_file("contract.sdf", as_text(sphere_samples(0.6, 1, 21)))},
            {"mesh_file", write_file("contract.obj", as_obj(ball(0.6, 3)))},
            {"stiffness_n_m2", "50"},
            {"damping_s_m", "0.4"},
            {"friction", "0.6"},
            {"slip_speed_m_s", "0.3"},
            {"strand_radius_m", "0.02"}};
  }
  return {};
}

/// Turns and travels at once.
RootMotion moving_head() {
  RootMotion head;
  head.position = {0.2, 0.1, -0.3};
  head.frame = rotation({0, 0.6, 0.8}, 0.5);
  head.centre = Vec{0, 0, -0.2};
  head.rotations = {{{1, 0, 0.5}, sine(0.4, 0.8)}};
  head.translations = {{{0, 1, 0}, sine(0.1, 0.5)}};
  return head;
}

struct Case {
  const EffectEntry* entry;
  Settings words;  // one word for every choice

  std::string name() const {
    std::string text(entry->id);
    for (const auto& [key, word] : words) text += "_" + key + "_" + word;
    return text;
  }
  Parameters parameters() const {
    Parameters all(entry->parameters, "effect " + std::string(entry->id));
    for (const auto& [key, value] : lively(entry->id)) all.set(key, value);
    for (const auto& [key, value] : words) all.set(key, value);
    return all;
  }
  std::unique_ptr<const Effect> make() const {
    return entry->make(parameters(), moving_head());
  }
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name(); }

/// Every effect with every combination of words. Not those whose points act on each
/// other: test_self_contact.cpp, test_strand_interaction.cpp and test_ring.cpp.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const EffectEntry& entry : testing_support::tested_effects()) {
    if (entry.id == "self_contact" || entry.id == "ring" || entry.make == nullptr)
      continue;
    std::vector<Case> of_entry{{&entry, {}}};
    for (const Parameter& parameter : entry.parameters) {
      if (parameter.choices.empty()) continue;
      std::vector<Case> longer;
      for (const Case& one : of_entry) {
        for (const std::string_view word : words_of(parameter.choices)) {
          longer.push_back(one);
          longer.back().words[std::string(parameter.name)] = word;
        }
      }
      of_entry = std::move(longer);
    }
    for (Case& one : of_entry) {
      // Refused: test_pulley.cpp.
      const bool driven = one.words.contains("moves") &&
                          (one.words["moves"] == "turns" || one.words["moves"] == "free");
      if (driven && one.words["friction_law"] == "exact") continue;
      // Refused without moments of inertia: test_free_body.cpp.
      if (driven && one.words["moves"] == "free" &&
          (one.words["shape"] == "plane" || one.words["shape"] == "sdf" ||
           one.words["shape"] == "mesh")) {
        continue;
      }
      // Refused: test_exact_contact.cpp.
      if (one.words.contains("normal") && one.words["normal"] == "rigid" &&
          one.words["friction_law"] == "regularised") {
        continue;
      }
      all.push_back(std::move(one));
    }
  }
  return all;
}

class EffectContract : public testing::TestWithParam<Case> {
 protected:
  /// With contact forces, where the effect holds them.
  EffectContract() {
    std::unique_ptr<Effect> own = effect->for_strand(200);
    if (own == nullptr) return;
    Cloud away = cloud;  // no overlap at first
    for (std::size_t i = 0; i < away.x.size(); i += 3) away.x[i] -= 10;
    constexpr double tau = 1;  // differences of places are then no jumps of slides
    Cloud before = cloud;
    for (std::size_t i = 0; i < before.x.size(); ++i) before.x[i] -= tau * before.v[i];
    Multipliers& held = *own->multipliers();
    std::vector<double> start(held.tracked());
    held.places(now - tau, before.points(), start);
    held.begin(now, tau, away.points(), start);
    held.improve(now, cloud.points());
    effect = std::move(own);
  }

  Cloud cloud{200};
  std::unique_ptr<const Effect> effect = GetParam().make();
};

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectContract, testing::ValuesIn(cases()),
                         [](const auto& one) { return one.param.name(); });

TEST_P(EffectContract, ActsAndIsFinite) {
  double largest = 0;
  for (const double f : load(*effect, now, cloud.points())) {
    ASSERT_TRUE(std::isfinite(f));
    largest = std::max(largest, std::abs(f));
  }
  EXPECT_GT(largest, 1e-3);
}

// Gradients trust the declaration in all states. A sum of some ten terms is rounded at
// most ten times.
TEST_P(EffectContract, IsAffineInTheNumbersThatItDeclares) {
  const Parameters here = GetParam().parameters();
  for (const Parameter& p : GetParam().entry->parameters) {
    if (!affine_in(*GetParam().entry, p.name, here)) continue;
    const auto load_at = [&](double more) {
      Parameters changed = here;
      const Vec v = p.components == 3 ? here.vec(p.name) : Vec{};
      const double step = more * 0.25;
      changed.set(p.name, p.components == 3
                              ? number_text(v.x + step) + "," + number_text(v.y - step) +
                                    "," + number_text(v.z + step)
                              : number_text(here.number(p.name) + step));
      const auto made = GetParam().entry->make(changed, moving_head());
      return load(*made, now, cloud.points());
    };
    const auto f0 = load_at(0), f1 = load_at(1), f2 = load_at(2);
    for (std::size_t i = 0; i < f0.size(); ++i) {
      const double size = std::abs(f0[i]) + std::abs(f2[i]);
      ASSERT_NEAR(f1[i], (f0[i] + f2[i]) / 2, 1e-13 * (1 + size)) << p.name;
    }
  }
}

TEST_P(EffectContract, IsFiniteAtDegeneratePlaces) {
  Cloud at(8);
  // Origin of the frame of a body (centre_m above), on its axes, and no velocity
  // anywhere; then very far away.
  const Frame frame =
      rotation((1 / std::sqrt(0.38)) * Vec{0.3, -0.5, 0.2}, std::sqrt(0.38));
  const Vec centre{0.1, -0.05, 0.08};
  const Vec places[] = {centre,
                        centre + 0.01 * frame.e0,
                        centre + 0.01 * frame.e1,
                        centre + 0.2 * frame.e2,
                        centre + 0.35 * frame.e2,
                        {1, 0.5, -0.2},
                        {1e6, -1e6, 1e6},
                        {-1e6, 1e6, -1e6}};
  for (std::size_t i = 0; i < 8; ++i) store3(places[i], &at.x[3 * i]);
  at.v.assign(at.v.size(), 0.0);
  const auto finite = [](double x) { return std::isfinite(x); };
  for (const double t : {0.0, now}) {
    EXPECT_TRUE(std::ranges::all_of(load(*effect, t, at.points()), finite));
    EXPECT_TRUE(std::ranges::all_of(derivatives(*effect, t, at.points(), 1, 1), finite));
    EXPECT_TRUE(finite(effect->potential(t, at.points())));
    EXPECT_TRUE(finite(effect->power(t, at.points())));
  }
}

TEST_P(EffectContract, ReadsWhatItAsksForOnly) {
  const Points full = cloud.points(), only = cloud.only(effect->needs());
  EXPECT_EQ(load(*effect, now, full), load(*effect, now, only));
  EXPECT_EQ(derivatives(*effect, now, full, 2, 3), derivatives(*effect, now, only, 2, 3));
  EXPECT_EQ(effect->power(now, full), effect->power(now, only));
  Points places = cloud.only({});
  places.x = cloud.x;
  EXPECT_EQ(effect->potential(now, full), effect->potential(now, places));
}

TEST_P(EffectContract, AddsToWhatIsThere) {
  const auto f = load(*effect, now, cloud.points());
  std::vector<double> sum(f.size(), 1.0);
  effect->add_load(now, cloud.points(), sum);
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_NEAR(sum[i], 1 + f[i], 2 * eps * (1 + std::abs(f[i])));
  }
}

/// A central difference and a bound of its error.
struct Difference {
  double value, bound;
};

/// Of f at 0. D(h/2) of a function that is differentiable, but need be no more than that,
/// is off by about |D(h) - D(h/2)| at most (O(h) terms; O(h^2) terms: by a third of it);
/// twice that is allowed. Rounding: some ten operations on terms up to ten times `size`.
template <class F>
Difference difference(const F& f, double size) {
  constexpr double h = 2e-5;
  const double coarse = (f(h) - f(-h)) / (2 * h);
  const double fine = (f(h / 2) - f(-h / 2)) / h;
  return {fine, 2 * std::abs(coarse - fine) + 100 * eps * size / h};
}

/// Point i by itself: the others do not matter to it.
Cloud alone(const Cloud& cloud, std::size_t i) {
  Cloud one(1);
  store3(load3(&cloud.x[3 * i]), one.x.data());
  store3(load3(&cloud.v[3 * i]), one.v.data());
  store3(load3(&cloud.tangent[3 * i]), one.tangent.data());
  one.mass = {cloud.mass[i]};
  one.length = {cloud.length[i]};
  one.arc = {cloud.arc[i]};
  return one;
}

/// With x, or v, of point i moved along axis k.
template <class Member>
void expect_blocks(const Effect& effect, const Cloud& cloud, Member member,
                   const std::vector<double>& blocks) {
  const bool remembers = effect.for_strand(0) != nullptr;  // forces of each point
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    const Cloud one = remembers ? cloud : alone(cloud, i);
    const std::size_t at = remembers ? 3 * i : 0;
    const auto f0 = load(effect, now, one.points());
    const double size = 1 + norm(load3(&f0[at]));
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t r = 0; r < 3; ++r) {
        const auto component = [&](double h) {
          Cloud moved = one;
          (moved.*member)[at + k] += h;
          return load(effect, now, moved.points())[at + r];
        };
        const Difference d = difference(component, size);
        EXPECT_NEAR(blocks[9 * i + 3 * r + k], d.value, d.bound)
            << "point " << i << ", d" << r << "/d" << k;
      }
    }
  }
}

/// An effect acts on a point alone, but for those that choose a place along the strand.
Cloud crowd(const Effect& effect) {
  const bool chooses = effect.name() == "tether" || effect.name() == "point_force" ||
                       effect.name() == "distributed_load";
  return Cloud(chooses ? 1 : 200);
}

TEST_P(EffectContract, DerivativesByPlaceAreDifferencesOfTheLoad) {
  const Cloud points = crowd(*effect);
  expect_blocks(*effect, points, &Cloud::x,
                derivatives(*effect, now, points.points(), 1, 0));
}

TEST_P(EffectContract, DerivativesByVelocityAreDifferencesOfTheLoad) {
  const Cloud points = crowd(*effect);
  expect_blocks(*effect, points, &Cloud::v,
                derivatives(*effect, now, points.points(), 0, 1));
}

// The tangent turns: towards either of two directions across it, and stays a unit vector.
TEST_P(EffectContract, DerivativesByDirectionAreDifferencesOfTheLoad) {
  const Cloud points = crowd(*effect);
  std::vector<double> blocks(9 * points.count(), 0.0);
  effect->add_direction_derivatives(now, points.points(), 1, blocks);
  double clearest = 0;
  for (std::size_t i = 0; i < points.count(); ++i) {
    const Cloud one = alone(points, i);
    const Vec t = load3(one.tangent.data());
    const Vec other = std::abs(t.x) < 0.7 ? Vec{1, 0, 0} : Vec{0, 1, 0};
    const Vec first = (1 / norm(cross(t, other))) * cross(t, other);
    const double size = 1 + norm(load3(load(*effect, now, one.points()).data()));
    for (const Vec& across : {first, cross(t, first)}) {
      for (std::size_t r = 0; r < 3; ++r) {
        const auto component = [&](double h) {
          Cloud turned = one;
          const Vec moved = t + h * across;
          store3((1 / norm(moved)) * moved, turned.tangent.data());
          return load(*effect, now, turned.points())[r];
        };
        const Difference d = difference(component, size);
        EXPECT_NEAR(dot(load3(&blocks[9 * i + 3 * r]), across), d.value, d.bound)
            << "point " << i << ", d" << r;
        clearest = std::max(clearest, std::abs(d.value) / d.bound);
      }
    }
  }
  // What is there stands out from the error of the difference, or is not there.
  EXPECT_EQ(clearest > 1e3, effect->needs().directions);
}

TEST_P(EffectContract, DerivativesAreNeededExactlyWhenTheyAreNotZero) {
  const auto blocks = derivatives(*effect, now, cloud.points(), 1, 1);
  const bool zero = std::ranges::all_of(blocks, [](double x) { return x == 0; });
  EXPECT_NE(zero, effect->needs().derivatives);
}

// d/dt of the potential along x' = v is the power less the work of the load.
TEST_P(EffectContract, WorkIsPowerLessTheRateOfThePotential) {
  const auto f = load(*effect, now, cloud.points());
  double work = 0, size = 1;
  for (std::size_t i = 0; i < f.size(); ++i) {
    work += f[i] * cloud.v[i];
    size += std::abs(f[i] * cloud.v[i]);
  }
  size += std::abs(effect->potential(now, cloud.points()));
  const Difference rate = difference(
      [&](double h) {
        Cloud later = cloud;
        for (std::size_t i = 0; i < f.size(); ++i) later.x[i] += h * cloud.v[i];
        return effect->potential(now + h, later.points());
      },
      size);
  EXPECT_NEAR(work, effect->power(now, cloud.points()) - rate.value, rate.bound);
}

TEST_P(EffectContract, UniformAccelerationIsTheLoadPerMass) {
  const auto a = effect->uniform_acceleration();
  if (!a) return;
  const auto f = load(*effect, now, cloud.points());
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    const Vec d = load3(&f[3 * i]) - cloud.mass[i] * *a;
    EXPECT_LE(norm(d), 4 * eps * std::sqrt(dot(*a, *a)) * cloud.mass[i]);
  }
}

TEST_P(EffectContract, WhatDissipatesInAFieldAtRestTakesEnergyFromEveryPoint) {
  const auto& [entry, words] = GetParam();
  const bool drag = entry->id == "linear_drag" || entry->id == "quadratic_drag";
  const bool fixed_body = entry->id == "body" && words.at("moves") == "fixed";
  if (!drag && !fixed_body) return;
  if (effect->for_strand(0) != nullptr) return;  // only where its law holds
  double all = 0;
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    Points one{1,
               In(cloud.x).subspan(3 * i, 3),
               In(cloud.v).subspan(3 * i, 3),
               In(cloud.tangent).subspan(3 * i, 3),
               In(cloud.mass).subspan(i, 1),
               In(cloud.length).subspan(i, 1)};
    const double power = effect->power(now, one);
    // Of a body a difference of two works, both below 50 N.
    EXPECT_LE(power, 50 * 4 * eps);
    all += power;
  }
  EXPECT_LT(all, -1e-3);
}

}  // namespace tress::test_effect_contract
