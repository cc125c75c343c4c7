#include "tests/support/made_groom.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/groom/frames.h"
#include "simulation/groom/random.h"

namespace tress::testing_support {
namespace {

using simulation::Random;
constexpr double full_turn = 2 * std::numbers::pi;

/// A sum of a few waves of about this wavelength, of root mean square 1.
class Noise {
 public:
  Noise(Random& random, double wavelength) {
    for (auto& [rate, phase] : waves_) {
      rate = full_turn / wavelength * (0.5 + random.uniform());
      phase = full_turn * random.uniform();
    }
  }
  double at(double s) const {
    double sum = 0;
    for (const auto& [rate, phase] : waves_) sum += std::sin(rate * s + phase);
    return sum * std::numbers::sqrt2 / 2;
  }

 private:
  struct Wave {
    double rate, phase;
  } waves_[4];
};

/// The axis of a lock: a step every tenth of a millimetre or so, with twistless frames.
struct Axis {
  std::vector<Vec> x;
  std::vector<Frame> frame;
};

Axis axis_of(const MadeGroom& groom, const Vec& root, double azimuth, Random& random,
             std::size_t steps) {
  const Noise aside(random, groom.wave_length), up(random, groom.wave_length);
  const double longest = groom.length * (1 + groom.length_variation);
  const double h = longest / static_cast<double>(steps);
  Axis axis;
  Vec x = root;
  Frame frame{};
  for (std::size_t i = 0; i <= steps; ++i) {
    const double s = h * static_cast<double>(i);
    const double down = std::numbers::pi / 2 + groom.tilt;
    const double tilt = groom.tilt - down * (1 - std::exp(-s / groom.bend_length)) +
                        groom.wave_rad * (up.at(s) - up.at(0));
    const double about = azimuth + groom.wave_rad * (aside.at(s) - aside.at(0));
    const Vec t{std::cos(tilt) * std::cos(about), std::cos(tilt) * std::sin(about),
                std::sin(tilt)};
    frame = i == 0 ? simulation::frame_of(t, simulation::across(t, {0, 0, 1}))
                   : simulation::carried(frame, h * t, t);
    axis.x.push_back(x);
    axis.frame.push_back(frame);
    x = x + h * t;
  }
  return axis;
}

}  // namespace

MadeGroom bangs() {
  MadeGroom groom;
  groom.length = 0.12;
  groom.tilt = 0.2;
  groom.bend_length = 0.05;
  groom.tie = 0.04;
  groom.wave_rad = 0.12;
  groom.wave_length = 0.1;
  groom.frizz = 1e-4;
  groom.frizz_length = 0.04;
  return groom;
}

MadeGroom curls() {
  MadeGroom groom = bangs();
  groom.length = 0.05;
  groom.bend_length = 0.02;
  groom.curl_radius = 4e-3;
  groom.curl_pitch = 0.025;
  return groom;
}

MadeGroom ponytail() {
  MadeGroom groom;
  groom.locks = 10;
  groom.hairs = 12;
  groom.points = 64;
  groom.length = 0.3;
  groom.curl_radius = 3e-3;
  groom.curl_pitch = 0.07;
  return groom;
}

simulation::Polylines made(const MadeGroom& groom, std::uint64_t seed) {
  simulation::Polylines all;
  constexpr std::size_t steps = 2000;
  for (int lock = 0; lock < groom.locks; ++lock) {
    Random random(seed, static_cast<std::uint64_t>(lock));
    const double away = groom.tie * std::sqrt(random.uniform());
    const double around = full_turn * random.uniform();
    const double azimuth = groom.fan * (2 * random.uniform() - 1);
    const Vec root{0, away * std::cos(around), away * std::sin(around)};
    const Axis axis = axis_of(groom, root, azimuth, random, steps);
    const double phase = full_turn * random.uniform();
    for (int hair = 0; hair < groom.hairs; ++hair) {
      const double share = (1 + groom.length_variation * (2 * random.uniform() - 1)) /
                           (1 + groom.length_variation);
      const double off = groom.lock * std::sqrt(random.uniform());
      const double angle = full_turn * random.uniform();
      const double own_phase = phase + 0.3 * random.normal();
      const double warp = 0.6 * random.uniform();
      const Noise first(random, groom.frizz_length), second(random, groom.frizz_length);
      for (int i = 0; i < groom.points; ++i) {
        const double u = static_cast<double>(i) / (groom.points - 1);
        // Segments are up to four times as long at one end as at the other.
        const double part = u + warp * u * (u - 1);
        const double at = share * part * static_cast<double>(steps);
        const auto k = std::min(static_cast<std::size_t>(at), steps - 1);
        const double f = at - static_cast<double>(k);
        const double s = share * part * groom.length * (1 + groom.length_variation);
        const double closing = off * (1 - 0.75 * part);
        const double rise = 1 - std::exp(-s / groom.curl_pitch);
        const double turned = full_turn * s / groom.curl_pitch + own_phase;
        const double frizz = groom.frizz * (1 - std::exp(-s / groom.frizz_length));
        const double a = closing * std::cos(angle) +
                         groom.curl_radius * rise * std::cos(turned) +
                         frizz * first.at(s);
        const double b = closing * std::sin(angle) +
                         groom.curl_radius * rise * std::sin(turned) +
                         frizz * second.at(s);
        const auto place = [&](std::size_t j) {
          return axis.x[j] + a * axis.frame[j].e1 + b * axis.frame[j].e2;
        };
        all.points.push_back((1 - f) * place(k) + f * place(k + 1));
      }
      all.end_strand(all.size(), 0);
    }
  }
  return all;
}

}  // namespace tress::testing_support
