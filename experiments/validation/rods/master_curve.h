#pragma once

#include "contract/layers.h"

namespace tress::experiments::validation {

/// Planar inextensible rod clamped horizontally, under its own weight and a force P down
/// on its tip. Its angle below the horizontal is theta, at the arc length s from the
/// clamp, over the length. With Gamma = rho g S L^3/EI and alpha = P L^2/EI,
///
///     theta'' = -(Gamma (1 - s) + alpha) cos theta,   theta(0) = 0,   theta'(1) = 0,
///     width = int cos theta ds,   height = int sin theta ds.
///
/// alpha = 0: the master curve of [Romero et al. 2021]; Gamma = 0: [Bisshopp & Drucker
/// 1945].
struct Cantilever {
  double width, height;  // of the tip from the clamp, over the length
  double tip_angle;      // theta, rad
};

/// Solves the cantilever by shooting from the tip for its unknown angle; relative
/// accuracy 1e-10 for Gamma and alpha in [0, 1e5], not both 0. Throws InputError
/// otherwise.
Cantilever cantilever(double gamma, double alpha);

}  // namespace tress::experiments::validation
