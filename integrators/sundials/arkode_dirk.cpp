#include "integrators/sundials/arkode_dirk.h"

#include <algorithm>

#include "contract/input_error.h"
#include "integrators/entry.h"
#include "integrators/sundials/arkstep.h"

namespace tress::integrators {
namespace {

constexpr std::string_view dirk_id = "arkode_dirk";
constexpr std::string_view standard = "default";
constexpr Parameter own_dirk[] = {{.name = "table",
                                   .help = "a SUNDIALS Butcher table by name",
                                   .text = true,
                                   .fallback = standard}};
constexpr const char* standard_table = "ARKODE_ESDIRK436L2SA_6_3_4";
constexpr const char* no_explicit_table = "ARKODE_ERK_NONE";

// SUNDIALS provides no list of its names, and prints a message for an unknown one.
constexpr std::array<std::string_view, 23> tables{"ARKODE_SDIRK_2_1_2",
                                                  "ARKODE_BILLINGTON_3_3_2",
                                                  "ARKODE_TRBDF2_3_3_2",
                                                  "ARKODE_KVAERNO_4_2_3",
                                                  "ARKODE_ARK324L2SA_DIRK_4_2_3",
                                                  "ARKODE_CASH_5_2_4",
                                                  "ARKODE_CASH_5_3_4",
                                                  "ARKODE_SDIRK_5_3_4",
                                                  "ARKODE_KVAERNO_5_3_4",
                                                  "ARKODE_ARK436L2SA_DIRK_6_3_4",
                                                  "ARKODE_KVAERNO_7_4_5",
                                                  "ARKODE_ARK548L2SA_DIRK_8_4_5",
                                                  "ARKODE_ARK437L2SA_DIRK_7_3_4",
                                                  "ARKODE_ARK548L2SAb_DIRK_8_4_5",
                                                  "ARKODE_ESDIRK324L2SA_4_2_3",
                                                  "ARKODE_ESDIRK325L2SA_5_2_3",
                                                  "ARKODE_ESDIRK32I5L2SA_5_2_3",
                                                  "ARKODE_ESDIRK436L2SA_6_3_4",
                                                  "ARKODE_ESDIRK43I6L2SA_6_3_4",
                                                  "ARKODE_QESDIRK436L2SA_6_3_4",
                                                  "ARKODE_ESDIRK437L2SA_7_3_4",
                                                  "ARKODE_ESDIRK547L2SA_7_4_5",
                                                  "ARKODE_ESDIRK547L2SA2_7_4_5"};

InputError unknown_table(const std::string& table) {
  std::string known = "choose one of";
  for (const std::string_view each : tables) known += " " + std::string(each);
  return {"unknown Butcher table '" + table + "'", std::string(dirk_id) + " table",
          known};
}

}  // namespace

ArkodeDirk::ArkodeDirk(System& system, const Options& options)
    : Driver(dirk_id, system, options, ode_formulations, 0),
      equations_(system, options),
      memory_(require(ARKStepCreate(nullptr, &FirstOrder::rate_callback, time_,
                                    y_.handle(), context_.handle()),
                      "ARKStepCreate")),
      implicit_(context_, equations_) {
  void* const memory = memory_.get();
  require(send_messages(memory_, context_.messages), "ARKStepSetErrHandlerFn");
  require(ARKStepSetUserData(memory, &equations_), "ARKStepSetUserData");
  require(ARKStepSVtolerances(memory, options.rtol, atol_.handle()),
          "ARKStepSVtolerances");
  choose_table();
  require(ARKStepSetMaxStep(memory, options.max_step), "ARKStepSetMaxStep");
  require(ARKStepSetMaxHnilWarns(memory, -1), "ARKStepSetMaxHnilWarns");
  implicit_.attach(memory_);
}

void ArkodeDirk::choose_table() {
  const Parameters chosen = own_options(options_, own_dirk);
  const std::string name(chosen.word("table"));
  if (name == standard && options_.max_order != 0) {
    require(ARKStepSetOrder(memory_.get(), chosen_order(dirk_id, options_, 0, 2, 5)),
            "ARKStepSetOrder");
    return;
  }
  if (name != standard && std::ranges::find(tables, name) == tables.end()) {
    throw unknown_table(name);
  }
  const char* table = name == standard ? standard_table : name.c_str();
  require(ARKStepSetTableName(memory_.get(), table, no_explicit_table),
          "ARKStepSetTableName");
}

int ArkodeDirk::restart() {
  equations_.begin();
  return ARKStepReInit(memory_.get(), nullptr, &FirstOrder::rate_callback, time_,
                       y_.handle());
}

int ArkodeDirk::step(double t_end, double& t) {
  return arkstep_step(memory_, equations_, y_.handle(), t_end, t);
}

Stats ArkodeDirk::counters() const { return arkstep_counters(memory_); }

std::string ArkodeDirk::reason(int code) const {
  return code_name(&ARKStepGetReturnFlagName, code);
}

IntegratorEntry arkode_dirk_entry() {
  return {.id = "arkode_dirk",
          .summary = "ESDIRK4(3)6L[2]SA, L-stable",
          .source = "SUNDIALS ARKODE",
          .adaptive = true,
          .tangent = true,
          .formulations = of_order(4, ode_formulations),
          .gaps = {{Formulation::projection,
                    "ARKODE has no projection: SUNDIALS projects in cvode_bdf only"}},
          .parameters = own_dirk,
          .objection = inverts_mass,
          .make = make_method<ArkodeDirk>};
}

}  // namespace tress::integrators
