#pragma once

#include <string>

#include "contract/layers.h"
#include "contract/system.h"

namespace tress::models {
class SupportedSystem;
}

namespace tress::simulation {

/// Result of the search for a start on supports at t = 0.
struct SupportedStart {
  bool held = false;  // whether it has supports
  double moved = 0;   // m, of the supported point farthest from its place before
  double turned = 0;  // rad, of the held section farthest from its direction before
  int steps = 0;      // of the search; 0: the strand began on its supports
  double unbalanced =
      0;  // largest force of the start over the weight that supports carry
};

/// Places a strand on its supports at t = 0 and lets the system begin there.
///
/// A strand whose points are on their supports keeps its shape; its velocity alone is
/// projected onto the supports' motion. Any other strand begins at rest in an
/// equilibrium. The search bends the strand a little. Steps of backward Euler at t = 0,
/// each from rest, lead its points to their places: pseudo-transient continuation [Kelley
/// & Keyes 1998, SIAM J. Numer. Anal. 35, 508]. Springs from the
/// shape before each step spread the change over the strand; they fade at the end. Cost:
/// 30 to 100 steps, each with about four matrices.
///
/// `system` is a SupportedSystem. `where` is named in the InputError if no shape is
/// found.
SupportedStart begin_on_supports(System& system, const std::string& where);

/// Finds the equilibrium in which a strand comes to rest from its initial state, by the
/// steps of begin_on_supports(). The strand stays straight where it is straight and the
/// loads bend it nowhere. Writes its coordinates to q; returns false if none is found.
bool come_to_rest(models::SupportedSystem& system, InOut q);

}  // namespace tress::simulation
