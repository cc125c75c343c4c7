#include "experiments/family/populations.h"

namespace tress::experiments::family {

std::vector<Rod> draw_drives(Family family, Hypercube& u) {
  constexpr Range locomotion{2, 3.2}, others{1, 2.6};  // 1/s
  const auto drive = u.next(), level = u.next(), frequency = u.next();
  std::vector<Rod> all(drive.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].family = family;
    all[i].number = static_cast<int>(i) + 1;
    all[i].drive = static_cast<Drive>(drives * drive[i]);
    all[i].level = level[i];
    const bool shaken = all[i].drive == Drive::shake;
    all[i].frequency = (shaken ? locomotion : others).at(frequency[i]);
  }
  return all;
}

std::vector<Rod> latin_hypercube(Family family, int count, std::uint64_t seed) {
  return family == Family::hair ? draw_hair(count, seed) : draw_rods(count, seed);
}

}  // namespace tress::experiments::family
