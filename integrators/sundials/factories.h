#pragma once

#include <array>
#include <memory>

#include "contract/integrator.h"

/// The SUNDIALS integrators, for catalogue.cpp. Each throws InputError on options that it
/// does not have (order, table, formulation).
namespace tress {

/// What each can take on as formulation of constraints.
inline constexpr std::array ode_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte};
inline constexpr std::array cvode_bdf_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte,
    Formulation::projection};
inline constexpr std::array ida_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte,
    Formulation::index2_ggl, Formulation::index3};

std::unique_ptr<Integrator> make_cvode_adams(System& system, const Options& options);
std::unique_ptr<Integrator> make_cvode_bdf(System& system, const Options& options);
std::unique_ptr<Integrator> make_arkode_erk(System& system, const Options& options);
std::unique_ptr<Integrator> make_arkode_dirk(System& system, const Options& options);
std::unique_ptr<Integrator> make_ida(System& system, const Options& options);

}  // namespace tress
