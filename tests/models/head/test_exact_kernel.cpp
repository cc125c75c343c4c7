#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "models/head/chain_strand.h"
#include "models/head/clothoid_strand.h"
#include "models/head/exact/exact_kernel.h"
#include "models/head/helix_strand.h"
#include "models/head/lane_numbers.h"

/// Newton's corrections x of ExactKernel against the residual r of ReducedKernel: S x = r
/// with S x by differences.
namespace tress::test_exact_kernel {

using namespace models;
using T = PackOf<double, 4>;
using V = Vec3<T>;
using M = Matrix3<T>;

constexpr int elements = 6, points = 8;
constexpr Weights weights{1, 0.05, 0.0025};

class Numbers {
 public:
  T number(double size) {
    T x;
    for (int lane = 0; lane < T::lanes; ++lane) x.set(lane, size * any_(generator_));
    return x;
  }
  V vector(double size) { return {number(size), number(size), number(size)}; }
  M matrix(double size) { return {{vector(size), vector(size), vector(size)}}; }

 private:
  std::mt19937 generator_{1};
  std::uniform_real_distribution<double> any_{-1, 1};
};

/// A strand at any state, with a load f - A x - B u on the points of some elements, where
/// x is a point's place and u its velocity in the axes of the root; lane 1 has none.
template <class Kind>
class Loaded {
 public:
  using Kernel = ReducedKernel<Kind>;
  using Exact = ExactKernel<Kind>;
  using Unknowns = typename Kind::Unknowns;
  using Elements = std::vector<Unknowns>;
  using State = std::array<Elements, 3>;

  Loaded(bool twist, bool loaded, double size)
      : kernel_(elements, points, twist), exact_(kernel_), loaded_(loaded) {
    Numbers any;
    material_ = {T(1.0 / elements), T(1),   T(0.7), {T(0.02), T(0.01), T(0.015)},
                 T(0.003),          T(1e-4)};
    root_ = {any.vector(2), any.vector(2), any.vector(9), any.vector(3)};
    const double sizes[] = {size, 3, 9};
    for (std::size_t k = 0; k < 3; ++k) {
      for (int i = 0; i < elements; ++i) {
        state_[k].emplace_back();
        for (V& x : vectors(state_[k].back())) x = vector(any, sizes[k], twist);
      }
    }
    for (Unknowns& rest : rest_) {
      for (V& x : vectors(rest)) x = vector(any, 1, twist);
    }
    force_ = any.vector(0.5);
    by_x_ = any.matrix(2);
    by_u_ = any.matrix(0.3);
    set_lane(force_, 1, Vec{});
    for (auto* m : {&by_x_, &by_u_}) {
      for (V& row : m->row) set_lane(row, 1, Vec{});
    }
    some_ = T(1);
    some_.set(1, 0);
  }

  /// Largest difference of S x from r, over the largest entry of r. `blind`: S knows of
  /// no loads.
  double left(bool blind = false) {
    Elements x(elements);
    std::vector<typename Exact::Factors> factors(elements);
    Scratch scratch(elements);
    const auto end = exact_.move(material_, root_, state_[0].data(), state_[1].data(),
                                 state_[2].data(), scratch.data(), factors.data());
    find(scratch, state_[1]);
    exact_.newton(material_, end, loaded_ && !blind ? exact_loads_.data() : nullptr,
                  rest_.data(), weights, state_[0].data(), state_[1].data(),
                  state_[2].data(), x.data(), scratch.data(), factors.data());
    Elements again(elements);
    exact_.again(material_, end, loaded_ ? loads_.data() : nullptr, rest_.data(),
                 state_[1].data(), state_[2].data(), again.data(), scratch.data(),
                 factors.data());
    const Elements r = residual(x, 0);
    if (blind) x = again;
    double largest = 0, most = 0;
    each(x, [&](double a) { largest = std::max(largest, std::abs(a)); });
    // Differences of the fourth order over e: e^4 of the terms, and eps/e.
    const double e = 1e-3 / largest;
    const auto ahead = residual(x, e), back = residual(x, -e),
               further = residual(x, 2 * e), beyond = residual(x, -2 * e);
    double size = 0;
    for (std::size_t i = 0; i < elements; ++i) {
      const Unknowns slope =
          T(1 / (12 * e)) * (T(8) * (ahead[i] - back[i]) - (further[i] - beyond[i]));
      const auto compare = [&](const T& a, const T& b) {
        for (int lane = 0; lane < T::lanes; ++lane) {
          size = std::max(size, std::abs(b[lane]));
          most = std::max(most, std::abs(a[lane] - b[lane]));
        }
      };
      for (std::size_t f = 0; f < vectors(slope).size(); ++f) {
        const V &of_slope = vectors(slope)[f], &of_r = vectors(r[i])[f];
        if (kernel_.twist()) compare(of_slope.x, of_r.x);
        compare(of_slope.y, of_r.y);
        compare(of_slope.z, of_r.z);
      }
      // The same residual summed in another order: roundings, by which corrections of
      // chains, whose joints leave three digits, differ up to 1e4 times more.
      each({again[i] - x[i]}, [&](double a) { EXPECT_LE(std::abs(a), 1e-10 * largest); });
    }
    EXPECT_GT(size, 0.1);
    EXPECT_GT(largest, 1);
    return most / size;
  }

 private:
  using Scratch = std::vector<typename Kernel::Scratch>;

  template <class Use>
  static void each(const Elements& x, Use use) {
    for (const Unknowns& element : x) {
      for (const V& v : vectors(element)) {
        for (int lane = 0; lane < T::lanes; ++lane) {
          for (const double a : {v.x[lane], v.y[lane], v.z[lane]}) use(a);
        }
      }
    }
  }
  static V vector(Numbers& any, double size, bool twist) {
    V x = any.vector(size);
    if (!twist) x.x = T(0);
    return x;
  }
  static std::span<V> vectors(Unknowns& x) { return numbers_of<V>(x); }
  static std::span<const V> vectors(const Unknowns& x) { return numbers_of<V>(x); }

  /// At the state moved by e times the weights times x.
  Elements residual(const Elements& x, double e) {
    const double by[] = {weights.pos, weights.vel, weights.acc};
    State moved = state_;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < elements; ++i) {
        moved[k][i] = moved[k][i] + T(e * by[k]) * x[i];
      }
    }
    Scratch scratch(elements);
    std::vector<typename Exact::Factors> factors(elements);
    const auto end = exact_.move(material_, root_, moved[0].data(), moved[1].data(),
                                 moved[2].data(), scratch.data(), factors.data());
    find(scratch, moved[1]);
    Elements r(elements);
    kernel_.residual(
        material_, end, loaded_ ? loads_.data() : nullptr,
        [&](int i) { return rest_[static_cast<std::size_t>(i)]; }, moved[1].data(),
        moved[2].data(), r.data(), scratch.data());
    return r;
  }

  /// Loads on elements 1, 3 and 4.
  void find(const Scratch& scratch, const Elements& rate) {
    const T o(0), one(1);
    FrameOf<T> frame{{one, o, o}, {o, one, o}, {o, o, one}};
    V at;
    for (std::size_t i = 0; i < elements; ++i) {
      const auto& kept = scratch[i].kept;
      Kind::enter(kept, frame);
      const M turn = M::columns(frame.e0, frame.e1, frame.e2);
      const typename Kind::Points on(kept, scratch[i].q, rate[i], material_.length);
      sums_[i] = {};
      sums_[i].some = some_;
      for (int k = 0; k < points; ++k) {
        const PointPlace<T> place = kernel_.place(k, material_.length);
        const T w(kernel_.weight(k));
        const V p = on.position(place), x = at + frame * p,
                u = frame * on.velocity(place, p);
        const V f = w * turn.back(force_ - by_x_ * x - by_u_ * u);
        on.add_force(place, p, f, sums_[i]);
        points_[i][static_cast<std::size_t>(k)] = {
            p,
            {f, w * (turn.transposed() * by_x_ * turn),
             w * (turn.transposed() * by_u_ * turn)},
            some_};
      }
      const bool has = i == 1 || i == 3 || i == 4;
      loads_[i] = has ? &sums_[i] : nullptr;
      exact_loads_[i] = has ? points_[i].data() : nullptr;
      at = at + frame * kept.position;
      Kind::go_on(kept, frame);
    }
  }

  Kernel kernel_;
  Exact exact_;
  bool loaded_;
  ReducedMaterial<T> material_;
  ReducedMotion<T> root_;
  State state_;
  std::array<Unknowns, elements> rest_;
  V force_;
  M by_x_, by_u_;
  T some_;
  std::array<typename Kind::Loads, elements> sums_;
  std::array<std::array<ExactPoint<T>, points>, elements> points_;
  std::array<const typename Kind::Loads*, elements> loads_{};
  std::array<const ExactPoint<T>*, elements> exact_loads_{};
};

template <class Kind>
class OfKind : public testing::Test {};
using Kinds = testing::Types<HelixKind<T>, ChainKind<T>, ClothoidKind<T>>;
TYPED_TEST_SUITE(OfKind, Kinds);

// With e = 1e-3 over the largest entry of x, differences err by e^4 of fifth derivatives,
// some 1e-12 of the terms, and by eps/e of them, 1e-16 |x|/1e-3 = 1e-10 at |x| = 1000.
TYPED_TEST(OfKind, CorrectionsSolveTheDerivativesOfTheResidual) {
  for (const bool twist : {true, false}) {
    for (const bool loaded : {true, false}) {
      for (const double size : {0.5, 2.0}) {
        EXPECT_LE(Loaded<TypeParam>(twist, loaded, size).left(), 1e-8)
            << twist << loaded << size;
      }
    }
  }
}

// The forces of the loads are a tenth of all, so their derivatives are no less.
TYPED_TEST(OfKind, DifferencesTellWhatIsMissing) {
  EXPECT_GT(Loaded<TypeParam>(true, true, 2.0).left(true), 1e-2);
}

}  // namespace tress::test_exact_kernel
