#include "models/head/reduced_loads.h"

#include <algorithm>
#include <concepts>

#include "math/instructions.h"
#include "models/head/chain_strand.h"
#include "models/head/clothoid_strand.h"
#include "models/head/helix_strand.h"
#include "models/head/packs.h"
#include "models/head/semidefinite.h"

namespace tress::models {
/// Which elements each body may touch.
template <class Kind>
void ReducedLoads<Kind>::look_around(const Block& block, const Element* elements) {
  block_ = block;
  by_registers_of<T>([&] { place(elements); });
  near_.resize(block_.bodies.size() * n_);
  for (std::size_t b = 0; b < block_.bodies.size(); ++b) {
    look_for(block_.bodies[b], std::span(near_).subspan(b * n_, n_));
  }
}

template <class Kind>
auto ReducedLoads<Kind>::find_exact(const Block& block, const Unknowns* v,
                                    const Element* elements)
    -> const ExactPoint<T>* const* {
  look_around(block, elements);
  by_registers_of<T>([&] {
    for (std::size_t i = 0; i < n_; ++i) exact_[i] = exact(i, v[i], elements[i]);
  });
  return exact_.data();
}

template <class Kind>
auto ReducedLoads<Kind>::find(const Block& block, const Unknowns* v,
                              const Element* elements) -> const Loads* const* {
  look_around(block, elements);
  const bool others = std::ranges::any_of(
      block_.others, [](const auto& of_strand) { return !of_strand.empty(); });
  if (others) take_others(v, elements);
  by_registers_of<T>([&] {
    for (std::size_t i = 0; i < n_; ++i) {
      loads_[i] = element(i, v[i], elements[i], others) ? &sums_[i] : nullptr;
    }
  });
  return loads_.data();
}

// Flat: functions of its own that another source has, too, compiled with fused products,
// could be taken from there.
template <class Kind>
TRESS_FLATTEN void ReducedLoads<Kind>::place(const Element* elements) {
  Start at{block_.from, block_.frame, {}};
  const T length(units_.length);
  for (std::size_t i = 0; i < n_; ++i) {
    const auto& e = elements[i].kept;
    Kind::enter(e, at.frame);
    at.chord = at.frame * (length * e.position);
    starts_[i] = at;
    at.x = at.x + at.chord;
    Kind::go_on(e, at.frame);
  }
}

/// Whether some of its points have a load, which is in sums_ then.
template <class Kind>
TRESS_FLATTEN bool ReducedLoads<Kind>::element(std::size_t i, const Unknowns& rate,
                                               const Element& e, bool others) {
  const OnElement points(e.kept, e.q, rate, block_.material->length);
  bool ready = false;
  const auto prepare = [&] {
    if (ready) return;
    ready = true;
    for (std::size_t k = 0; k < points_; ++k) {
      at_[k].p = points.position(place_of(k));
      at_[k].load = others ? others_[points_ * i + k] : PointLoad<T>{};
      at_[k].some = others ? some_[points_ * i + k] : T(0);
    }
  };
  for (std::size_t k = 0; others && k < points_; ++k) {
    if (any_less(T(0), some_[points_ * i + k])) prepare();
  }
  for (std::size_t b = 0; b < block_.bodies.size(); ++b) {
    if (near_[b * n_ + i] == 0) continue;
    const NearBody& body = block_.bodies[b];
    prepare();
    std::visit([&](const auto& shape) { touch(body, shape, i, points, at_.data()); },
               body.contact->body.shape());
  }
  return ready && add_up(i, points);
}

/// Null if none of its points has a load.
template <class Kind>
TRESS_FLATTEN auto ReducedLoads<Kind>::exact(std::size_t i, const Unknowns& rate,
                                             const Element& e) -> const ExactPoint<T>* {
  const OnElement points(e.kept, e.q, rate, block_.material->length);
  ExactPoint<T>* const at = &exact_at_[points_ * i];
  bool ready = false;
  for (std::size_t b = 0; b < block_.bodies.size(); ++b) {
    if (near_[b * n_ + i] == 0) continue;
    for (std::size_t k = 0; !ready && k < points_; ++k) {
      at[k] = {points.position(place_of(k)), {}, T(0)};
    }
    ready = true;
    const NearBody& body = block_.bodies[b];
    std::visit([&](const auto& shape) { touch(body, shape, i, points, at); },
               body.contact->body.shape());
  }
  if (!ready) return nullptr;
  const bool loaded = std::any_of(
      at, at + points_, [](const auto& point) { return any_less(T(0), point.some); });
  return loaded ? at : nullptr;
}

template <class Kind>
bool ReducedLoads<Kind>::add_up(std::size_t i, const OnElement& points) {
  Loads& sums = sums_[i];
  bool loaded = false;
  for (std::size_t k = 0; k < points_; ++k) {
    const Point& at = at_[k];
    if (!any_less(T(0), at.some)) continue;
    if (!loaded) sums = {};
    loaded = true;
    sums.some = larger(sums.some, at.some);
    // Of all effects together, linear drag among them, as ReducedSystem has them.
    const T drag = T(block_.h / units_.time) * weight_of(k) * block_.material->drag;
    PointLoad<T> load = at.load;
    const auto shift = [&load](const T& by) {
      load.block.xx += by;
      load.block.yy += by;
      load.block.zz += by;
    };
    shift(drag);
    load.block = semidefinite(load.block, at.some);
    shift(-drag);
    points.add_force(place_of(k), at.p, load.force, sums);
    points.add_block(place_of(k), at.p, load.block, sums);
  }
  return loaded;
}

/// All points are within the ellipsoid of revolution about the tips whose axis is the
/// length l of the element. With the chord c, its middle m and g = grad phi, a convex
/// function phi is at least
///
///     phi(m) - sqrt((l^2 - c^2) |g|^2 + (g.c)^2)/2
template <class Kind>
TRESS_FLATTEN void ReducedLoads<Kind>::look_for(const NearBody& body,
                                                std::span<char> near) const {
  const T length = T(units_.length) * block_.material->length;
  const T square = length * length, offset(body.contact->body.offset());
  std::visit(
      [&](const auto& shape) {
        by_registers_of<T>([&] {
          for (std::size_t i = 0; i < n_; ++i) {
            const Start& at = starts_[i];
            const Vec3T chord = in_body(body.pose, at.chord);
            const Vec3T middle =
                in_body(body.pose, at.x - Vec3T(body.pose.x)) + T(0.5) * chord;
            const T bulge = larger(T(0), square - dot(chord, chord));
            const DistanceOf<T> to = below(shape, middle);
            const T along = dot(to.gradient, chord);
            const T half =
                square_root(bulge * dot(to.gradient, to.gradient) + along * along);
            near[i] = any_less(to.value - T(0.5) * half, offset) ? 1 : 0;
          }
        });
      },
      body.contact->body.shape());
}

template <class Kind>
template <class Shape, class Load>
void ReducedLoads<Kind>::touch(const NearBody& body, const Shape& shape, std::size_t i,
                               const OnElement& points, LoadedPoint<T, Load>* at) const {
  const Start& start = starts_[i];
  const BodyTouch<T, Shape> of_body(body, shape, start.frame, block_.h);
  const Vec3T from = of_body.in_body(start.x);
  const T length(units_.length), speed(units_.speed());
  for (std::size_t k = 0; k < points_; ++k) {
    LoadedPoint<T, Load>& point = at[k];
    const auto velocity = [&] { return speed * points.velocity(place_of(k), point.p); };
    const Vec3T x = from + of_body.turn() * (length * point.p);
    const T w = weight_of(k), to_force = w * T(units_.length / units_.force());
    if constexpr (std::same_as<Load, ExactLoad<T>>) {
      of_body.touch(x, velocity, to_force, units_, point.load, point.some);
    } else {
      of_body.touch(x, velocity, to_force, w * T(1 / units_.density), point.load,
                    point.some);
    }
  }
}

/// Effects other than bodies, strand by strand.
template <class Kind>
TRESS_FLATTEN void ReducedLoads<Kind>::take_others(const Unknowns* v,
                                                   const Element* elements) {
  const std::size_t all = n_ * points_;
  others_.assign(all, {});
  some_.assign(all, T(0));
  x_.resize(all);
  v_.resize(all);
  tangent_.resize(all);
  const T length(units_.length), speed(units_.speed());
  for (std::size_t i = 0; i < n_; ++i) {
    const Element& e = elements[i];
    const Start& at = starts_[i];
    const OnElement points(e.kept, e.q, v[i], block_.material->length);
    for (std::size_t k = 0; k < points_; ++k) {
      const PointPlace<T> place = place_of(k);
      const Vec3T p = points.position(place);
      const std::size_t point = points_ * i + k;
      x_[point] = at.x + at.frame * (length * p);
      v_[point] = at.frame * (speed * points.velocity(place, p));
      tangent_[point] = at.frame * points.tangent(place);
    }
  }
  for (std::size_t k = 0; k < block_.others.size(); ++k) {
    if (!block_.others[k].empty()) take_others(static_cast<int>(k));
  }
}

template <class Kind>
void ReducedLoads<Kind>::take_others(int lane) {
  const std::size_t all = n_ * points_;
  for (auto* to : {&of_x_, &of_v_, &of_tangent_}) to->resize(3 * all);
  mass_.resize(all);
  length_.resize(all);
  arc_.resize(all);
  load_.assign(3 * all, 0.0);
  blocks_.assign(9 * all, 0.0);
  const double density = lane_of(block_.material->density, lane) * units_.density;
  for (std::size_t i = 0; i < all; ++i) {
    store3(block_.head + lane_of(x_[i], lane), &of_x_[3 * i]);
    store3(lane_of(v_[i], lane), &of_v_[3 * i]);
    store3(lane_of(tangent_[i], lane), &of_tangent_[3 * i]);
    length_[i] = units_.length * lane_of(weight_of(i % points_), lane);
    mass_[i] = density * length_[i];
    const auto before = static_cast<double>(i / points_);
    arc_[i] = units_.length * (before * lane_of(block_.material->length, lane) +
                               lane_of(place_of(i % points_).arc, lane));
  }
  const Points p{.count = static_cast<int>(all),
                 .x = of_x_,
                 .v = of_v_,
                 .tangent = of_tangent_,
                 .mass = mass_,
                 .length = length_,
                 .arc = arc_,
                 .longest = units_.length * static_cast<double>(n_) *
                            lane_of(block_.material->length, lane)};
  const double h = block_.h;
  for (const Effect* effect : block_.others[static_cast<std::size_t>(lane)]) {
    if (effect->needs().derivatives) {
      effect->add_both(block_.t, p, -h * h, -h, load_, blocks_);
    } else {
      effect->add_load(block_.t, p, load_);
    }
  }
  for (std::size_t i = 0; i < all; ++i) put(i, lane);
}

/// Into the lane, in the components of the element's axes.
template <class Kind>
void ReducedLoads<Kind>::put(std::size_t i, int lane) {
  const double *f = &load_[3 * i], *b = &blocks_[9 * i];
  const auto zero = [](double x) { return x == 0; };
  if (std::all_of(f, f + 3, zero) && std::all_of(b, b + 9, zero)) return;
  const FrameOf<T>& packed = starts_[i / points_].frame;
  const Frame frame{lane_of(packed.e0, lane), lane_of(packed.e1, lane),
                    lane_of(packed.e2, lane)};
  const Symmetric3<double> world{
      b[0], b[4], b[8], (b[1] + b[3]) / 2, (b[2] + b[6]) / 2, (b[5] + b[7]) / 2};
  const Symmetric3<double> own =
      (1 / units_.mass()) *
      congruent(Matrix3<double>{{frame.e0, frame.e1, frame.e2}}, world);
  set_lane(others_[i].force, lane, (1 / units_.force()) * frame.back(load3(f)));
  Symmetric3<T>& to = others_[i].block;
  set_lane(to.xx, lane, own.xx);
  set_lane(to.yy, lane, own.yy);
  set_lane(to.zz, lane, own.zz);
  set_lane(to.xy, lane, own.xy);
  set_lane(to.xz, lane, own.xz);
  set_lane(to.yz, lane, own.yz);
  some_[i].set(lane, 1);
}

#define TRESS_PACK(Number, width)                                \
  template class ReducedLoads<HelixKind<PackOf<Number, width>>>; \
  template class ReducedLoads<ChainKind<PackOf<Number, width>>>; \
  template class ReducedLoads<ClothoidKind<PackOf<Number, width>>>;
TRESS_EACH_PACK(TRESS_PACK)
#undef TRESS_PACK

}  // namespace tress::models
