#include "simulation/head/ranks.h"

#include <algorithm>
#include <cstdlib>

namespace tress::simulation {

bool started_as_rank() {
  // Of Open MPI, of MPICH and those like it, of srun --mpi=pmix.
  constexpr const char* names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMIX_RANK"};
  return std::ranges::any_of(
      names, [](const char* name) { return std::getenv(name) != nullptr; });
}

}  // namespace tress::simulation
