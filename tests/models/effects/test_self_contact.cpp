#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "contract/input_error.h"
#include "models/effects/catalogue.h"
#include "models/effects/self_contact.h"
#include "tests/support/catalogue_cases.h"

namespace tress::test_self_contact {

using namespace models;

using namespace testing_support;

constexpr double inner = 3e-3, separation = 2e-2;

ContactLaw law(double viscosity) {
  return {{.stiffness = 0.2, .viscosity = viscosity, .inner = inner, .outer = 2 * inner},
          "test"};
}

/// A coil whose turns lie 2 mm apart, crumpled a little: 3 turns of 4 cm, n edges.
struct Coil {
  std::vector<double> x, v, mass, length;

  explicit Coil(int n) {
    for (int i = 0; i <= n; ++i) {
      const double s = i / static_cast<double>(n), angle = 6 * std::numbers::pi * s;
      const double radius = 0.04 / (2 * std::numbers::pi);
      x.insert(x.end(), {radius * std::cos(angle), radius * std::sin(angle),
                         6e-3 * s + 4e-4 * std::sin(37 * s)});
      v.insert(v.end(), {std::sin(11 * s), std::cos(7 * s), std::sin(5 * s + 1)});
      mass.push_back(1);
      length.push_back((i == 0 || i == n ? 0.5 : 1) * 0.12 / n);
    }
  }
  Points points() const {
    return {static_cast<int>(length.size()), x, v, {}, mass, length};
  }
};

std::vector<double> load(const Effect& effect, const Points& p) {
  std::vector<double> f(p.x.size());
  effect.add_load(0, p, f);
  return f;
}

TEST(SelfContact, ForcesWithinTheStrandSumToZero) {
  const SelfContact effect(law(2), separation);
  const Coil coil(37);
  const std::vector<double> f = load(effect, coil.points());
  Vec sum;
  double size = 0;
  for (std::size_t i = 0; i < f.size(); i += 3) {
    sum = sum + load3(&f[i]);
    size += std::sqrt(dot(load3(&f[i]), load3(&f[i])));
  }
  EXPECT_GT(size, 1e-3);
  // Some 160 contacts, each rounded to eps of its part.
  EXPECT_LE(norm(sum), 160 * 2.3e-16 * size);
}

TEST(SelfContact, LeavesAStraightStrandAlone) {
  const SelfContact effect(law(2), separation);
  Coil strand(40);
  for (std::size_t i = 0; i < strand.x.size(); i += 3) {
    store3(Vec{1e-3 * static_cast<double>(i), 0, 0}, &strand.x[i]);
  }
  EXPECT_EQ(largest(load(effect, strand.points())), 0);
}

TEST(SelfContact, RepulsionIsTheDescentOfItsPotential) {
  const SelfContact effect(law(0), separation);
  const Coil coil(37);
  const std::vector<double> f = load(effect, coil.points());
  for (std::size_t i = 0; i < f.size(); i += 7) {
    const auto slope = central_difference(1e-8, [&](double e) {
      Coil moved = coil;
      moved.x[i] += e;
      return std::vector<double>{effect.potential(0, moved.points())};
    });
    // Rounding of V, K P^2/2 L at most, over the step.
    const double energy = 0.2 * inner * inner / 2 * 0.12;
    EXPECT_NEAR(f[i], -slope[0], 100 * 2.3e-16 * energy / 1e-8);
  }
}

TEST(SelfContact, BlocksAreDifferencesOfTheLoad) {
  const SelfContact effect(law(2), separation);
  const Coil coil(37);
  std::vector<double> by_x(3 * coil.x.size()), by_v(by_x.size());
  effect.add_derivatives(0, coil.points(), 1, 0, by_x);
  effect.add_derivatives(0, coil.points(), 0, 1, by_v);
  EXPECT_GT(largest(by_x), 0);
  const double size = largest(load(effect, coil.points()));
  for (std::size_t i = 0; i < coil.x.size(); i += 3) {
    for (std::size_t j = 0; j < 3; ++j) {
      // Small, so that the nearest point of a sample stays on its edge: over 1e-8 of the
      // reach 6e-3 rounding leaves eps 6e-3/1e-8 = 1e-10 of derivatives size/1e-3.
      const auto dx = central_difference(1e-8, [&](double e) {
        Coil moved = coil;
        moved.x[i + j] += e;
        return load(effect, moved.points());
      });
      const auto dv = central_difference(0.1, [&](double e) {
        Coil moved = coil;
        moved.v[i + j] += e;
        return load(effect, moved.points());
      });
      for (std::size_t row = 0; row < 3; ++row) {
        EXPECT_NEAR(by_x[3 * i + 3 * row + j], dx[i + row], 1e-7 * size / 1e-3);
        EXPECT_NEAR(by_v[3 * i + 3 * row + j], dv[i + row], 1e-12 * size);
      }
    }
  }
}

TEST(SelfContact, CouplingsAreTheWholeDerivativeOfTheLoad) {
  const SelfContact effect(law(2), separation);
  const Coil coil(37);
  std::vector<Coupling> all;
  effect.add_couplings(0, coil.points(), all);
  ASSERT_GT(all.size(), 0u);
  const std::size_t n = coil.x.size();
  const double size = largest(load(effect, coil.points()));
  std::size_t between = 0;  // derivatives by another point's place
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<double> by_x(n), by_v(n);
    for (const Coupling& coupling : all) {
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t c = 0; c < 4; ++c) {
          if (coupling.ends[c].point != j / 3) continue;
          std::array<double, 9> of_x{}, of_v{};
          coupling.add_block(a, c, 1, 0, of_x.data());
          coupling.add_block(a, c, 0, 1, of_v.data());
          for (std::size_t row = 0; row < 3; ++row) {
            by_x[3 * coupling.ends[a].point + row] += of_x[3 * row + j % 3];
            by_v[3 * coupling.ends[a].point + row] += of_v[3 * row + j % 3];
          }
        }
      }
    }
    const auto moved = [&](std::vector<double> Coil::*of, double step) {
      return central_difference(step, [&](double e) {
        Coil other = coil;
        (other.*of)[j] += e;
        return load(effect, other.points());
      });
    };
    // Steps and tolerances as of the blocks above.
    const std::vector<double> dx = moved(&Coil::x, 1e-8), dv = moved(&Coil::v, 0.1);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(by_x[i], dx[i], 1e-7 * size / 1e-3);
      EXPECT_NEAR(by_v[i], dv[i], 1e-12 * size);
      if (i / 3 != j / 3 && std::abs(dx[i]) > 1e-3 * size / 1e-3) ++between;
    }
  }
  EXPECT_GT(between, n);
}

TEST(SelfContact, ViscousWorkIsItsPower) {
  const SelfContact wet(law(2), separation), dry(law(0), separation);
  const Coil coil(37);
  const std::vector<double> f = load(wet, coil.points()), g = load(dry, coil.points());
  double work = 0, size = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    work += (f[i] - g[i]) * coil.v[i];
    size += std::abs((f[i] - g[i]) * coil.v[i]);
  }
  EXPECT_LT(work, 0);
  EXPECT_NEAR(wet.power(0, coil.points()), work, 160 * 2.3e-16 * size);
}

TEST(SelfContact, DoesNotDependOnHowTheStrandIsCutOrOnIdlePoints) {
  const SelfContact effect(law(0), separation);
  const auto end_force = [&](const Coil& coil) {
    // Of the first turn, which the second pushes away.
    const std::vector<double> f = load(effect, coil.points());
    double sum = 0;
    for (std::size_t i = 0; i < coil.length.size() / 3; ++i) sum += f[3 * i + 2];
    return sum;
  };
  // A chord of 37 edges a turn lies pi^2/(2 37^2) = 0.4 % of the radius 6.4 mm inside of
  // the circle, 0.02 mm of depths of 1 mm and more.
  const double fine = end_force(Coil(444)), coarse = end_force(Coil(111));
  EXPECT_LT(fine, 0);
  EXPECT_NEAR(coarse, fine, 0.02 * std::abs(fine));
  Coil padded(111);
  for (std::size_t i = 5; i < padded.length.size(); i += 9) {
    const auto at = static_cast<std::ptrdiff_t>(i);
    for (auto* x : {&padded.x, &padded.v}) x->insert(x->begin() + 3 * at, 3, 0.3);
    padded.length.insert(padded.length.begin() + at, 0.0);
    padded.mass.insert(padded.mass.begin() + at, 0.0);
  }
  EXPECT_EQ(effect.potential(0, padded.points()),
            effect.potential(0, Coil(111).points()));
}

TEST(SelfContact, RefusesPartsThatAreNeverApart) {
  EXPECT_THROW(SelfContact(law(2), inner), InputError);
  EXPECT_THROW(SelfContact(law(2), std::nan("")), InputError);
  const EffectEntry& entry = find_effect("self_contact", "test");
  Parameters parameters(entry.parameters, "effects.self_contact");
  EXPECT_EQ(entry.make(parameters, {})->name(), "self_contact");
  parameters.set("separation_m", "0.001");
  EXPECT_THROW(entry.make(parameters, {}), InputError);
}

}  // namespace tress::test_self_contact
