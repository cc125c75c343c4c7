#include <string>

#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {
namespace {

std::string_view name(Refresh refresh) {
  switch (refresh) {
    case Refresh::every_iteration:
      return "every_iteration";
    case Refresh::every_step:
      return "every_step";
    case Refresh::when_slow:
      break;
  }
  return "when_slow";
}

}  // namespace

Row StrandCase::identity() const {
  Row row;
  row.set("scene", strand->name).set("error_kind", error_kind).set("model", model->id);
  row.set("modes", modes).set("solver", solver).set("jacobian", jacobian);
  row.set("integrator", integrator).set("formulation", tress::name(options.formulation));
  if (options.max_order > 0) row.set("max_order", options.max_order);
  if (newton) {
    row.set("newton_tolerance", options.newton_tolerance);
    row.set("refresh", name(options.refresh));
  }
  row.set("elements", elements).set("grading", grading);
  set_drive(options, adaptive, row);
  return row;
}

Parameters strand_parameters_of(const FollowedStrand& strand, const Settings& settings,
                                const ModelEntry& model, int elements) {
  Parameters p = settings.parameters(model);
  set_known(p, find_strand_scene(strand.scene).settings);
  set_known(p, {{"modes", "bend"}});
  p.set("elements", std::to_string(elements));
  return p;
}

Parameters StrandCase::parameters(const Settings& settings) const {
  Parameters p = strand_parameters_of(*strand, settings, *model, elements);
  p.set("grading", std::to_string(grading));
  if (!modes.empty()) p.set("modes", modes);
  if (!solver.empty()) p.set("solver", solver);
  if (!jacobian.empty()) p.set("jacobian", jacobian);
  return p;
}

}  // namespace tress::experiments::work_precision
