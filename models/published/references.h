#pragma once

#include <string_view>

#include "contract/basics.h"

namespace tress::models {

/// State at the end time of a published problem, at its default parameters (SI).
///
/// `digits` indicate the accuracy of the printed numbers: the error of the worst entry,
/// relative to its size or its System::scale if that is larger. The reference are runs of
/// this library that are converged to 1e-12 (tests/models/published). The printed run is
/// the limit:
/// - andrews_squeezer: the printed velocities violate G v = 0 by 2e-9 m/s, and T + V -
///   torque beta by 2e-10 J; converged runs keep both to 1e-13.
/// - slider_crank: rigid and lateral coordinates agree to 9 and 6 digits. The
///   longitudinal modes (7e3 and 2.5e4 rad/s, undamped in the problem) were damped in the
///   printed run. Radau IIA of order 5 shows the same loss at steps near 2e-5 s.
/// - wheelset: two methods with 160000 steps agree to 7 digits with each other, and to 6
///   with the print.
struct PublishedEnd {
  std::string_view model;   // catalogue id
  double t;                 // s
  In q;                     // (n); wheelset: the first five, others are not printed
  In v;                     // (n)
  In a;                     // (n), empty where not printed
  In lambda;                // (m), signs of r - G^T lambda = 0; empty without constraints
  int digits_q;             // correct digits of q
  int digits_v;             // correct digits of v
  std::string_view source;  // publication
};

/// The published end state of a model, or null.
const PublishedEnd* published_end(std::string_view model);

}  // namespace tress::models
