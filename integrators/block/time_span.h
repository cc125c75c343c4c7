#pragma once

namespace tress::integrators {

/// An interval of time, or a part of one, whose length over the whole is a power of two:
/// products with it are exact.
struct TimeSpan {
  double t = 0, h = 0;           // s; of the whole
  const TimeSpan* of = nullptr;  // of which this is a part, if it is one:
  double begin = 0, part = 1;    // from begin on, of its length

  /// Returns a part of a span, which must outlive it: `part` of its length from `begin`
  /// on.
  static TimeSpan part_of(const TimeSpan& whole, double begin, double part) {
    return {.of = &whole, .begin = begin, .part = part};
  }
  /// Returns the time (s) at the fraction x of the span, 0 to 1.
  double at(double x) const {
    return of == nullptr ? t + x * h : of->at(begin + x * part);
  }
  /// Returns the length (s) of the fraction x of the span.
  double length(double x) const { return of == nullptr ? x * h : of->length(x * part); }
};

}  // namespace tress::integrators
