#pragma once

#include <memory>
#include <string_view>

#include "integrators/linear/linear_solver.h"

namespace tress {

struct KktReport {
  std::string_view solver = "none";
  int rank_deficiency = 0;
  double condition = 0;
};

/// Solves [S, -G^T; H, 0] [x; y] = [b; c], S (n x n), G and H (m x n) on one pattern.
class Kkt {
 public:
  /// `gt`: pattern of G^T (n x m), column k = gradient of constraint k.
  Kkt(LinearKind kind, const Pattern& s, const Pattern& gt);
  ~Kkt();
  Status factor(In s, In gt, In ht) noexcept;
  Status solve(InOut b, InOut c) noexcept;  // b becomes x, c becomes y
  const KktReport& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tress
