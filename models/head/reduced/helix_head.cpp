#include "models/head/helix_launch.h"
#include "models/head/helix_source.h"
#include "models/head/helix_strand.h"
#include "models/head/lane_numbers.h"
#include "models/head/reduced/reduced_head.h"

namespace tress::models {
namespace {

template <class T>
class HelixHead final : public ReducedHead<HelixKind<T>>, public HelixSource {
 public:
  using Base = ReducedHead<HelixKind<T>>;
  using Base::Base, Base::strands_of;

  const HelixSource* source() const override { return this; }
  std::optional<HeadRefusal> refused_by_device() const override {
    if (!bodies_.empty()) return HeadRefusal{"bodies", "leave them out"};
    if (!others_.empty()) {
      return HeadRefusal{"effect " + std::string(others_.front()->name()),
                         "leave it out"};
    }
    if (!own_.empty()) {
      return HeadRefusal{"effects on single strands, such as interaction",
                         "leave them out"};
    }
    return {};
  }
  Shape shape() const override {
    return {options_.elements, options_.points, options_.twist,
            sizeof(typename T::Scalar) == sizeof(double) ? HeadNumber::float64
                                                         : HeadNumber::float32};
  }
  void fixed(std::size_t block, std::span<double> each) const override {
    double* to = each.data();
    const auto put = [&](int lane, const T* from, std::size_t numbers) {
      for (std::size_t i = 0; i < numbers; ++i) *to++ = lane_of(from[i], lane);
    };
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      HelixFixed<T> own{materials_[block], roots_[block]};
      put(lane, numbers_of<T>(own).data(), numbers_of<T>(own).size());
      put(lane, &rest_[n_ * block].x, 3 * n_);
    }
  }
  HeadMotion motion_at(double t) const override {
    return this->motion_of(options_.motion.at(t));
  }
  double time_unit() const override { return units_.time; }

 private:
  using Base::bodies_, Base::others_, Base::own_, Base::options_, Base::units_,
      Base::materials_, Base::roots_, Base::rest_, Base::n_;
};

}  // namespace

std::unique_ptr<Head> stiff_helix_head(const LaneOptions& options, const HeadPack& pack) {
  return reduced_head<HelixHead>(options, pack);
}

}  // namespace tress::models
