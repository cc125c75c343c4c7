// Guides tied into a mesh: loads, derivatives, momentum, energy, and links that break.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "contract/input_error.h"
#include "models/effects/control_mesh.h"
#include "tests/support/catalogue_cases.h"

namespace tress::test_control_mesh {

using namespace models;
using namespace testing_support;

constexpr int cut = 6;  // segments of a strand
constexpr double segment = 0.01;

Parameters table(const std::vector<std::pair<std::string, std::string>>& settings = {}) {
  Parameters p(control_mesh_parameters(), "effects.control_mesh");
  for (const auto& [key, value] : settings) p.set(key, value);
  return p;
}

const std::vector<std::pair<std::string, std::string>> links_only{
    {"stiffness_n_m2", "0"}, {"viscosity_n_s_m2", "0"}};
const std::vector<std::pair<std::string, std::string>> strips_only{
    {"link_stiffness_n_m2", "0"}, {"link_damping_n_s_m2", "0"}};

/// Strands with their roots where they are told, along z, bent a little; three of them
/// are neighbours of each other at 2 cm.
struct Guides {
  std::vector<std::vector<double>> segments;
  std::vector<double> x, v;
  std::mt19937 random{3};

  explicit Guides(const std::vector<Vec>& roots, Vec along = {0, 0, 1}) {
    for (const Vec& root : roots) add(root, along);
  }
  void add(const Vec& root, const Vec& along) {
    segments.emplace_back(cut, segment);
    for (int i = 0; i <= cut; ++i) append(root + (i * segment) * along);
  }
  void append(const Vec& at) {
    x.insert(x.end(), {at.x, at.y, at.z});
    v.insert(v.end(), {0, 0, 0});
  }
  double spread(double size) {
    return size * std::uniform_real_distribution<double>(-1, 1)(random);
  }
  /// Moves points by up to `far`, with speeds up to `fast`.
  void stir(double far, double fast) {
    for (double& c : x) c += spread(far);
    for (double& c : v) c += spread(fast);
  }
  std::size_t strands() const { return segments.size(); }
};

const std::vector<Vec> three{{0, 0, 0}, {0.02, 0, 0}, {0.01, 0.018, 0}};

/// Points on which an effect acts: the nodes of a strand, or two between each two of them
/// as a quadrature has them, and one that carries no length.
struct Carriers {
  std::vector<double> x, v, mass, length;

  Carriers(const Guides& all, std::size_t strand, bool nodes) {
    const std::size_t first = strand * (cut + 1);
    for (std::size_t i = first; i < first + cut + 1; ++i) {
      if (nodes) {
        add(all, i, 0, i == first || i == first + cut ? segment / 2 : segment);
      } else if (i < first + cut) {
        add(all, i, 0.5 - std::sqrt(1.0 / 12), segment / 2);
        add(all, i, 0.5, 0);
        add(all, i, 0.5 + std::sqrt(1.0 / 12), segment / 2);
      }
    }
  }
  void add(const Guides& all, std::size_t i, double s, double carried) {
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      x.push_back(s == 0 ? all.x[c] : (1 - s) * all.x[c] + s * all.x[c + 3]);
      v.push_back(s == 0 ? all.v[c] : (1 - s) * all.v[c] + s * all.v[c + 3]);
    }
    mass.push_back(1);
    length.push_back(carried);
  }
  Points points() const {
    return {static_cast<int>(length.size()), x, v, {}, mass, length};
  }
};

std::vector<double> load(const Effect& effect, const Carriers& own) {
  std::vector<double> f(own.x.size());
  effect.add_load(0, own.points(), f);
  return f;
}

Vec total(const std::vector<double>& f) {
  Vec sum;
  for (std::size_t i = 0; i < f.size(); i += 3) sum = sum + load3(&f[i]);
  return sum;
}

double size_of(const std::vector<double>& f) {
  double sum = 0;
  for (std::size_t i = 0; i < f.size(); i += 3) sum += norm(load3(&f[i]));
  return sum;
}

/// Force (N) of links at rest: k l eps of places of 6 cm, by ten links.
constexpr double rounding = 10 * 1e-2 * 0.01 * 1e-17;

/// What the law alone gives a point that carries a centimetre, 1 mm from a strip (N).
double whole_push() {
  return segment * ContactLaw(table(), "test").force({0, 1e-3, 0}, {}).y;
}

/// A third strand that crosses the strip between the first two, `above` from it.
Guides crossed(double above) {
  Guides all({{0, 0, 0}, {0.02, 0, 0}});
  all.add({0.01, above - 0.03, 0.031}, {0, 1, 0});
  return all;
}

TEST(ControlMesh, IsAtRestWhereItIsMade) {
  const Guides all(three);
  ControlMesh mesh(table(), all.segments);
  const auto effect = mesh.effect(0);
  const Carriers own(all, 0, true);
  EXPECT_EQ(size_of(load(*effect, own)), 0);
  mesh.tie(all.x);
  mesh.update(all.x, all.v);
  EXPECT_EQ(mesh.mesh().strips.size(), 3U);
  EXPECT_EQ(mesh.mesh().links.size(), 3U * (cut - 1));
  EXPECT_LE(size_of(load(*effect, own)), rounding);
  EXPECT_LE(mesh.energy(), rounding * 1e-17);
  EXPECT_EQ(mesh.contacts(), 0U);  // parallel to the strips
}

/// At a state where partners are where they are seen, forces sum to zero, and so do their
/// moments; both kinds of points give the same force.
TEST(ControlMesh, ForcesOfLinksAreOppositeAndCentral) {
  Guides all(three);
  ControlMesh mesh(table(links_only), all.segments);
  mesh.tie(all.x);
  all.stir(1e-3, 0.1);
  mesh.update(all.x, all.v);
  for (const bool nodes : {true, false}) {
    Vec sum, moment;
    double size = 0;
    for (std::size_t k = 0; k < all.strands(); ++k) {
      const Carriers own(all, k, nodes);
      const std::vector<double> f = load(*mesh.effect(k), own);
      sum = sum + total(f);
      size += size_of(f);
      for (std::size_t i = 0; i < f.size(); i += 3) {
        moment = moment + cross(load3(&own.x[i]), load3(&f[i]));
      }
    }
    EXPECT_GT(size, 1e-7);
    // Between two Gauss points the polyline is cut off: partners are seen up to 1 mm x
    // 0.21 from where they hold, a fifth of a stretch of 1 mm.
    const double seen = nodes ? 1e-14 : 0.3;
    EXPECT_LE(norm(sum), seen * size) << nodes;
    EXPECT_LE(norm(moment), seen * 0.06 * size) << nodes;
  }
}

/// The derivative of the energy, where no damper acts.
TEST(ControlMesh, LoadsOfLinksAreTheGradientOfTheirEnergy) {
  Guides all(three);
  auto settings = links_only;
  settings.emplace_back("link_damping_n_s_m2", "0");
  ControlMesh mesh(table(settings), all.segments);
  mesh.tie(all.x);
  all.stir(2e-3, 0.1);
  mesh.update(all.x, all.v);
  const std::vector<double> f = load(*mesh.effect(1), Carriers(all, 1, true));
  const double step = 1e-6;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const auto energy = [&](double by) {
      Guides moved = all;
      moved.x[3 * (cut + 1) + i] += by;
      mesh.update(moved.x, moved.v);
      return mesh.energy();
    };
    // Truncation step^2/6 k l/r^2 ~ 1e-12 x 1e-4/4e-4, rounding eps 1e-10/step.
    EXPECT_NEAR(f[i], -(energy(step) - energy(-step)) / (2 * step), 1e-12) << i;
  }
  EXPECT_GT(size_of(f), 1e-8);
  EXPECT_EQ(mesh.broken(), 0U);
}

void expect_lumped_differences(const Effect& effect, const Carriers& own) {
  const std::size_t n = own.x.size();
  std::vector<double> by_x(3 * n), by_v(3 * n), both(3 * n);
  effect.add_derivatives(0, own.points(), 1, 0, by_x);
  effect.add_derivatives(0, own.points(), 0, 1, by_v);
  effect.add_derivatives(0, own.points(), 3, 5, both);
  double most_x = 0, most_v = 0;
  for (const double c : by_x) most_x = std::max(most_x, std::abs(c));
  for (const double c : by_v) most_v = std::max(most_v, std::abs(c));
  EXPECT_GT(most_x, 1e-6);
  EXPECT_GT(most_v, 1e-8);
  for (std::size_t j = 0; j < 3; ++j) {
    // All points of the strand alike.
    const auto moved = [&](double step, std::vector<double> Carriers::*what) {
      Carriers there = own;
      for (std::size_t i = j; i < n; i += 3) (there.*what)[i] += step;
      return load(effect, there);
    };
    const double size = 1e-3;  // m, over which forces change
    const auto dx = central_difference(difference_step * size,
                                       [&](double e) { return moved(e, &Carriers::x); });
    const auto dv = central_difference(difference_step,
                                       [&](double e) { return moved(e, &Carriers::v); });
    for (std::size_t i = 0; i < n; ++i) {
      // Truncation and rounding 3e-13 times ratios of derivatives.
      EXPECT_NEAR(by_x[3 * i + j], dx[i], 1e-8 * most_x);
      EXPECT_NEAR(by_v[3 * i + j], dv[i], 1e-8 * most_v);
      EXPECT_NEAR(both[3 * i + j], 3 * by_x[3 * i + j] + 5 * by_v[3 * i + j],
                  1e-14 * (3 * most_x + 5 * most_v));
    }
  }
}

TEST(ControlMesh, DerivativesOfLinksAreDifferencesOfTheLoad) {
  Guides all(three);
  ControlMesh mesh(table(links_only), all.segments);
  mesh.tie(all.x);
  all.stir(2e-3, 0.1);
  mesh.update(all.x, all.v);
  for (const bool nodes : {true, false}) {
    expect_lumped_differences(*mesh.effect(2), Carriers(all, 2, nodes));
  }
}

/// Of a node that alone holds its links, the block is the whole derivative.
TEST(ControlMesh, DerivativesOfANodeAreExact) {
  Guides all(three);
  ControlMesh mesh(table(links_only), all.segments);
  mesh.tie(all.x);
  all.stir(2e-3, 0.1);
  mesh.update(all.x, all.v);
  const auto effect = mesh.effect(0);
  const Carriers own(all, 0, true);
  std::vector<double> by_x(3 * own.x.size());
  effect->add_derivatives(0, own.points(), 1, 0, by_x);
  for (std::size_t point = 1; point < cut; ++point) {
    for (std::size_t j = 0; j < 3; ++j) {
      const auto dx = central_difference(difference_step * 1e-3, [&](double e) {
        Carriers there = own;
        there.x[3 * point + j] += e;
        return load(*effect, there);
      });
      for (std::size_t i = 0; i < dx.size(); ++i) {
        const double expected = i / 3 == point ? by_x[9 * point + 3 * (i % 3) + j] : 0;
        EXPECT_NEAR(dx[i], expected, 1e-8 * 1e-4);  // of k l
      }
    }
  }
}

TEST(ControlMesh, DerivativesOfContactsAreDifferencesOfTheLoad) {
  for (const double above : {1e-3, -2e-3, 4e-3}) {
    Guides all = crossed(above);
    auto settings = strips_only;
    settings.emplace_back("stiffness_n_m2", "2");
    ControlMesh mesh(table(settings), all.segments);
    mesh.tie(all.x);
    all.stir(3e-4, 0.1);
    mesh.update(all.x, all.v);
    ASSERT_GT(mesh.contacts(), 0U);
    for (const std::size_t k : {0, 2}) {
      for (const bool nodes : {true, false}) {
        expect_lumped_differences(*mesh.effect(k), Carriers(all, k, nodes));
      }
    }
  }
}

TEST(ControlMesh, AThirdGuideIsPushedOutOfAStripThatTakesTheReaction) {
  for (const double above : {1e-3, -1e-3}) {
    const Guides all = crossed(above);
    ControlMesh mesh(table(strips_only), all.segments);
    mesh.tie(all.x);
    mesh.update(all.x, all.v);
    Vec sum;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec force = total(load(*mesh.effect(k), Carriers(all, k, true)));
      // One point is in reach of the strip, across it; half of the force to each guide.
      const double share = k == 2 ? 1 : -0.5;
      EXPECT_NEAR(force.y, std::copysign(share, share * above) * whole_push(),
                  1e-12 * whole_push());
      sum = sum + force;
    }
    EXPECT_LE(norm(sum), 1e-15 * 2e-9);
  }
}

TEST(ControlMesh, HairAlongAStripMergesWithIt) {
  Guides all({{0, 0, 0}, {0.02, 0, 0}});
  all.add({0.01, 1e-3, 0}, {0, 0, 1});
  ControlMesh mesh(table(strips_only), all.segments);
  mesh.tie(crossed(1e-3).x);  // no neighbour of the others
  mesh.update(all.x, all.v);
  EXPECT_LE(size_of(load(*mesh.effect(2), Carriers(all, 2, true))), 1e-22);
}

/// w = min(1, e0/e) up to half the largest width, then fades; e0 = 2 cm.
TEST(ControlMesh, StripsThinOutAndVanishAsGuidesPart) {
  const auto push = [&](double width) {
    const Guides rest = crossed(1e-3);
    ControlMesh mesh(table(strips_only), rest.segments);
    mesh.tie(rest.x);
    Guides all({{0.01 - width / 2, 0, 0}, {0.01 + width / 2, 0, 0}});
    all.add({0.01, 1e-3 - 0.03, 0.031}, {0, 1, 0});
    mesh.update(all.x, all.v);
    return total(load(*mesh.effect(2), Carriers(all, 2, true))).y;
  };
  // The width of a triangle is the mean of its sides, one of which is a diagonal.
  const auto slanted = [](double e) { return (e + std::hypot(e, segment)) / 2; };
  const double whole = whole_push(), rounded = 1e-12 * whole;
  EXPECT_NEAR(push(0.02), whole, rounded);
  EXPECT_NEAR(push(0.015), whole, rounded);
  EXPECT_NEAR(push(0.023), whole * slanted(0.02) / slanted(0.023), rounded);
  EXPECT_LT(push(0.04), 0.5 * whole * slanted(0.02) / slanted(0.04));
  EXPECT_GT(push(0.04), 0);
  EXPECT_EQ(push(0.051), 0);
}

TEST(ControlMesh, LaggedPartnersMissMomentumInProportionToTheStep) {
  std::vector<double> missed;
  for (const double h : {1e-3, 5e-4, 2.5e-4}) {
    Guides all = crossed(1e-3);
    auto settings = std::vector<std::pair<std::string, std::string>>{};
    ControlMesh mesh(table(settings), all.segments);
    mesh.tie(all.x);
    all.stir(1e-3, 0.3);
    mesh.update(all.x, all.v);
    for (std::size_t i = 0; i < all.x.size(); ++i) all.x[i] += h * all.v[i];
    Vec sum;
    for (std::size_t k = 0; k < 3; ++k) {
      sum = sum + total(load(*mesh.effect(k), Carriers(all, k, true)));
    }
    missed.push_back(norm(sum));
  }
  EXPECT_GT(missed[0], 1e-9);
  // First order: halves with the step, up to the next term, h v/(1 mm) ~ 0.1 of it.
  EXPECT_NEAR(missed[1] / missed[0], 0.5, 0.1);
  EXPECT_NEAR(missed[2] / missed[1], 0.5, 0.05);
}

TEST(ControlMesh, LinksBreakAtTheirThresholdForGoodUntilTheyAreRecalled) {
  const Guides rest(three);
  auto settings = links_only;
  settings.emplace_back("break_m", "0.005");
  ControlMesh mesh(table(settings), rest.segments);
  mesh.tie(rest.x);
  Guides all = rest;
  const auto shift = [&](double by) {
    all = rest;
    for (std::size_t i = 0; i < 3 * (cut + 1); i += 3) all.x[i] -= by;
    mesh.update(all.x, all.v);
  };
  shift(0.0049);  // strand 0 from strand 1 along x
  EXPECT_EQ(mesh.broken(), 0U);
  EXPECT_GT(mesh.energy(), 0);
  shift(0.0051);
  EXPECT_EQ(mesh.broken(), std::size_t{cut - 1});  // not those to the third
  const std::vector<double> memory = mesh.memory();
  EXPECT_EQ(memory.size(), std::size_t{cut - 1});
  shift(0);
  EXPECT_EQ(mesh.broken(), std::size_t{cut - 1});
  EXPECT_LE(size_of(load(*mesh.effect(0), Carriers(all, 0, true))), rounding);
  shift(0.001);
  const auto pull = [&] { return load(*mesh.effect(0), Carriers(all, 0, true)); };
  const std::vector<double> broken = pull();
  mesh.recall({});
  EXPECT_EQ(mesh.broken(), 0U);
  EXPECT_GT(size_of(pull()), size_of(broken));
  mesh.recall(memory);
  EXPECT_EQ(pull(), broken);
  EXPECT_EQ(mesh.memory(), memory);
}

TEST(ControlMesh, CountsAllOfItsWorkAsPower) {
  Guides all = crossed(1e-3);
  ControlMesh mesh(table(), all.segments);
  mesh.tie(all.x);
  all.stir(1e-3, 0.3);
  mesh.update(all.x, all.v);
  const Carriers own(all, 0, false);
  const auto effect = mesh.effect(0);
  const std::vector<double> f = load(*effect, own);
  double work = 0, size = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    work += f[i] * own.v[i];
    size += std::abs(f[i] * own.v[i]);
  }
  EXPECT_GT(size, 0);
  EXPECT_NEAR(effect->power(0, own.points()), work, 60 * 2.3e-16 * size);
  EXPECT_EQ(effect->potential(0, own.points()), 0);
}

TEST(ControlMesh, RefusesStrandsWithoutAPointBetweenTheirEnds) {
  EXPECT_THROW(ControlMesh(table(), {{0.1, 0.1}, {0.1}}), InputError);
  EXPECT_THROW(ControlMesh(table({{"outer_radius_m", "1e-3"}}), {}), InputError);
}

}  // namespace tress::test_control_mesh
