#pragma once

namespace tress {

/// A planar inextensible rod clamped horizontally under its own weight: with theta the
/// angle below the horizontal and s from the clamp, over the length,
///
///     theta'' = -Gamma (1 - s) cos theta,   theta(0) = 0,   theta'(1) = 0,
///     width = int cos theta ds,   height = int sin theta ds.
struct Cantilever {
  double width, height;  // of the tip from the clamp, over the length
};

/// By shooting from the tip, whose angle is what is sought; 1e-10 of height/width for
/// Gamma in (0, 1e5]. Throws InputError on others.
Cantilever cantilever(double gamma);

}  // namespace tress
