#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "experiments/family/hair.h"
#include "simulation/files/row.h"

namespace tress::experiments::family {

/// A statement of the README about one hair, to be tested on all.
struct Claim {
  std::string_view id;
  std::string_view statement;  // a sentence, true of a hair where the claim holds
  std::string_view value;      // meaning of the column `value`, with unit
};

/// One computation on one hair that answers one or more claims. Bounded by numbers of
/// steps, never by time.
struct Study {
  std::string_view id;
  std::span<const Claim> claims;
  /// Rows in the order of `claims`. `row`: identity and hair are set.
  std::vector<Row> (*run)(const Hair& hair, const Row& row);
};

std::span<const Study> studies();

/// Options::max_work of a run: ten times the work of Newton's method with five iterations
/// in every step. A run beyond it counts as without an answer.
double enough_work(System& system, double t_end, double dt);

/// A row that answers `claim`: its value, and whether the claim holds for this hair.
Row answer(Row row, const Claim& claim, double value, bool holds);

/// A row without an answer, with the reason.
Row no_answer(Row row, const Claim& claim, std::string_view status,
              std::string_view reason);

extern const Study stable_steps, twist, bdf_order, equal_accuracy;

}  // namespace tress::experiments::family
