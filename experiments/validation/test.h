#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/problems/model_variants.h"
#include "experiments/run/experiment.h"

namespace tress::experiments::validation {

/// One model of the catalogue put to one test.
struct ModelTrial {
  const ModelVariant& variant;
  int elements;      // N
  double parameter;  // of the test
  const Deadline& deadline;
};

/// A published test of slender rods: a number that is known for the continuous rod, and
/// how a model's is measured. Adding a test = one object in a file of its kind, and that
/// kind's line in validation_tests().
struct ValidationTest {
  std::string_view name;
  std::string_view what;       // one line
  std::string_view source;     // who published it, and how the reference is computed
  std::string_view parameter;  // what it is, with unit
  std::string_view quantity;   // what is measured, with unit

  /// Values of the parameter for which the test is made; both ends belong to it.
  struct Range {
    double low, high;
    bool whole = false;
  };
  Range range;

  /// What is tried; --elements and --set parameters=... replace them.
  struct Grid {
    std::vector<double> parameters;
    std::vector<int> elements;
  };
  Grid quick, usual, full;

  /// On |measured/reference - 1| from `judged_from` elements on; of fewer it is told, not
  /// judged. `why` says where the number comes from.
  double tolerance;
  std::string_view why;
  int judged_from;
  /// Models of which the finished table must show it; the others are told.
  std::vector<std::string_view> claimed;

  /// Of the continuous rod.
  std::function<double(double parameter)> reference;
  /// Why the test says nothing about a model, empty where it does: "planar", "no twist".
  /// None: it suits every model.
  std::function<std::string(const ModelVariant&)> refusal = {};
  /// Models that take minutes for it: --quick leaves them out unless they are named.
  std::vector<std::string_view> slow = {};
  /// Throws InputError where the model refuses the rod (a row `refused`), and
  /// std::runtime_error where it finds no answer (a row `failed`).
  std::function<double(const ModelTrial&)> measure;
};

/// All of them, in the order of the table.
const std::vector<ValidationTest>& validation_tests();

/// Throws InputError naming the nearest test when there is no such test.
const ValidationTest& find_validation_test(std::string_view name);

}  // namespace tress::experiments::validation
