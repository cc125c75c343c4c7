#include <mpi.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "simulation/run/ranks.h"

namespace tress::simulation {
namespace {

/// MPI counts by int.
int counted(std::size_t bytes) {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (bytes > most) throw std::length_error("more bytes than MPI counts at once");
  return static_cast<int>(bytes);
}

/// Parts one after the other.
struct Parts {
  explicit Parts(std::span<const std::size_t> sizes) : starts(sizes.size()) {
    static_cast<void>(
        counted(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0})));
    counts.assign(sizes.begin(), sizes.end());
    std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  }
  std::vector<int> counts, starts;
};

/// Errors of MPI end the program, as MPI does where nobody says otherwise.
class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    int given = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm here;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL,
                        &here);
    MPI_Comm_size(here, &on_this_machine_);
    MPI_Comm_free(&here);
  }
  /// A rank that fails does not wait for the others, which mpirun then ends. Where all
  /// fail alike the first alone says why, and has time to say so before it is ended.
  ~MpiRanks() override {
    if (std::uncaught_exceptions() == 0) {
      MPI_Finalize();
    } else if (!first()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int on_this_machine() const override { return on_this_machine_; }

  double largest(double x) override {
    MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return x;
  }
  std::vector<std::size_t> swapped(Sizes counts) override {
    const std::vector<std::uint64_t> own(counts.begin(), counts.end());
    std::vector<std::uint64_t> others(own.size());
    MPI_Alltoall(own.data(), 1, MPI_UINT64_T, others.data(), 1, MPI_UINT64_T,
                 MPI_COMM_WORLD);
    return {others.begin(), others.end()};
  }

  void begin(std::span<const Message> to, std::span<const Message> from) override {
    for (const Message& message : from) {
      MPI_Irecv(message.bytes.data(), counted(message.bytes.size()), MPI_BYTE,
                message.rank, 0, MPI_COMM_WORLD, &requests_.emplace_back());
    }
    for (const Message& message : to) {
      MPI_Isend(message.bytes.data(), counted(message.bytes.size()), MPI_BYTE,
                message.rank, 0, MPI_COMM_WORLD, &requests_.emplace_back());
    }
  }
  void finish() override {
    MPI_Waitall(counted(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
    requests_.clear();
  }

 protected:
  void share_bytes(std::span<std::byte> x, Sizes sizes) override {
    const Parts parts(sizes);
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, x.data(), parts.counts.data(),
                   parts.starts.data(), MPI_BYTE, MPI_COMM_WORLD);
  }
  void bytes_to_first(std::span<std::byte> own, std::span<std::byte> all,
                      Sizes sizes) override {
    const Parts parts(sizes);
    MPI_Gatherv(own.data(), counted(own.size()), MPI_BYTE, all.data(),
                parts.counts.data(), parts.starts.data(), MPI_BYTE, 0, MPI_COMM_WORLD);
  }
  void bytes_from_first(std::span<std::byte> all, Sizes sizes,
                        std::span<std::byte> own) override {
    const Parts parts(sizes);
    MPI_Scatterv(all.data(), parts.counts.data(), parts.starts.data(), MPI_BYTE,
                 own.data(), counted(own.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
  }

 private:
  int rank_ = 0, size_ = 1, on_this_machine_ = 1;
  std::vector<MPI_Request> requests_;  // since begin()
};

}  // namespace

std::unique_ptr<Ranks> ranks_of_job() {
  if (!started_as_rank()) return std::make_unique<OneRank>();
  return std::make_unique<MpiRanks>();
}

}  // namespace tress::simulation
