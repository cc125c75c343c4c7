#pragma once

/// Declares one namespace per layer and which layers each one sees. `tress` itself holds
/// the contract, math and the linear solvers.
namespace tress {

namespace models {}
namespace integrators {}

namespace simulation {
using namespace models;
using namespace integrators;
}  // namespace simulation

namespace experiments {
using namespace simulation;
}  // namespace experiments

}  // namespace tress
