#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>

/// Tables of effects of random scenes. Each is drawn with some probability, else empty.
namespace tress::testing_support {

/// Random numbers of a seed.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  bool chance(double p) { return uniform(0, 1) < p; }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) * std::ldexp(1.0, -64);
  }
  double of_size(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  template <class T, std::size_t n>
  T one_of(const T (&all)[n]) {
    return all[random_() % n];
  }
  template <class List>
  const auto& of(const List& list) {
    return list[random_() % std::size(list)];
  }

 private:
  std::mt19937_64 random_;
};

/// A body that strands touch, with regularised friction.
std::string body(Draw& draw);
/// A sphere that moves towards strands of this length by its own keyframes.
std::string moving_body(Draw& draw, double length);
/// Wind; always drawn.
std::string wind(Draw& draw);
/// Effects of single strands that are not drawn elsewhere, for strands of this length
/// (m).
std::string further(Draw& draw, double length);
/// Moments, natural shapes that change, and points that are held.
std::string driven(Draw& draw);

}  // namespace tress::testing_support
