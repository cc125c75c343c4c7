#pragma once

#include <span>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/validation/test.h"

/// The table of validation: its rows and the claims about them.
namespace tress::experiments::validation {

std::span<const Column> validation_columns();
/// Returns the description of each test, its source, and the reasons for its
/// tolerances.
std::vector<Gloss> validation_glossary();

/// --set keys: tests, and values of their parameters.
std::span<const Parameter> validation_settings();

/// For every test and every variant of every strand model the test's grid, or one row
/// with the reason why the test refuses it; then the rows of free_flight.h.
std::vector<Case> validation_cases(const CommandLine& line, const Settings& settings);

/// Fills `order`: error ~ elements^-order at one parameter, by least squares over rows
/// whose error is above the rounding level.
void fit_validation_orders(std::vector<Row>& rows);

/// Checks that each test's claimed models pass it wherever they are judged, and the
/// claims of free_flight.h.
void check_validation(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::validation
