#include <mpi.h>

#include <exception>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "simulation/run/ranks.h"

namespace tress::simulation {
namespace {

/// Errors of MPI end the program, as MPI does where nobody says otherwise.
class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    int given = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  /// A rank that fails does not wait for the others, which mpirun then ends.
  ~MpiRanks() override {
    if (std::uncaught_exceptions() == 0) MPI_Finalize();
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void share(std::span<double> x, std::span<const std::size_t> sizes) override {
    constexpr std::size_t most = std::numeric_limits<int>::max();
    if (x.size() > most) throw std::length_error("more numbers than MPI counts at once");
    const std::vector<int> counts(sizes.begin(), sizes.end());
    std::vector<int> starts(counts.size());
    std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, x.data(), counts.data(),
                   starts.data(), MPI_DOUBLE, MPI_COMM_WORLD);
  }
  double largest(double x) override {
    MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return x;
  }

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace

std::unique_ptr<Ranks> ranks_of_job() {
  if (!started_as_rank()) return std::make_unique<OneRank>();
  return std::make_unique<MpiRanks>();
}

}  // namespace tress::simulation
