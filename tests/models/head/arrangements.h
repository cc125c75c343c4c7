#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "models/head/head.h"

namespace tress::testing_support {

/// Packs of this build; those of 512 bits are in builds of ./tress test --all. `narrow`:
/// whether single precision is among them.
inline std::vector<models::HeadPack> packs_of_build(bool narrow = true) {
  const auto all = models::compiled_packs();
  std::vector<models::HeadPack> packs(all.begin(), all.end());
  std::erase_if(packs, [narrow](const models::HeadPack& pack) {
    return !narrow && pack.number == models::HeadNumber::float32;
  });
  return packs;
}
/// The longest of them.
inline models::HeadPack longest_doubles() {
  return models::longest_pack(models::HeadNumber::float64);
}
inline models::HeadPack longest_floats() {
  return models::longest_pack(models::HeadNumber::float32);
}

/// Points of all strands.
inline std::vector<double> points(const models::Head& all, double t) {
  std::vector<double> x(all.strands() * all.numbers());
  for (std::size_t b = 0, done = 0; b < all.blocks(); ++b) {
    const std::size_t size = all.strands_of(b) * all.numbers();
    all.positions(b, t, std::span(x).subspan(done, size));
    done += size;
  }
  return x;
}

/// One of the ways to step the same strands, which must not show in their bits.
struct Arrangement {
  models::HeadPack pack;
  std::size_t together = 100;  // blocks in one call
};

/// Every number of lanes, of which the longest has other instructions where there are
/// more, and two of them by few blocks in a call.
inline std::vector<Arrangement> arrangements() {
  using enum models::HeadNumber;
  std::vector<Arrangement> all{{{float64, 4}, 1}, {{float64, 1}, 2}};
  for (const models::HeadPack& pack : packs_of_build(false)) all.push_back({pack});
  return all;
}

}  // namespace tress::testing_support
