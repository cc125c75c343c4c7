#include "models/motion/root_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "contract/input_error.h"

namespace tress::models {
namespace {

using std::numbers::pi;

void check_duration(double duration) {
  if (std::isfinite(duration) && duration > 0) return;
  throw InputError("duration is not a positive number", "signal of a root motion",
                   "give a number > 0 in s");
}

}  // namespace

Signal sine(double amplitude, double frequency) {
  return [amplitude, w = 2 * pi * frequency](double t) -> SignalValue {
    const double value = amplitude * std::sin(w * t);
    return {value, amplitude * w * std::cos(w * t), -w * w * value};
  };
}

Signal one_minus_cosine(double amplitude, double frequency) {
  return [amplitude, w = 2 * pi * frequency](double t) -> SignalValue {
    const double cosine = std::cos(w * t);
    return {amplitude * (1 - cosine), amplitude * w * std::sin(w * t),
            amplitude * w * w * cosine};
  };
}

Signal smooth_step(double height, double t0, double duration) {
  check_duration(duration);
  const auto value = [=](double t) -> SignalValue {
    const double x = std::clamp((t - t0) / duration, 0.0, 1.0);
    const double rest = 1 - x;
    return {height * x * x * x * (10 + x * (6 * x - 15)),
            height / duration * 30 * x * x * rest * rest,
            height / (duration * duration) * 60 * x * rest * (1 - 2 * x)};
  };
  return {value, {t0, t0 + duration}};
}

Signal stop(double speed, double t0, double duration) {
  check_duration(duration);
  const auto value = [=](double t) -> SignalValue {
    const double before = std::min(t - t0, 0.0);
    const double x = std::clamp((t - t0) / duration, 0.0, 1.0);
    const double x2 = x * x;
    return {speed * (before + duration * x * (1 - x2 * (1 - x / 2))),
            speed * (1 - x2 * (3 - 2 * x)), -speed / duration * 6 * x * (1 - x)};
  };
  return {value, {t0, t0 + duration}};
}

Signal sum(Signal a, Signal b) {
  std::vector<double> breakpoints = a.breakpoints();
  breakpoints.insert(breakpoints.end(), b.breakpoints().begin(), b.breakpoints().end());
  const auto value = [a = std::move(a), b = std::move(b)](double t,
                                                          double since) -> SignalValue {
    const SignalValue x = a(t, since), y = b(t, since);
    return {x.value + y.value, x.rate + y.rate, x.acceleration + y.acceleration};
  };
  return {value, std::move(breakpoints)};
}

Signal there_and_back(double height, double duration) {
  return sum(smooth_step(height, 0, duration), smooth_step(-height, duration, duration));
}

RootPose RootMotion::at(double t, double last) const {
  const double piece = std::isnan(last) ? t : last;
  RootPose pose;
  pose.frame = frame;
  const Vec c = centre.value_or(position);
  Vec arm = position - c;
  for (const Part& part : rotations) {
    const SignalValue angle = part.signal(t, piece);
    const Vec axis =
        (1 / std::sqrt(dot(part.direction, part.direction))) * part.direction;
    const Frame turn = rotation(axis, angle.value);
    const Vec spin = angle.rate * axis;
    const Vec carried = turn * pose.omega;
    pose.alpha = turn * pose.alpha + angle.acceleration * axis + cross(spin, carried);
    pose.omega = carried + spin;
    pose.frame = turn * pose.frame;
    arm = turn * arm;
  }
  pose.x = c + arm;
  pose.v = cross(pose.omega, arm);
  pose.a = cross(pose.alpha, arm) + cross(pose.omega, pose.v);
  for (const Part& part : translations) {
    const SignalValue along = part.signal(t, piece);
    pose.x = pose.x + along.value * part.direction;
    pose.v = pose.v + along.rate * part.direction;
    pose.a = pose.a + along.acceleration * part.direction;
  }
  return pose;
}

RootMotion carried(RootMotion by, const StrandPlace& place) {
  const Vec c = by.centre.value_or(by.position);
  // At t = 0: x = c + moved + turn (x at rest - c).
  by.centre = by.position = c;
  by.frame = Frame{};
  const RootPose begin = by.at(0);
  by.position = c + begin.frame.back(place.x - begin.x);
  by.frame = {begin.frame.back(place.frame.e0), begin.frame.back(place.frame.e1),
              begin.frame.back(place.frame.e2)};
  return by;
}

double RootMotion::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto* parts : {&translations, &rotations}) {
    for (const Part& part : *parts) {
      const auto& all = part.signal.breakpoints();
      const auto after = std::ranges::upper_bound(all, t);
      if (after != all.end()) next = std::min(next, *after);
    }
  }
  return next;
}

double RootMotion::next_teleport(double t) const {
  const auto after = std::ranges::upper_bound(teleports, t);
  return after == teleports.end() ? std::numeric_limits<double>::infinity() : *after;
}

void check(const RootMotion& motion, const std::string& where) {
  if (!is_finite(motion.position) || !is_finite(motion.centre.value_or(Vec{}))) {
    throw InputError("position or centre is not finite", where, "give finite numbers");
  }
  if (!is_rotation(motion.frame)) {
    throw InputError("frame is not a rotation", where,
                     "give three orthogonal unit axes, right-handed");
  }
  const auto check_parts = [&where](const std::vector<RootMotion::Part>& parts) {
    for (const RootMotion::Part& part : parts) {
      if (!part.signal || !is_finite(part.direction)) {
        throw InputError("a part has no signal or no finite direction", where,
                         "give both");
      }
    }
  };
  check_parts(motion.translations);
  check_parts(motion.rotations);
  for (const RootMotion::Part& part : motion.rotations) {
    if (dot(part.direction, part.direction) == 0) {
      throw InputError("a rotation has the axis 0", where, "give a direction");
    }
  }
}

}  // namespace tress::models
