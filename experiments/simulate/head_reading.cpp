#include "experiments/simulate/head_reading.h"

#include <algorithm>
#include <array>
#include <bit>

#include "experiments/simulate/head_series.h"

namespace tress::experiments::scene_runs {

std::vector<double> HeadReading::series(HeadRun& run, double t) {
  using models::HeadEnergy;
  constexpr std::size_t numbers = sizeof(HeadEnergy) / sizeof(double);
  run.energies(t, energies_);
  run.potentials(t, potentials_);
  const std::size_t effects = run.effects(), each = numbers + effects + 1;
  using Numbers = std::array<double, numbers>;
  HeadSeriesRow row;
  std::vector<double> all;
  const Head& head = run.head();
  by_chunks(run, [&](HeadRun::Numbers strands) {
    run.collect(
        strands, each,
        [&](std::size_t block, std::span<double> to) {
          for (std::size_t k = 0; k < head.strands_of(block); ++k) {
            const std::size_t place = block * head.strands_of(0) + k;
            std::ranges::copy(std::bit_cast<Numbers>(energies_[place]), &to[each * k]);
            std::copy_n(&potentials_[effects * place], effects, &to[each * k + numbers]);
            to[each * (k + 1) - 1] = head.lost(place) ? 1 : 0;
          }
        },
        all);
    for (std::size_t i = 0; i < all.size(); i += each) {
      Numbers one;
      std::copy_n(&all[i], numbers, one.begin());
      row.add(std::bit_cast<HeadEnergy>(one),
              std::span(all).subspan(i + numbers, effects), all[i + each - 1] != 0);
    }
  });
  return row.at(t);
}

void HeadReading::frame(HeadRun& run, double t, bool all, HeadFrames* frame) const {
  std::vector<double> x;
  if (all) {
    by_chunks(run, [&](HeadRun::Numbers strands) {
      run.positions(t, strands, x);
      if (frame != nullptr) frame->take(run.crew(), strands.front(), x);
    });
  }
  run.positions(t, shown_, x);
  if (frame != nullptr) frame->take_shown(x);
}

}  // namespace tress::experiments::scene_runs
