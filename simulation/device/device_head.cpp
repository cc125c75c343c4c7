#include "simulation/device/device_head.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <utility>

#include "models/head/device_code.h"
#include "simulation/device/cuda_memory.h"

namespace tress::simulation {
namespace {

using models::HelixLaunch;
using models::HelixSource;
using models::HelixStep;

constexpr std::size_t most_steps = 4096;  // of a launch

/// Strands of some blocks.
template <class Number>
struct Slice {
  Slice(const CudaDevice& device, std::size_t first_block, std::size_t of_blocks,
        std::size_t of_strands, int n)
      : first(first_block),
        blocks(of_blocks),
        strands(of_strands),
        fixed(device, of_strands * static_cast<std::size_t>(models::helix_fixed(n))),
        state(device, of_strands * static_cast<std::size_t>(models::helix_state(n))),
        lost(device, of_strands) {}

  std::size_t first, blocks, strands;
  CudaArray<Number> fixed, state;
  CudaArray<int> lost;
};

template <class T>
class HelixDeviceHead final : public DeviceHead {
 public:
  using Number = typename T::Scalar;

  HelixDeviceHead(Head& head, std::size_t slice_strands)
      : head_(head),
        source_(*head.source()),
        shape_(source_.shape()),
        module_(device_, models::helix_ptx),
        kernel_(module_.function(kernel_name(shape_.elements))),
        motion_(device_, most_steps),
        streams_{CudaStream(device_), CudaStream(device_)},
        sent_(device_) {
    const std::size_t block = head.strands_of(0),
                      at_once = (slice_strands + block - 1) / block;
    for (std::size_t first = 0; first < head.blocks(); first += at_once) {
      const std::size_t end = std::min(first + at_once, head.blocks());
      slices_.emplace_back(device_, first, end - first,
                           (end - 1 - first) * block + head.strands_of(end - 1),
                           shape_.elements);
    }
    send_fixed();
    send_state();
    // Without steps: whether the device has the memory that its threads need.
    launch({}, 0);
    wait();
  }

  const std::string& name() const override { return device_.name(); }
  void step(double t, double h) override { steps_.push_back({t, h}); }
  void renew() override { stale_ = true; }

  std::vector<models::HeadLoss> fetch(const Share& share) override {
    if (steps_.empty()) return {};
    if (stale_) send_state();
    stale_ = true;  // until the head has them
    const std::vector<Step> steps = std::exchange(steps_, {});
    for (std::size_t k = 0; k < steps.size(); k += most_steps) {
      launch(std::span(steps).subspan(k, std::min(most_steps, steps.size() - k)), k);
      wait();
    }
    for (std::size_t k = 0; k < slices_.size(); ++k) {
      slices_[k].state.down(stream_of(k));
      slices_[k].lost.down(stream_of(k));
    }
    wait();
    for (const auto& slice : slices_) {
      share(slice.blocks, [&](std::size_t b) { take_home(slice, b); });
    }
    stale_ = false;
    return losses(steps);
  }

 private:
  struct Step {
    double t, h;
  };

  static const char* kernel_name(int elements) {
    const bool few = elements <= models::few_elements;
    if constexpr (sizeof(Number) == sizeof(double)) {
      return few ? "helix_64_few" : "helix_64_most";
    } else {
      return few ? "helix_32_few" : "helix_32_most";
    }
  }
  const CudaStream& stream_of(std::size_t slice) const { return streams_[slice % 2]; }

  /// of(block, numbers) finds `each` numbers of its strands; use(strand of the slice,
  /// numbers) takes those of one.
  template <class Of, class Use>
  void each_strand(const Slice<Number>& slice, std::size_t each, Of of, Use use) const {
    std::vector<double> numbers;
    for (std::size_t b = 0, s = 0; b < slice.blocks; ++b) {
      const std::size_t strands = head_.strands_of(slice.first + b);
      numbers.resize(each * strands);
      of(slice.first + b, std::span(numbers));
      for (std::size_t k = 0; k < strands; ++k, ++s) {
        use(s, std::span<const double>(numbers).subspan(each * k, each));
      }
    }
  }
  static void put(const Slice<Number>& slice, std::size_t s, std::span<const double> from,
                  std::span<Number> to) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      to[i * slice.strands + s] = static_cast<Number>(from[i]);
    }
  }

  void send_fixed() {
    const auto each = static_cast<std::size_t>(models::helix_fixed(shape_.elements));
    for (auto& slice : slices_) {
      each_strand(
          slice, each,
          [&](std::size_t block, std::span<double> x) { source_.fixed(block, x); },
          [&](std::size_t s, std::span<const double> x) {
            put(slice, s, x, slice.fixed.host());
          });
      slice.fixed.up(streams_[0]);
      streams_[0].synchronize();
      slice.fixed.free_host();
    }
  }
  void send_state() {
    for (std::size_t k = 0; k < slices_.size(); ++k) {
      const auto& slice = slices_[k];
      each_strand(
          slice, head_.kept(),
          [&](std::size_t block, std::span<double> x) { head_.keep(block, x); },
          [&](std::size_t s, std::span<const double> x) {
            put(slice, s, x.first(x.size() - 1), slice.state.host());
            slice.lost.host()[s] = x.back() != 0 ? -1 : 0;
          });
      slice.state.up(stream_of(k));
      slice.lost.up(stream_of(k));
    }
  }

  /// Steps of all strands; `before`: of those that are fetched together.
  void launch(std::span<const Step> steps, std::size_t before) {
    for (std::size_t k = 0; k < steps.size(); ++k) {
      motion_.host()[k] = {source_.motion_at(steps[k].t + steps[k].h),
                           steps[k].h / source_.time_unit()};
    }
    if (!steps.empty()) motion_.up(streams_[0], steps.size());
    sent_.record(streams_[0]);
    streams_[1].wait(sent_);
    for (std::size_t k = 0; k < slices_.size(); ++k) {
      const auto& slice = slices_[k];
      HelixLaunch<T> all{
          .kernel = models::HelixStrand<T>(shape_.elements, shape_.points, shape_.twist),
          .strands = static_cast<long>(slice.strands),
          .steps = static_cast<int>(steps.size()),
          .before = static_cast<int>(before),
          .motion = motion_.device(),
          .fixed = reinterpret_cast<const T*>(slice.fixed.device()),
          .state = reinterpret_cast<T*>(slice.state.device()),
          .lost = slice.lost.device()};
      void* arguments[] = {&all};
      const auto blocks = static_cast<unsigned>(
          (slice.strands + models::kernel_threads - 1) / models::kernel_threads);
      device_.check(device_.driver().cuLaunchKernel(
                        kernel_, blocks, 1, 1, models::kernel_threads, 1, 1, 0,
                        stream_of(k).handle(), arguments, nullptr),
                    "cuLaunchKernel");
    }
  }
  void wait() const {
    for (const CudaStream& stream : streams_) stream.synchronize();
  }

  void take_home(const Slice<Number>& slice, std::size_t b) {
    const std::size_t block = slice.first + b, kept = head_.kept(),
                      strands = head_.strands_of(block);
    std::vector<double> numbers(kept * strands);
    for (std::size_t k = 0, s = b * head_.strands_of(0); k < strands; ++k, ++s) {
      for (std::size_t i = 0; i + 1 < kept; ++i) {
        numbers[kept * k + i] =
            static_cast<double>(slice.state.host()[i * slice.strands + s]);
      }
      numbers[kept * (k + 1) - 1] = slice.lost.host()[s] != 0 ? 1 : 0;
    }
    head_.recall(block, numbers);
  }

  /// Those of these steps, by strand.
  std::vector<models::HeadLoss> losses(const std::vector<Step>& steps) const {
    std::vector<models::HeadLoss> all;
    for (std::size_t k = 0; k < slices_.size(); ++k) {
      const auto& slice = slices_[k];
      const std::size_t before = all.size();
      for (std::size_t s = 0; s < slice.strands; ++s) {
        int& lost = slice.lost.host()[s];
        if (lost <= 0) continue;
        const auto [t, h] = steps[static_cast<std::size_t>(lost) - 1];
        all.push_back({slice.first * head_.strands_of(0) + s, std::lround(t / h) + 1, t,
                       "the result of the step is not finite"});
        lost = -1;
      }
      if (all.size() > before) slice.lost.up(stream_of(k));
    }
    return all;
  }

  Head& head_;
  const HelixSource& source_;
  HelixSource::Shape shape_;
  CudaDevice device_;
  CudaModule module_;
  CudaDriver::Handle kernel_;
  CudaArray<HelixStep> motion_;
  std::deque<Slice<Number>> slices_;
  CudaStream streams_[2];  // end before the memory that they use
  CudaEvent sent_;         // the motion of a launch
  std::vector<Step> steps_;
  bool stale_ = false;  // the device's states are not the head's
};

}  // namespace

std::optional<models::HeadRefusal> refused_by_device(const Head& head) {
  const HelixSource* const source = head.source();
  if (source == nullptr) {
    return models::HeadRefusal{
        "there is device code only for uniform strands of super_helix with "
        "linearly_implicit_euler and jacobian = \"elastic\"",
        "use these, or --device cpu"};
  }
  if (const int n = source->shape().elements; n > models::most_elements) {
    return models::HeadRefusal{"device code is for up to " +
                                   std::to_string(models::most_elements) +
                                   " elements a strand, not " + std::to_string(n),
                               "give fewer elements, or --device cpu"};
  }
  if (auto no = source->refused_by_device()) {
    return models::HeadRefusal{
        "device code supports gravity and linear drag only, not " + no->reason,
        no->remedy + ", or --device cpu"};
  }
  return {};
}

std::unique_ptr<DeviceHead> device_head(Head& head, std::size_t slice_strands) {
  if (*models::helix_ptx == '\0') {
    throw DeviceFailure(
        "this build has no device code: it found no clang++ that makes it");
  }
  if (head.source()->shape().number == models::HeadNumber::float64) {
    return std::make_unique<HelixDeviceHead<PackOf<double, 1>>>(head, slice_strands);
  }
  return std::make_unique<HelixDeviceHead<PackOf<float, 1>>>(head, slice_strands);
}

}  // namespace tress::simulation
