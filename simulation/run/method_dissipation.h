#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "contract/basics.h"
#include "contract/forms/energetics.h"

namespace tress::simulation {

/// Energy of a motion that its loads do not account for, J.
struct MethodDissipation {
  double dissipated = 0;  // by the method; < 0: created
  double uncertain = 0;   // estimated bound of the error of `dissipated`
  double available = 0;   // highest energy above the lowest potential, and work put in
  /// Bound of the way of the centre of mass over the length: the largest of a system.
  double moved = 0;

  /// Returns the part of the available energy that the method dissipated.
  double share() const { return available > 0 ? dissipated / available : 0; }
  /// Returns what the account proves of the dissipation: 0 where it decides nothing, J.
  double proven() const { return std::max(0.0, std::abs(dissipated) - uncertain); }
  /// Adds the energies of another system.
  MethodDissipation& operator+=(const MethodDissipation& other) {
    dissipated += other.dissipated;
    uncertain += other.uncertain;
    available += other.available;
    moved = std::max(moved, other.moved);
    return *this;
  }
};

/// Reason why strands that touch have no account.
inline constexpr std::string_view touching_strands =
    "energy passes between strands that touch";

/// Keeps the account of one system. With the power P of everything outside the energy E
/// (Energetics::power), a solution of the equations has E(0) + integral of P = E(t). The
/// integral is taken by the trapezoidal rule over the intervals h between two calls.
/// Where P is monotone in an interval, the rule errs there by h |P(t + h) - P(t)|/2 at
/// most: any value between the two rectangles is possible. `uncertain` is twice the sum
/// of these bounds, since P may turn within an interval: a curl in steps of 30 ms errs
/// by 1.6 times the sum.
class DissipationMeter {
 public:
  /// Starts the account; power in W.
  void start(const Energy& energy, double power) {
    began_ = total_ = highest_ = energy.total();
    lowest_ = energy.potential;
    passed_ = given_ = uncertain_ = way_ = 0;
    kinetic_ = energy.kinetic;
    power_ = power;
  }
  /// h (s) after the last call. `done`: work in the interval that `power` leaves out, and
  /// the bound of its error (J).
  void gather(double h, const Energy& energy, double power, double done = 0,
              double uncertain = 0) {
    const double work = h * (power_ + power) / 2 + done;
    passed_ += work;
    given_ += std::max(0.0, work);
    uncertain_ += h * std::abs(power - power_) + uncertain;
    way_ += h * std::sqrt(2 * std::max({0.0, kinetic_, energy.kinetic}));
    power_ = power;
    kinetic_ = energy.kinetic;
    total_ = energy.total();
    lowest_ = std::min(lowest_, energy.potential);
    highest_ = std::max(highest_, total_);
  }
  /// Goes on after a change of the energy that is none of the motion's.
  void shift(const Energy& energy, double power) {
    const double change = energy.total() - total_;
    began_ += change;
    highest_ += change;
    lowest_ += energy.potential - (total_ - kinetic_);
    total_ = energy.total();
    kinetic_ = energy.kinetic;
    power_ = power;
  }
  /// Returns the dissipation since start(). `inertia`: square root of the mass times the
  /// length, kg^0.5 m, by which a way is relative.
  MethodDissipation dissipation(double inertia) const {
    return {began_ + passed_ - total_, uncertain_, highest_ - lowest_ + given_,
            way_ / inertia};
  }

  static constexpr std::size_t remembered = 10;  // numbers
  /// Returns all data gathered since start().
  std::array<double, remembered> memory() const {
    return {began_, total_,     lowest_, highest_, passed_,
            given_, uncertain_, way_,    kinetic_, power_};
  }
  /// Restores what memory() returned.
  void recall(In memory) {
    std::size_t k = 0;
    for (double* const value : {&began_, &total_, &lowest_, &highest_, &passed_, &given_,
                                &uncertain_, &way_, &kinetic_, &power_}) {
      *value = memory[k++];
    }
  }

 private:
  double began_ = 0, total_ = 0, lowest_ = 0, highest_ = 0;  // J
  // J: integral of the power, of its positive part, and the bound of the error.
  double passed_ = 0, given_ = 0, uncertain_ = 0;
  double way_ = 0;                  // kg^0.5 m, integral of sqrt(2 kinetic energy)
  double kinetic_ = 0, power_ = 0;  // J and W, at the last call
};

}  // namespace tress::simulation
