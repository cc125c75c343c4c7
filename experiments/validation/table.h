#pragma once

#include <span>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/validation/test.h"

/// The table of validation: which rows there are and what they must show.
namespace tress::experiments::validation {

std::span<const Column> validation_columns();
/// What each test is, where it comes from, and what is asked why.
std::vector<Gloss> validation_glossary();

/// Keys of --set: which tests, and which values of their parameters.
std::span<const Parameter> validation_settings();

/// Of every test and every variant of every model of a strand the test's grid, or one row
/// that says why the test refuses it; then the rows of free_flight.h.
std::vector<Case> validation_cases(const CommandLine& line, const Settings& settings);

/// Fills `order`: error ~ elements^-order at one parameter, by least squares over rows
/// whose error is above what rounding leaves.
void fit_validation_orders(std::vector<Row>& rows);

/// That each test's claimed models pass it wherever they are judged, and what
/// free_flight.h says.
void check_validation(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::validation
