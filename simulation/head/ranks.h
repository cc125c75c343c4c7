#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// The processes that work on one head together, each with strands of its own
/// (HeadDivision). All must make the same calls in the same order. Entries are sent as
/// bytes: all processes run on machines of one kind.
class Ranks {
 public:
  /// Numbers for each rank.
  using Sizes = std::span<const std::size_t>;
  /// Data sent to another rank, or received from it.
  struct Message {
    int rank;                    // rank of the other process
    std::span<std::byte> bytes;  // content
  };

  virtual ~Ranks() = default;

  virtual int rank() const = 0;  // of this process, from 0
  /// Returns the number of processes.
  virtual int size() const = 0;
  virtual int on_this_machine() const = 0;  // of them, this one included
  /// Returns true on the process that writes files.
  bool first() const { return rank() == 0; }

  /// The largest of what the ranks give.
  virtual double largest(double x) = 0;
  /// counts[r]: of something for rank r. What the ranks have for this one.
  virtual std::vector<std::size_t> swapped(Sizes counts) = 0;

  /// x: the ranks' parts one after the other, sizes[r] entries of rank r. Each knows its
  /// own part, afterwards all know all.
  template <class T>
  void share(std::span<T> x, Sizes sizes) {
    share_bytes(bytes_of(x), in_bytes<T>(sizes));
  }
  /// Returns one value of each rank, by the ranks.
  template <class T>
  std::vector<T> of_each(const T& own) {
    std::vector<T> all(static_cast<std::size_t>(size()));
    all[static_cast<std::size_t>(rank())] = own;
    share(std::span(all), std::vector<std::size_t>(all.size(), 1));
    return all;
  }
  /// Copies x of the first rank to all ranks.
  template <class T>
  void as_first(std::span<T> x) {
    bytes_as_first(bytes_of(x));
  }
  /// The first rank gets the ranks' own parts, one after the other. Others need not know
  /// the sizes.
  template <class T>
  void to_first(std::span<T> own, std::span<T> all, Sizes sizes) {
    bytes_to_first(bytes_of(own), bytes_of(all), in_bytes<T>(sizes));
  }
  /// The other way.
  template <class T>
  void from_first(std::span<T> all, Sizes sizes, std::span<T> own) {
    bytes_from_first(bytes_of(all), in_bytes<T>(sizes), bytes_of(own));
  }

  /// Sends and receives while the caller does something else, but leaves these alone.
  virtual void begin(std::span<const Message> to, std::span<const Message> from) = 0;
  /// Returns when all has come.
  virtual void finish() = 0;

  // A rank that fails asks whether to say why, and then ends them all:
  /// True for one of all that fail, the first rank if it does.
  virtual bool speaks() = 0;
  /// Whether one has been told to, as far as the first rank knows; by any thread.
  virtual bool one_has_failed() const = 0;
  /// The job's exit code.
  [[noreturn]] virtual void end_all(int code) = 0;

  /// Returns the bytes of an array.
  template <class T>
  static std::span<std::byte> bytes_of(std::span<T> x) {
    static_assert(std::is_trivially_copyable_v<T>);
    return std::as_writable_bytes(x);
  }

 protected:
  virtual void share_bytes(std::span<std::byte> x, Sizes sizes) = 0;
  virtual void bytes_as_first(std::span<std::byte> x) = 0;
  virtual void bytes_to_first(std::span<std::byte> own, std::span<std::byte> all,
                              Sizes sizes) = 0;
  virtual void bytes_from_first(std::span<std::byte> all, Sizes sizes,
                                std::span<std::byte> own) = 0;

 private:
  template <class T>
  static std::vector<std::size_t> in_bytes(Sizes sizes) {
    std::vector<std::size_t> all(sizes.begin(), sizes.end());
    for (std::size_t& size : all) size *= sizeof(T);
    return all;
  }
};

/// The ranks of the job that this process belongs to: of mpirun, if it was started by
/// one, else this process alone. Throws InputError under an mpirun of which this build
/// knows nothing. Signals that threads of a program must not take have to be blocked
/// before: MPI starts threads of its own.
std::unique_ptr<Ranks> ranks_of_job();

/// Whether mpirun, or a scheduler in its place, has started this process.
bool started_as_rank();

/// One process.
class OneRank final : public Ranks {
 public:
  int rank() const override { return 0; }
  /// Returns 1, this process.
  int size() const override { return 1; }
  int on_this_machine() const override { return 1; }
  double largest(double x) override { return x; }
  std::vector<std::size_t> swapped(Sizes counts) override {
    return {counts.begin(), counts.end()};
  }
  void begin(std::span<const Message>, std::span<const Message>) override {}
  void finish() override {}
  bool speaks() override { return true; }
  bool one_has_failed() const override { return false; }
  [[noreturn]] void end_all(int code) override { std::exit(code); }

 protected:
  void share_bytes(std::span<std::byte>, Sizes) override {}
  void bytes_as_first(std::span<std::byte>) override {}
  void bytes_to_first(std::span<std::byte> own, std::span<std::byte> all,
                      Sizes) override {
    std::ranges::copy(own, all.begin());
  }
  void bytes_from_first(std::span<std::byte> all, Sizes,
                        std::span<std::byte> own) override {
    std::ranges::copy(all, own.begin());
  }
};

}  // namespace tress::simulation
