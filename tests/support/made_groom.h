#pragma once

#include <cstdint>

#include "simulation/groom/polylines.h"

namespace tress::testing_support {

/// Hair as a scan would have it, without being one: locks that leave the head, bend down
/// over some length and close in on each other, their hairs curled about the lock and
/// with frizz of their own, cut to unequal lengths into unequal segments. In m, z up.
struct MadeGroom {
  int locks = 10, hairs = 10;  // of each lock
  int points = 100;
  double length = 0.25, length_variation = 0.15;
  double tilt = 0.6;          // of the root above the horizontal, rad
  double fan = 0.5;           // of root directions about the vertical, rad
  double bend_length = 0.06;  // along which a lock turns down
  double tie = 0.015;         // radius of the disk of roots
  double lock = 0.006;        // radius of a lock at its root; a quarter at its tip
  double curl_radius = 0, curl_pitch = 0.04;
  double wave_rad = 0.3, wave_length = 0.08;  // a lock's own bends, either direction
  double frizz = 3e-4, frizz_length = 0.02;   // amplitude and wavelength of a hair's own
};

/// Hair over the forehead, nearly straight: it turns by some two radians.
MadeGroom bangs();
/// Short curls of about five radians.
MadeGroom curls();
/// A ponytail of long wavy hair with curl and frizz.
MadeGroom ponytail();

simulation::Polylines made(const MadeGroom& groom, std::uint64_t seed);

}  // namespace tress::testing_support
