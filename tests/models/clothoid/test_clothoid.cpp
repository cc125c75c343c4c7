#include <gtest/gtest.h>

#include <complex>
#include <cstdio>
#include <numbers>

#include "contract/input_error.h"
#include "math/dual.h"
#include "math/gauss_legendre.h"
#include "models/clothoid/clothoid.h"

namespace tress::test_clothoid {

using namespace models;

using Clothoid = ClothoidOf<double, 3>;
constexpr double length = 0.4;  // m

/// The points of an element, those of a rule with `count` of them.
std::vector<PointBlock> blocks(int count) {
  const std::vector<QuadraturePoint> rule = gauss_legendre(count, length);
  std::vector<PointBlock> all;
  for (std::size_t first = 0; first < rule.size(); first += Pack::lanes) {
    PointBlock block{Pack(length / 2), Pack(0), Pack(0)};
    for (std::size_t i = first; i < std::min(first + Pack::lanes, rule.size()); ++i) {
      block.s.set(static_cast<int>(i - first), rule[i].at);
      block.length.set(static_cast<int>(i - first), rule[i].weight);
    }
    all.push_back(block);
  }
  return all;
}

struct Element {
  Element(const LinearStrain& kappa, int count)
      : points(blocks(count)), rule(points, length), kernel(kappa, length, rule) {}
  std::vector<PointBlock> points;
  Collocation<double> rule;
  Clothoid kernel;
};

/// Six unknowns as a strain, of any scalar.
template <class T>
LinearStrainOf<T> strain(const std::array<T, 6>& q) {
  return {{q[0], q[1], q[2]}, {q[3], q[4], q[5]}};
}
LinearStrain unit(std::size_t k) {
  std::array<double, 6> q{};
  q[k] = 1;
  return strain(q);
}

/// The frame, W e_k and position at the tip by the classical Runge-Kutta method of fourth
/// order in `steps`; independent of quaternions, series and collocation.
template <class T>
struct Integrated {
  FrameOf<T> frame;
  Vec3<T> position;
  std::array<Vec3<T>, 6> turn;
};
template <class T>
FrameOf<T> turning(const FrameOf<T>& r, const Vec3<T>& k) {  // R [k]x
  const Vec3<T> e0{T(1), T(0), T(0)}, e1{T(0), T(1), T(0)}, e2{T(0), T(0), T(1)};
  return {r * cross(k, e0), r * cross(k, e1), r * cross(k, e2)};
}
template <class T>
Integrated<T> integrated(const LinearStrainOf<T>& kappa, int steps, double end = 1) {
  const double h = length * end / steps;
  const auto at = [&](double s) {
    return kappa.mean + T(2 * s / length - 1) * kappa.half;
  };
  const auto moved = [](const FrameOf<T>& r, double by, const FrameOf<T>& d) {
    return FrameOf<T>{r.e0 + T(by) * d.e0, r.e1 + T(by) * d.e1, r.e2 + T(by) * d.e2};
  };
  Integrated<T> x;
  const auto add = [&](const FrameOf<T>& r, double s, double weight) {
    x.position = x.position + T(weight) * r.e0;
    const std::array<Vec3<T>, 3> axes{r.e0, r.e1, r.e2};
    for (std::size_t k = 0; k < 6; ++k) {
      const double factor = k < 3 ? 1 : 2 * s / length - 1;
      x.turn[k] = x.turn[k] + T(weight * factor) * axes[k % 3];
    }
  };
  for (int i = 0; i < steps; ++i) {
    const double s = i * h;
    const FrameOf<T>& r = x.frame;
    const FrameOf<T> k1 = turning(r, at(s)), r2 = moved(r, h / 2, k1);
    const FrameOf<T> k2 = turning(r2, at(s + h / 2)), r3 = moved(r, h / 2, k2);
    const FrameOf<T> k3 = turning(r3, at(s + h / 2)), r4 = moved(r, h, k3);
    const FrameOf<T> k4 = turning(r4, at(s + h));
    add(r, s, h / 6);
    add(r2, s + h / 2, h / 3);
    add(r3, s + h / 2, h / 3);
    add(r4, s + h, h / 6);
    x.frame = moved(moved(moved(moved(r, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
  }
  return x;
}

double apart(const Vec& x, const Vec& y) { return norm(x - y); }

/// Of the strain whose mean winds by `angle`; growth 0: constant, 1: from zero.
LinearStrain winding(double angle, double growth, const Vec& axis) {
  const Vec mean = angle / length * axis;
  return {mean, growth * mean + 0.2 * growth * angle / length * Vec{axis.y, -axis.x, 0}};
}

const Vec axes_of_test[] = {{0, 0.6, 0.8}, {1, 0, 0}, {0.48, 0.6, 0.64}, {0.8, -0.6, 0}};

struct Errors {
  double tip = 0, points = 0;
};
/// Of frame, position and W e_k over the length, for several directions.
Errors errors(double angle, double growth, int points, int steps) {
  Errors worst;
  for (const Vec& axis : axes_of_test) {
    const LinearStrain kappa = winding(angle, growth, axis);
    const Element element(kappa, points);
    const Clothoid& kernel = element.kernel;
    const auto see = [&](double& most, const Integrated<double>& exact, const auto& at) {
      const auto error = [&](const Vec& x, const Vec& y, double size) {
        most = std::max(most, apart(x, y) / size);
      };
      error(at(kernel.position()), exact.position, length);
      for (std::size_t k = 0; k < 6; ++k) {
        error(at(kernel.W(unit(k))), exact.turn[k], length);
      }
    };
    const Integrated<double> end = integrated(kappa, steps);
    see(worst.tip, end, [&](const auto& x) { return x.at(kernel.tip()); });
    const Frame& frame = kernel.rotation(kernel.tip());
    worst.tip = std::max({worst.tip, apart(frame.e0, end.frame.e0),
                          apart(frame.e1, end.frame.e1), apart(frame.e2, end.frame.e2)});
    for (std::size_t b = 0; b < element.points.size(); ++b) {
      for (int lane = 0; lane < Pack::lanes; ++lane) {
        const double to = element.points[b].s[lane] / length;
        const auto at = kernel.point(static_cast<int>(b));
        see(worst.points, integrated(kappa, steps, to),
            [&](const auto& x) { return lane_of(x.at(at), lane); });
      }
    }
  }
  return worst;
}

// The integration over 4 rad in n steps is off by some (4/n)^4/120: 2e-15 for 2000.
TEST(Clothoid, IsThatOfTheDifferentialEquationTo1e11UpTo2Rad) {
  for (const double growth : {0.0, 0.5, 1.0}) {
    for (const double angle : {0.0, 0.02, 0.5, 2.0}) {
      const Errors e = errors(angle, growth, 16, 2000);
      std::printf("%g rad, half %g of the mean: %.1e at the tip, %.1e at points\n", angle,
                  growth, e.tip, e.points);
      EXPECT_LE(e.tip, 1e-11);
      EXPECT_LE(e.points, 1e-11);
      // The default: exact at the tip.
      const int points = clothoid_points(angle * (1 + 1.02 * growth));
      const Errors usual = errors(angle, growth, points, 1000);
      EXPECT_LE(usual.tip, 1e-11) << points;
      EXPECT_LE(usual.points, 1e-7) << points;
    }
  }
}

/// C + iS of Fresnel by the power series, for the clothoid in the plane
/// [Abramowitz & Stegun, 7.3.11].
std::complex<double> fresnel(double t) {
  std::complex<double> sum = 0, power = t;
  for (int n = 0; n < 60; ++n) {
    sum += power / (2.0 * n + 1);
    power *= std::complex<double>(0, std::numbers::pi / 2 * t * t / (n + 1));
  }
  return sum;
}

TEST(Clothoid, InThePlaneIsGivenByFresnelIntegrals) {
  for (const double mean : {-1.0, 0.0, 0.7, 2.0}) {  // rad
    for (const double half : {0.3, 1.0, 2.0}) {
      const Element element({{0, mean / length, 0}, {0, half / length, 0}}, 16);
      // The angle is half (u^2 - d^2), u = x + d.
      const double d = (mean - half) / (2 * half),
                   z = std::sqrt(2 * half / std::numbers::pi);
      const std::complex<double> way = length / z * std::polar(1.0, -half * d * d) *
                                       (fresnel(z * (1 + d)) - fresnel(z * d));
      const Vec tip = element.kernel.position().at(element.kernel.tip());
      EXPECT_LE(apart(tip, {way.real(), 0, -way.imag()}), 1e-11 * length) << mean << half;
      const Frame& frame = element.kernel.rotation(element.kernel.tip());
      EXPECT_LE(apart(frame.e0, {std::cos(mean), 0, -std::sin(mean)}), 1e-13);
    }
  }
}

TEST(Clothoid, FramesOfManyTurnsAreThoseOfAHelixAndOfTheEquation) {
  for (const double angle : {5.0, 20.0, 300.0}) {
    const LinearStrain constant = winding(angle, 0, {0.48, 0.6, 0.64});
    const Element helix(constant, 32);
    const Frame turned = rotation({0.48, 0.6, 0.64}, angle);
    const Frame& frame = helix.kernel.rotation(helix.kernel.tip());
    EXPECT_LE(apart(frame.e1, turned.e1), 1e-14 * (10 + angle)) << angle;
  }
  const LinearStrain growing = winding(20, 1, {0.48, 0.6, 0.64});
  const Element element(growing, 32);
  const Integrated<double> exact = integrated(growing, 40000);
  EXPECT_LE(apart(element.kernel.rotation(element.kernel.tip()).e1, exact.frame.e1),
            1e-11);
}

using First = Dual<6>;
using Second = Dual<6, First>;

/// Position and W e_k at the tip with their first and second derivatives by the unknowns.
Integrated<Second> derivatives(const LinearStrain& kappa, int steps) {
  const std::array<double, 6> q{kappa.mean.x, kappa.mean.y, kappa.mean.z,
                                kappa.half.x, kappa.half.y, kappa.half.z};
  std::array<Second, 6> x;
  for (std::size_t k = 0; k < 6; ++k) {
    x[k].value = First(q[k]);
    x[k].value.part[k] = 1;
    x[k].part[k] = First(1);
  }
  return integrated(strain(x), steps);
}
Vec second(const Vec3<Second>& x, std::size_t k, std::size_t l) {
  return {x.x.part[k].part[l], x.y.part[k].part[l], x.z.part[k].part[l]};
}

TEST(Clothoid, DerivativesAreThoseOfTheDifferentialEquation) {
  const LinearStrain kappa = winding(1.3, 0.7, {0.48, 0.6, 0.64});
  const Element element(kappa, 16);
  const Clothoid& kernel = element.kernel;
  const auto tip = kernel.tip();
  // (2.2/400)^4/120 = 8e-12 of the derivatives' own size, length^m.
  const Integrated<Second> exact = derivatives(kappa, 400);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& p = exact.position;
    const Vec slope{p.x.part[k].value, p.y.part[k].value, p.z.part[k].value};
    EXPECT_LE(apart(kernel.first(unit(k)).at(tip), slope), 1e-10 * length * length) << k;
    for (std::size_t l = 0; l < 6; ++l) {
      EXPECT_LE(apart(kernel.second(unit(k), unit(l)).at(tip), second(p, k, l)),
                1e-10 * std::pow(length, 3))
          << k << l;
      const auto& w = exact.turn[l];
      const Vec turned{w.x.part[k].value, w.y.part[k].value, w.z.part[k].value};
      EXPECT_LE(apart(kernel.dW(unit(k), unit(l)).at(tip), turned),
                1e-10 * length * length);
      const Vec y{0.3, -0.5, 0.7};
      EXPECT_NEAR(dot(kernel.dW_transposed(tip, unit(k), y), unit(l)), dot(y, turned),
                  1e-10 * length * length);
      for (std::size_t m = 0; m < 6; ++m) {
        EXPECT_LE(apart(kernel.d2W(unit(k), unit(m), unit(l)).at(tip), second(w, k, m)),
                  1e-10 * std::pow(length, 3));
      }
    }
  }
}

/// Of fourth order in the step; over it the differences round off to eps/step.
TEST(Clothoid, AccelerationsAreSecondDerivativesInTimeAndTheirSlopesAreTheirs) {
  const LinearStrain kappa = winding(1.3, 0.7, {0.48, 0.6, 0.64});
  const LinearStrain rate{{1, -2, 3}, {0.5, 2, -1}}, change{{-2, 1, 4}, {3, 1, -2}};
  const auto at = [&](const LinearStrain& q) { return Element(q, 16); };
  const auto sides = [&](const auto& f, double h) {
    return 1 / (12 * h) * (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h)));
  };
  const Element here = at(kappa);
  for (const int block : {-1, 0, 3}) {
    const auto of = [&](const Element& element, const Clothoid::Along& x) {
      return block < 0 ? x.at(element.kernel.tip())
                       : lane_of(x.at(element.kernel.point(block)), 1);
    };
    const Vec acceleration = of(here, here.kernel.acceleration(rate, change));
    // d/dt P'[kappa'] along kappa(t), whose rate changes too.
    const Vec numeric = sides(
        [&](double t) {
          const Element then = at(kappa + t * rate);
          return of(then, then.kernel.first(rate + t * change));
        },
        4e-3);
    EXPECT_LE(apart(acceleration, numeric), 1e-9 * norm(acceleration)) << block;
    for (std::size_t k = 0; k < 6; ++k) {
      const Vec slope = of(here, here.kernel.acceleration_slope(rate, change, unit(k)));
      const Vec by_differences = sides(
          [&](double x) {
            const Element then = at(kappa + x * unit(k));
            return of(then, then.kernel.acceleration(rate, change));
          },
          4e-3);
      EXPECT_LE(apart(slope, by_differences), 1e-8 * norm(slope)) << block << " " << k;
    }
  }
}

TEST(Clothoid, PointsFollowTheWindingAndEnd) {
  EXPECT_EQ(clothoid_points(0), 8);
  EXPECT_EQ(clothoid_points(1.5), 12);
  EXPECT_EQ(clothoid_points(most_clothoid_winding), most_clothoid_points);
  EXPECT_THROW(clothoid_points(most_clothoid_winding + 1), InputError);
  EXPECT_THROW(clothoid_points(std::nan("")), InputError);
}

}  // namespace tress::test_clothoid
