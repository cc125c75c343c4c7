#pragma once

#include <algorithm>
#include <array>

#include "contract/basics.h"
#include "contract/forms/energetics.h"

namespace tress::simulation {

/// Energy of a motion that its loads do not account for, J.
struct MethodDissipation {
  double dissipated = 0;  // by the method; < 0: created
  double available = 0;   // largest energy above the lowest potential, and work put in

  /// Returns the part of the available energy that the method dissipated.
  double share() const { return available > 0 ? dissipated / available : 0; }
  /// Adds the energies of another system.
  MethodDissipation& operator+=(const MethodDissipation& other) {
    dissipated += other.dissipated;
    available += other.available;
    return *this;
  }
};

/// Keeps the account of one system. With the power P of everything outside the energy E
/// (Energetics::power), a solution of the equations has E(0) + integral of P = E(t). The
/// integral is taken by the trapezoidal rule over the intervals between two calls.
class DissipationMeter {
 public:
  /// Starts the account; power in W.
  void start(const Energy& energy, double power) {
    began_ = total_ = energy.total();
    lowest_ = energy.potential;
    largest_ = energy.kinetic;
    passed_ = given_ = 0;
    power_ = power;
  }
  /// h (s) after the last call.
  void gather(double h, const Energy& energy, double power) {
    const double work = h * (power_ + power) / 2;
    passed_ += work;
    given_ += std::max(0.0, work);
    power_ = power;
    total_ = energy.total();
    lowest_ = std::min(lowest_, energy.potential);
    largest_ = std::max(largest_, total_ - lowest_);
  }
  /// Returns the dissipation since start().
  MethodDissipation dissipation() const {
    return {began_ + passed_ - total_, largest_ + given_};
  }

  static constexpr std::size_t remembered = 7;  // numbers
  /// Returns all data gathered since start().
  std::array<double, remembered> memory() const {
    return {began_, total_, lowest_, largest_, passed_, given_, power_};
  }
  /// Restores what memory() returned.
  void recall(In memory) {
    std::size_t k = 0;
    for (double* const value :
         {&began_, &total_, &lowest_, &largest_, &passed_, &given_, &power_}) {
      *value = memory[k++];
    }
  }

 private:
  double began_ = 0, total_ = 0, lowest_ = 0, largest_ = 0;  // J
  double passed_ = 0, given_ = 0;  // J: integral of the power, and of its positive part
  double power_ = 0;               // W, at the last call
};

}  // namespace tress::simulation
