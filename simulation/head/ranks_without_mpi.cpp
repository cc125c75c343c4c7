#include "contract/input_error.h"
#include "simulation/head/ranks.h"

namespace tress::simulation {

std::unique_ptr<Ranks> ranks_of_job() {
  if (started_as_rank()) {
    throw InputError("started by mpirun, but built without MPI", "mpirun",
                     "install the packages of cmake/mpi_packages.txt and build again, or "
                     "leave out mpirun and give --threads");
  }
  return std::make_unique<OneRank>();
}

}  // namespace tress::simulation
