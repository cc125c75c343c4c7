#pragma once

#include "models/catalogue.h"
#include "models/strand/strand.h"
#include "models/supports/supported_system.h"
#include "simulation/driven/driven_tables.h"

namespace tress::simulation {

using models::ModelEntry;
using models::Strand;

/// Returns the index of the point of a strand at a share of its length, which must be the
/// end of an element. Throws InputError with `place`; `name` is that of the strand, and
/// `remedy` is for numbers out of range.
int end_of_element(double share, const Strand& strand, const std::string& name,
                   const std::string& place,
                   const char* remedy = "give a number of 0 to 1");

/// Makes what the tables describe for one strand, a `system` of the model. Throws
/// InputError with the location of a table that the strand or its model does not admit.
models::StrandDrives drives_of(const DrivenTables& tables, System& system,
                               const Strand& strand, std::size_t number,
                               const ModelEntry& model, const Parameters& model_options);

}  // namespace tress::simulation
