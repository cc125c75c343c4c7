#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/problems/strand_models.h"
#include "experiments/run/experiment.h"
#include "experiments/validation/rods/contact_run.h"

namespace tress::experiments::validation {

/// One test of one model of the catalogue.
struct ModelTrial {
  const ModelVariant& variant;
  int elements;      // N
  double parameter;  // of the test
  const Deadline& deadline;
  ContactRun contact = {};  // of tests with exact contact
};

/// A published test of slender rods: a known number for the continuous rod, and how to
/// measure a model's. To add a test: one object in a file of its kind, and that kind's
/// line in validation_tests().
struct ValidationTest {
  std::string_view name;
  std::string_view what;       // one line
  std::string_view source;     // publication, and how the reference is computed
  std::string_view parameter;  // meaning, with unit
  std::string_view quantity;   // measured quantity, with unit

  /// Range of the parameter for which the test is valid; inclusive.
  struct Range {
    double low, high;
    bool whole = false;
  };
  Range range;

  /// Default grid; --elements and --set parameters=... override it.
  struct Grid {
    std::vector<double> parameters;
    std::vector<int> elements;
  };
  Grid quick, usual, full;

  /// Bound of |measured/reference - 1| from `judged_from` elements on; with fewer it is
  /// reported, not judged. `why` justifies the value.
  double tolerance;
  std::string_view why;
  int judged_from;
  /// Models for which the finished table must show it; others are only reported.
  std::vector<std::string_view> claimed;

  /// Value of the continuous rod.
  std::function<double(double parameter)> reference;
  /// Why the test does not apply to a model, empty if it does: "planar", "no twist".
  /// Null: it applies to every model.
  std::function<std::string(const ModelVariant&)> refusal = {};
  /// Models that take minutes: --quick leaves them out unless they are named.
  std::vector<std::string_view> slow = {};
  /// Throws InputError where the model refuses the rod (a row `refused`), and
  /// std::runtime_error where it finds no answer (a row `failed`).
  std::function<double(const ModelTrial&)> measure;
};

/// All of them, in the order of the table.
const std::vector<ValidationTest>& validation_tests();

/// Throws InputError naming the nearest test when there is no such test.
const ValidationTest& find_validation_test(std::string_view name);

// The families of tests, each in its file.
std::vector<ValidationTest> buckling_tests();
std::vector<ValidationTest> cantilever_tests();
std::vector<ValidationTest> capstan_tests();
std::vector<ValidationTest> chain_tests();
std::vector<ValidationTest> curl_tests();
std::vector<ValidationTest> hanging_tests();
std::vector<ValidationTest> knot_tests();
std::vector<ValidationTest> ladder_tests();
std::vector<ValidationTest> plane_tests();
std::vector<ValidationTest> ringing_tests();
std::vector<ValidationTest> stick_slip_tests();
std::vector<ValidationTest> touching_tests();
std::vector<ValidationTest> vibration_tests();
std::vector<ValidationTest> wisp_tests();

}  // namespace tress::experiments::validation
