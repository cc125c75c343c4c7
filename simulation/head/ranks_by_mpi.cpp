#include <mpi.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "simulation/head/ranks.h"

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
    MPI_Win_allocate(first() ? sizeof *failures_ : 0, sizeof *failures_, MPI_INFO_NULL,
                     MPI_COMM_WORLD, &failures_, &of_failures_);
    if (first()) *failures_ = 0;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  /// A rank that fails does not wait for the others: see end_all().
  ~MpiRanks() override {
    if (std::uncaught_exceptions() > 0) return;
    MPI_Win_free(&of_failures_);
    MPI_Finalize();
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
  bool speaks() override {
    // Where all fail alike, what the first says is enough.
    if (!first()) std::this_thread::sleep_for(std::chrono::milliseconds(500));
    constexpr int one = 1;
    int before = 0;
    MPI_Win_lock(MPI_LOCK_SHARED, 0, 0, of_failures_);
    MPI_Fetch_and_op(&one, &before, MPI_INT, 0, 0, MPI_SUM, of_failures_);
    MPI_Win_unlock(0, of_failures_);
    silent_ = before > 0;
    return !silent_;
  }
  bool one_has_failed() const override {
    return first() && std::atomic_ref(*failures_).load() > 0;
  }
  void end_all(int code) override {
    // The one that speaks has time to do so, and ends this one.
    if (silent_) std::this_thread::sleep_for(std::chrono::seconds(5));
    MPI_Abort(MPI_COMM_WORLD, code);
    std::abort();
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
  void bytes_as_first(std::span<std::byte> x) override {
    MPI_Bcast(x.data(), counted(x.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
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
  MPI_Win of_failures_ = MPI_WIN_NULL;
  int* failures_ = nullptr;  // of all ranks, on the first
  bool silent_ = false;
  std::vector<MPI_Request> requests_;  // since begin()
};

}  // namespace

std::unique_ptr<Ranks> ranks_of_job() {
  if (!started_as_rank()) return std::make_unique<OneRank>();
  return std::make_unique<MpiRanks>();
}

}  // namespace tress::simulation
