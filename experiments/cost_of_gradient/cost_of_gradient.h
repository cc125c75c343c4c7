#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/cost_of_gradient/gradient_course.h"
#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

/// Error of gradients of runs against time, next to the error of the tip.
namespace tress::experiments::cost_of_gradient {

using simulation::Row;

/// Sizes of a sweep; other_steps: without the damped start, and with the elastic
/// Jacobian.
struct Sweep {
  std::vector<int> steps, other_steps, elements;
  std::vector<std::string> integrators;  // empty: all that have gradients
  int reference_steps = 0;

  static Sweep quick();
  static Sweep full();
};

/// Rows of a model on the curl, by steps: each method with the exact Jacobian and both
/// starts, and with the elastic Jacobian where the model has one. Errors are those in
/// time.
std::vector<Row> time_rows(const Row& own, const Sweep& sweep);
/// Rows of models on the curl by number of elements. Errors are those in space.
std::vector<Row> space_rows(const Row& own, const Sweep& sweep,
                            const std::vector<std::string>& models);

/// A law of contact with the plane: the lines of the body's table, and the methods that
/// are measured.
struct ContactLaw {
  std::string_view name, table;
  std::vector<std::string_view> integrators;
};
std::span<const ContactLaw> contact_laws();
/// Rows of hair that falls on a plane, by steps. Errors are those in time.
std::vector<Row> contact_rows(const Row& own, const Sweep& sweep, const ContactLaw& law);

/// Rows of fits on the curl, by steps: of the four parameters to the tip of a run that is
/// much finer in time, from other values. Errors are those of the
/// fitted values over the true ones.
std::vector<Row> fit_rows(const Row& own, const Sweep& sweep);

/// Returns the methods that have gradients of a scene and are among those chosen. Empty
/// `chosen`: all.
std::vector<std::string_view> gradient_methods(const simulation::Scene& scene,
                                               const std::vector<std::string>& chosen);

/// Errors of a gradient to which the work is compared, and the columns with it.
struct Target {
  double error;
  std::string_view column;
};
inline constexpr Target targets[] = {{1e-2, "linearizations_1_percent"},
                                     {1e-4, "linearizations_001_percent"}};

/// Fills in the orders at which errors fall with the step or the elements' length,
/// between a row and the row with half the number, and the work for `targets`.
void compare(std::vector<Row>& rows);
void judge(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::cost_of_gradient
