#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/models/supports/held_strand.h"

/// Strands on compliant supports, under moments, and with natural shapes that move.
namespace tress::testing_support {

/// What may drive a strand in a test.
enum class StrandDrive {
  compliant_ball,
  compliant_clamp,
  dead_moment,
  follower,
  natural
};

inline std::string name_of(StrandDrive drive) {
  constexpr const char* names[] = {"CompliantBall", "CompliantClamp", "DeadMoment",
                                   "Follower", "Natural"};
  return names[static_cast<int>(drive)];
}

/// Typical moment EI/L of a model's strand, N m.
inline double typical_moment(const std::string& model, const ModelSettings& settings) {
  const Strand of = models::strand(parameters_of(model, settings));
  return stiffness(of, of.segments.front()).y / of.length();
}

/// A drive of the tip of a model, strong enough to bend the strand, that changes in
/// `time`. Damping is `damped` over that of the time of a typical motion.
inline std::unique_ptr<SupportedSystem> driven(const std::string& model,
                                               const ModelSettings& settings,
                                               StrandDrive drive, double time,
                                               bool damped = true) {
  auto strand = make_model(model, settings);
  const Strand of = models::strand(parameters_of(model, settings));
  const double length = of.length(), moment = typical_moment(model, settings);
  const int tip = static_cast<int>(of.segments.size());
  std::vector<Support> supports;
  StrandDrives drives;
  if (drive == StrandDrive::compliant_ball || drive == StrandDrive::compliant_clamp) {
    const Vec way = (0.1 * length) * Vec{-1, 1, 2};
    Support one = drive == StrandDrive::compliant_clamp
                      ? clamp_of_tip(*strand, model, settings, HeldPart::frame, way, time)
                      : support(tip, places_at_start(*strand).back(), way, time);
    if (drive == StrandDrive::compliant_clamp) {
      one.path.rotations.push_back({{0, 1, 1}, rests({0, time}, {0, 0.4})});
    }
    one.compliance = {3 * moment / (length * length), 0, 2 * moment, 0};
    if (damped) {
      one.compliance.damping = 0.01 * one.compliance.stiffness;
      one.compliance.turn_damping = 0.01 * one.compliance.turn_stiffness;
    }
    supports.push_back(std::move(one));
  }
  const FactorOverTime factor({{0.0, 0.0}, {time, 1.0}}, "test");
  if (drive == StrandDrive::dead_moment) {
    drives.moments.push_back({tip, moment * Vec{0.3, -0.8, 0.5}, {}, factor});
  }
  if (drive == StrandDrive::follower) {
    drives.moments.push_back({tip, {}, moment * Vec{0.3, -0.8, 0.5}, factor});
  }
  if (drive == StrandDrive::natural) {
    const std::vector<double> from = natural_strains(*strand)->natural();
    std::vector<double> to = from;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = 0.3 * from[i];
    drives.natural = NaturalMotion({{0, from}, {time, to}}, {});
  }
  return std::make_unique<SupportedSystem>(std::move(strand), std::move(supports),
                                           std::move(drives));
}

}  // namespace tress::testing_support
