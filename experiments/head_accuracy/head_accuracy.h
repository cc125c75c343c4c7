#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/head_accuracy/search.h"
#include "experiments/run/experiment.h"
#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::head_accuracy {

std::span<const Column> head_columns();

struct StudyPlan {
  Comparison comparison;
  SearchPlan search;
  std::vector<double> targets;  // errors over the length of a hair, descending
  Over over = Over::p95;
  double budget_s = 0;  // wall time per frame; 0: not asked
};

/// All rows of one head, each beginning with the cells of `identity`:
///
///     cheapest   the cheapest run that meets a target
///     every      the same elements, steps and bits with every hair simulated
///     bits       the same run with numbers of 64 bits
///     budget     the most accurate run within the given time per frame
///     as_given   elements, step and guides of the scene file
///     front      other runs that none beats in both error and time
///
/// A run meets a target when error + gap of the references <= target and its neighbours
/// do so for 1.5 times the target. Where none does the row has the nearest run and the
/// status not_met.
std::vector<Row> study_head(const Scene& given, const StudyPlan& plan,
                            const Row& identity, const Deadline& deadline);

/// Answers keep their targets, and no run in the table that meets one takes less work.
void check_claims(const std::vector<Row>& rows, Verdicts& verdicts);

/// Returns the advice for each target and budget, one sentence each.
std::vector<std::string> advice(const std::vector<Row>& rows);

/// The scene with the guides, elements and step of a row, for `simulate`; empty if it has
/// too many strands to be held at once.
std::string advised_text(const Scene& given, const Row& row);

}  // namespace tress::experiments::head_accuracy
