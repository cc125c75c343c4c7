#pragma once

#include <vector>

#include "contract/basics.h"
#include "simulation/files/row.h"

namespace tress::experiments {

/// Entry-wise distances between a value and its reference.
struct ErrorNorms {
  double max = 0;  // largest |value - reference|, in the unit of the entries
  double rms = 0;
  double relative = 0;  // largest |value - reference| / scale
};

/// `scale` has one entry per value (System::scale), or one for all.
ErrorNorms error_norms(In value, In reference, In scale);

/// Returns the significant correct digits, -log10 of the largest componentwise relative
/// error. The definition is that of the Test Set for IVP Solvers (Mazzia and Magherini,
/// Bari, release 2.4); entries whose reference is zero are left out, as there. At most
/// 16.
double scd(In value, In reference);

/// Two independent references for one answer and their distance. An error is trusted when
/// it is at least `margin` times the gap.
class ReferenceGap {
 public:
  static constexpr double margin = 10;

  /// `independent` is from another family: of integrators for time error, of models for
  /// total error. Norm: the largest difference over scale.
  ReferenceGap(In reference, In independent, In scale);

  double gap() const { return gap_; }
  bool trusts(double relative_error) const { return relative_error >= margin * gap_; }

  /// Marks an ok row `below_reference` when its error is not resolved by the gap.
  void mark(Row& row, double relative_error) const;

 private:
  double gap_;
};

}  // namespace tress::experiments
