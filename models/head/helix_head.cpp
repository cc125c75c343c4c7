#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "contract/constants.h"
#include "contract/input_error.h"
#include "math/lanes.h"
#include "models/head/head.h"
#include "models/head/helix_energies.h"
#include "models/head/helix_strand.h"

namespace tress::models {
namespace {

constexpr const char* place = "head of hair";

/// In which 1 is a long hair, the time in which it falls by its length, and its mass.
/// Numbers of any size then fit into 32 bits.
struct Units {
  double length, time, density;  // m, s, kg/m
  double stiffness() const { return density * std::pow(length, 4) / (time * time); }
};

template <class T>
class HelixHead final : public Head {
 public:
  explicit HelixHead(const HeadOptions& options)
      : options_(options),
        n_(static_cast<std::size_t>(options.elements)),
        kernel_(options.elements, options.points, options.twist),
        energies_(options.points),
        units_{options.longest, std::sqrt(options.longest / earth_gravity), 0} {
    options_.motion.frame = {};
  }

  void reserve(std::size_t strands) override {
    const std::size_t blocks = (strands + width - 1) / width;
    roots_.reserve(blocks);
    materials_.reserve(blocks);
    for (auto* state : {&q_, &v_, &rest_}) state->reserve(n_ * blocks);
    lost_.reserve(strands);
  }

  void add(const Strand& strand) override {
    models::check(strand);
    check(strand);
    const Segment& first = strand.segments.front();
    const CrossSection& section = first.section;
    const double density = strand.material.density * section.area();
    if (units_.density == 0) units_.density = density;
    const bool opens = lost_.size() % width == 0;
    if (opens) {
      roots_.emplace_back();
      materials_.emplace_back();
      for (auto* state : {&q_, &v_, &rest_}) state->resize(state->size() + n_);
    }
    const std::size_t block = roots_.size() - 1;
    const int own = static_cast<int>(lost_.size() % width);
    // The first strand of a block fills the lanes of those that may not come.
    for (int lane = own; lane < (opens ? T::lanes : own + 1); ++lane) {
      Root& root = roots_[block];
      const Vec from = strand.root.position - options_.motion.position;
      set_lane(root.from, lane, (1 / units_.length) * from);
      set_lane(root.frame, lane, strand.root.frame);
      HelixMaterial<T>& m = materials_[block];
      const double length = first.length / units_.length, bending = units_.stiffness();
      set_lane(m.length, lane, length);
      set_lane(m.density, lane, density / units_.density);
      set_lane(m.drag, lane,
               (options_.drag + options_.mass_damping * density) * units_.time /
                   units_.density);
      set_lane(m.stiffness, lane, length / bending * stiffness(strand.material, section));
      set_lane(m.friction, lane,
               length * strand.material.internal_friction / (bending * units_.time));
      const double polar = options_.rotary_inertia ? section.polar() : 0;
      set_lane(m.rotor, lane,
               length * strand.material.density * polar /
                   (units_.density * units_.length * units_.length));
      for (std::size_t i = 0; i < n_; ++i) {
        const Segment& segment = strand.segments[i];
        set_lane(rest_[n_ * block + i], lane, units_.length * segment.natural);
        Vec initial = units_.length * segment.initial;
        if (!options_.twist) initial.x = units_.length * segment.natural.x;  // held
        set_lane(q_[n_ * block + i], lane, initial);
        set_lane(v_[n_ * block + i], lane, Vec{});
      }
    }
    lost_.push_back(0);
  }

  std::size_t strands() const override { return lost_.size(); }
  std::size_t blocks() const override { return roots_.size(); }
  std::size_t bytes() const override {
    return blocks() *
               (sizeof(Root) + sizeof(HelixMaterial<T>) + 3 * n_ * sizeof(Vec3<T>)) +
           lost_.size();
  }

  std::unique_ptr<Scratch> scratch() const override { return std::make_unique<Own>(n_); }

  void step(std::size_t block, double t, double h, Scratch& given) override {
    Own& scratch = static_cast<Own&>(given);
    Vec3<T>*const q = &q_[n_ * block], *const v = &v_[n_ * block];
    std::copy_n(q, n_, scratch.before.begin());
    if (scratch.t != t + h) {
      scratch.t = t + h;
      scratch.pose = options_.motion.at(scratch.t);
    }
    const HelixRoot<T> root = root_of(roots_[block], scratch.pose);
    kernel_.semi_implicit_step(materials_[block], root, &rest_[n_ * block],
                               h / units_.time, q, v, scratch.elements.data());
    T finite(0);  // 0 or NaN
    for (std::size_t i = 0; i < n_; ++i) {
      const T all = q[i].x + q[i].y + q[i].z;
      finite += all - all;
    }
    if (!all_up_to(finite, 0) || any_lost(block)) freeze(block, finite, scratch);
  }
  bool lost(std::size_t strand) const override { return lost_[strand] != 0; }
  void lose(std::size_t strand) override {
    for (std::size_t i = 0; i < n_; ++i) {
      set_lane(v_[n_ * (strand / width) + i], static_cast<int>(strand % width), Vec{});
    }
    lost_[strand] = 1;
  }

  std::size_t numbers() const override { return 3 * (n_ + 1); }
  std::size_t strands_of(std::size_t block) const override {
    return std::min(width, lost_.size() - width * block);
  }

  void positions(std::size_t block, double t, std::span<double> x) const override {
    const RootPose pose = options_.motion.at(t);
    const Root& root = roots_[block];
    const T length = materials_[block].length;
    FrameOf<T> frame = FrameOf<T>{pose.frame.e0, pose.frame.e1, pose.frame.e2};
    Vec3<T> at = frame * root.from;  // seen from the motion's position
    frame = frame * root.frame;
    store(pose.x, at, 0, block, x);
    for (std::size_t i = 0; i < n_; ++i) {
      const Vec3<T>& kappa = q_[n_ * block + i];
      const HelixElement<T> element(kappa, {});
      const LaneFunctions<T> functions(kappa, length);
      const HelixFunctions<T> f = functions.at(length);
      at = at + frame * element.position(length, f);
      const Matrix3<T> turn = element.turn(length, f, functions.x2()).rotation;
      frame = frame * FrameOf<T>{turn.column(0), turn.column(1), turn.column(2)};
      store(pose.x, at, i + 1, block, x);
    }
  }

  void state(std::size_t strand, std::span<double> q,
             std::span<double> v) const override {
    const auto lane = static_cast<int>(strand % width);
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t at = n_ * (strand / width) + i;
      store3((1 / units_.length) * of_lane(q_[at], lane), &q[3 * i]);
      store3(1 / (units_.length * units_.time) * of_lane(v_[at], lane), &v[3 * i]);
    }
  }

  std::size_t hash() const override {
    std::size_t all = 1469598103934665603U;  // FNV-1a, by numbers
    for (std::size_t k = 0; k < strands(); ++k) {
      const auto lane = static_cast<int>(k % width);
      for (std::size_t i = 0; i < n_; ++i) {
        for (const auto* state : {&q_, &v_}) {
          const Vec x = of_lane((*state)[n_ * (k / width) + i], lane);
          for (const double entry : {x.x, x.y, x.z}) {
            all = (all ^ std::bit_cast<std::uint64_t>(entry)) * 1099511628211U;
          }
        }
      }
    }
    return all;
  }

  void energies(std::size_t block, double t, std::span<HeadEnergy> each) const override {
    const RootPose pose = options_.motion.at(t);
    const Root& root = roots_[block];
    const FrameOf<T> head{pose.frame.e0, pose.frame.e1, pose.frame.e2};
    const auto sums = energies_(materials_[block], root_of(root, pose), head * root.from,
                                head * root.frame, &rest_[n_ * block], &q_[n_ * block],
                                &v_[n_ * block], n_);
    const double length = units_.length, speed = length / units_.time,
                 unit = units_.density * length * speed * speed;
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      const double mass = units_.density * static_cast<double>(n_) * length *
                          lane_of(materials_[block].density, lane) *
                          lane_of(materials_[block].length, lane);
      const Vec first =
          mass * pose.x + units_.density * length * length * of_lane(sums.first, lane);
      each[k] = {unit * lane_of(sums.kinetic, lane),
                 unit * lane_of(sums.elastic, lane),
                 -dot(options_.gravity, first),
                 speed * std::sqrt(lane_of(sums.fastest, lane)),
                 pose.x + length * of_lane(sums.tip, lane),
                 mass};
    }
  }

  std::size_t kept() const override { return 6 * n_ + 1; }
  void keep(std::size_t block, std::span<double> x) const override {
    double* to = x.data();
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      for (std::size_t i = n_ * block; i < n_ * (block + 1); ++i) {
        store3(of_lane(q_[i], static_cast<int>(k)), to);
        store3(of_lane(v_[i], static_cast<int>(k)), to + 3);
        to += 6;
      }
      *to++ = lost_[width * block + k];
    }
  }
  void recall(std::size_t block, std::span<const double> x) override {
    const double* from = x.data();
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      for (std::size_t i = n_ * block; i < n_ * (block + 1); ++i) {
        set_lane(q_[i], static_cast<int>(k), load3(from));
        set_lane(v_[i], static_cast<int>(k), load3(from + 3));
        from += 6;
      }
      lost_[width * block + k] = *from++ != 0 ? 1 : 0;
    }
  }

 private:
  static constexpr std::size_t width = T::lanes;

  /// Where a strand's root is in the head at rest.
  struct Root {
    Vec3<T> from;  // the motion's position
    FrameOf<T> frame;
  };
  struct Own final : Scratch {
    explicit Own(std::size_t n) : elements(n), before(n) {}
    std::vector<typename HelixStrand<T>::Scratch> elements;
    std::vector<Vec3<T>> before;                          // q
    double t = std::numeric_limits<double>::quiet_NaN();  // of the pose
    RootPose pose;
  };

  void check(const Strand& strand) const {
    refuse_if(strand.segments.size() != n_,
              "a strand of " + std::to_string(strand.segments.size()) +
                  " elements among those of " + std::to_string(n_),
              place, "cut all into equally many");
    refuse_if(strand.free_root.has_value(), "a free root", place, "clamp all roots");
    const Segment& first = strand.segments.front();
    for (std::size_t i = 0; i < n_; ++i) {
      const Segment& s = strand.segments[i];
      refuse_if(
          s.parent != static_cast<int>(i) - 1 || s.mount.e0.x != 1 || s.mount.e1.y != 1,
          "a strand with branches", place, "run trees one by one");
      refuse_if(std::abs(s.length - first.length) > 1e-9 * first.length ||
                    s.section.a1 != first.section.a1 || s.section.a2 != first.section.a2,
                "elements of different length or section", place, "use grading = 1");
    }
  }

  HelixRoot<T> root_of(const Root& root, const RootPose& pose) const {
    // In the components of the head, without units.
    const double l = units_.length, tau = units_.time;
    const auto in_head = [&](const Vec& x, double unit) {
      return Vec3<T>((1 / unit) * pose.frame.back(x));
    };
    const Vec3<T> omega = in_head(pose.omega, 1 / tau),
                  alpha = in_head(pose.alpha, 1 / (tau * tau));
    const Vec3<T> v = in_head(pose.v, l / tau) + cross(omega, root.from);
    const Vec3<T> a = in_head(pose.a - options_.gravity, l / (tau * tau)) +
                      cross(alpha, root.from) + cross(omega, cross(omega, root.from));
    return {root.frame.back(v), root.frame.back(omega), root.frame.back(a),
            root.frame.back(alpha)};
  }

  bool any_lost(std::size_t block) const {
    const char* const first = &lost_[width * block];
    return std::any_of(first, first + strands_of(block), [](char c) { return c != 0; });
  }

  /// What was lost before, and what is not finite now.
  void freeze(std::size_t block, const T& finite, const Own& scratch) {
    for (int lane = 0; lane < T::lanes; ++lane) {
      const std::size_t strand = width * block + static_cast<std::size_t>(lane);
      const bool was_lost = strand < lost_.size() && lost_[strand] != 0;
      if (finite[lane] == 0 && !was_lost) continue;
      for (std::size_t i = 0; i < n_; ++i) {
        set_lane(q_[n_ * block + i], lane, of_lane(scratch.before[i], lane));
        set_lane(v_[n_ * block + i], lane, Vec{});
      }
      if (strand < lost_.size()) lost_[strand] = 1;
    }
  }

  static Vec of_lane(const Vec3<T>& x, int lane) {
    return {tress::lane_of(x.x, lane), tress::lane_of(x.y, lane),
            tress::lane_of(x.z, lane)};
  }
  void store(const Vec& from, const Vec3<T>& at, std::size_t i, std::size_t block,
             std::span<double> x) const {
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      store3(from + units_.length * of_lane(at, static_cast<int>(k)),
             &x[3 * (k * (n_ + 1) + i)]);
    }
  }

  HeadOptions options_;
  std::size_t n_;
  HelixStrand<T> kernel_;
  HelixEnergies<T> energies_;
  Units units_;
  std::vector<Root> roots_;
  std::vector<HelixMaterial<T>> materials_;
  std::vector<Vec3<T>> q_, v_, rest_;  // (blocks, elements)
  std::vector<char> lost_;             // of each strand
};

}  // namespace

std::unique_ptr<Head> helix_head(const HeadOptions& options, const HeadPack& pack) {
  refuse_if(options.elements < 1, "no elements", place, "cut strands into at least one");
  refuse_if(
      options.points < 2 || options.points > HelixStrand<PackOf<double, 1>>::most_points,
      std::to_string(options.points) + " points of an element", place, "use 2 to 16");
  refuse_if(!(options.longest > 0) || !std::isfinite(options.longest),
            "a length that is not positive", place,
            "give that of the longest strand, in m");
  if (pack.number == HeadNumber::float64) {
    if (pack.lanes == 1) return std::make_unique<HelixHead<PackOf<double, 1>>>(options);
    if (pack.lanes == 4) return std::make_unique<HelixHead<PackOf<double, 4>>>(options);
    if (pack.lanes == 8) return std::make_unique<HelixHead<PackOf<double, 8>>>(options);
  } else {
    if (pack.lanes == 8) return std::make_unique<HelixHead<PackOf<float, 8>>>(options);
    if (pack.lanes == 16) return std::make_unique<HelixHead<PackOf<float, 16>>>(options);
  }
  throw InputError(std::to_string(pack.lanes) + " lanes", "head of hair",
                   "use 1, 4 or 8 of 64 bits, 8 or 16 of 32 bits");
}

}  // namespace tress::models
