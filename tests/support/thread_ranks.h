#pragma once

#include <algorithm>
#include <barrier>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "simulation/head/ranks.h"

namespace tress::testing_support {

/// Ranks that are threads of this process: what they send is copied while all wait.
class ThreadRanks {
 public:
  /// Calls work(ranks) once for each rank, all at the same time.
  static void run(int size, const std::function<void(simulation::Ranks&)>& work) {
    Shared shared(size);
    std::vector<std::jthread> threads;
    for (int r = 0; r < size; ++r) {
      threads.emplace_back([&, r] {
        One one(shared, r);
        work(one);
      });
    }
  }

 private:
  using Ranks = simulation::Ranks;
  using Bytes = std::span<std::byte>;

  struct Shared {
    explicit Shared(int size)
        : barrier(size),
          parts(static_cast<std::size_t>(size)),
          numbers(parts.size()),
          counts(parts.size()) {}
    std::barrier<> barrier;
    std::vector<Bytes> parts;
    std::vector<double> numbers;
    std::vector<std::vector<std::size_t>> counts;
    std::mutex guard;
    std::map<std::pair<int, int>, std::vector<std::byte>> sent;  // from, to
  };

  class One final : public Ranks {
   public:
    One(Shared& shared, int rank) : all_(shared), rank_(rank) {}

    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(all_.parts.size()); }
    int on_this_machine() const override { return size(); }
    double largest(double x) override {
      all_.numbers[own()] = x;
      meet();
      const double most = *std::ranges::max_element(all_.numbers);
      meet();
      return most;
    }
    std::vector<std::size_t> swapped(Sizes counts) override {
      all_.counts[own()].assign(counts.begin(), counts.end());
      meet();
      std::vector<std::size_t> mine;
      for (const auto& one : all_.counts) mine.push_back(one[own()]);
      meet();
      return mine;
    }
    void begin(std::span<const Message> to, std::span<const Message> from) override {
      for (const Message& message : to) {
        const std::scoped_lock lock(all_.guard);
        all_.sent[{rank_, message.rank}].assign(message.bytes.begin(),
                                                message.bytes.end());
      }
      from_.assign(from.begin(), from.end());
    }
    void finish() override {
      meet();
      for (const Message& message : from_) {
        const auto& sent = all_.sent.at({message.rank, rank_});
        std::ranges::copy(sent, message.bytes.begin());
      }
      meet();
    }

    bool speaks() override { return true; }
    bool one_has_failed() const override { return false; }
    [[noreturn]] void end_all(int) override { std::abort(); }

   protected:
    void bytes_as_first(Bytes x) override {
      all_.parts[own()] = x;
      meet();
      if (!first()) std::ranges::copy(all_.parts[0], x.begin());
      meet();
    }
    void share_bytes(Bytes x, Sizes sizes) override {
      all_.parts[own()] = x;
      meet();
      std::size_t first = 0;
      for (std::size_t r = 0; r < sizes.size(); first += sizes[r++]) {
        if (r == own()) continue;
        std::ranges::copy(all_.parts[r].subspan(first, sizes[r]),
                          x.subspan(first).begin());
      }
      meet();
    }
    void bytes_to_first(Bytes own_part, Bytes all, Sizes) override {
      all_.parts[own()] = own_part;
      meet();
      auto to = all.begin();
      for (std::size_t r = 0; first() && r < all_.parts.size(); ++r) {
        to = std::ranges::copy(all_.parts[r], to).out;
      }
      meet();
    }
    void bytes_from_first(Bytes all, Sizes sizes, Bytes own_part) override {
      if (first()) all_.parts[0] = all;
      meet();
      std::size_t from = 0;
      for (std::size_t r = 0; r < own(); ++r) from += sizes[r];
      std::ranges::copy(all_.parts[0].subspan(from, own_part.size()), own_part.begin());
      meet();
    }

   private:
    std::size_t own() const { return static_cast<std::size_t>(rank_); }
    void meet() { all_.barrier.arrive_and_wait(); }

    Shared& all_;
    int rank_;
    std::vector<Message> from_;
  };
};

}  // namespace tress::testing_support
