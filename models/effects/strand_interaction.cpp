#include "models/effects/strand_interaction.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "math/lanes.h"
#include "models/contact/crowding.h"
#include "models/contact/point_groups.h"

namespace tress::models {
namespace {

const std::string where_interaction = "effects.strand_interaction";

std::vector<int> checked(std::vector<int> points) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k] >= 2) continue;
    throw InputError(
        "strand " + std::to_string(k) + " has fewer than two material points",
        where_interaction, "give strands of at least one segment");
  }
  return points;
}

}  // namespace

std::span<const Parameter> strand_interaction_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list{
        {.name = "coupling",
         .help = "positions at which a strand meets the others. `lagged`: those at "
                 "the start of the step. With a tolerance, each strand takes its "
                 "own steps between two exchanges and sees the others move. "
                 "`monolithic`: the present positions, with all strands in one "
                 "system",
         .choices = "lagged|monolithic"}};
    const std::span<const Parameter> law = contact_parameters();
    list.insert(list.end(), law.begin(), law.end());
    return list;
  }();
  return all;
}

StrandInteraction::StrandInteraction(const Parameters& parameters,
                                     std::vector<int> points)
    : StrandInteraction(ContactLaw(parameters, where_interaction), std::move(points)) {}

StrandInteraction::StrandInteraction(const ContactLaw& law, std::vector<int> points)
    : law_(law), partners_(checked(std::move(points)), law.reach()) {}

void StrandInteraction::update(In x, In v, const Loop& loop) {
  end_ = 0;
  partners_.hold(x, v, loop);
}

void StrandInteraction::extrapolate(double t, double end, In x, In v, const Loop& loop) {
  end_ = end;
  partners_.extrapolate(t, end, x, v, loop);
}

void StrandInteraction::interpolate(double t, double end, In x, In v, In y, In w,
                                    const Loop& loop) {
  end_ = end;
  partners_.interpolate(t, end, x, v, y, w, loop);
}

class StrandInteraction::OnStrand final : public Effect {
 public:
  OnStrand(const StrandInteraction& all, int strand)
      : all_(all), groups_(all.partners_, strand) {}

  std::string_view name() const override { return "strand_interaction"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }

  void add_load(double t, const Points& p, InOut f) const noexcept override {
    look(t, p);
    each_point(p, [&](std::size_t i, const GroupLoads& loads, std::size_t lane) {
      add_force(p.length[i], loads, lane, &f[3 * i]);
    });
  }

  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    look(t, p);
    each_point(p, [&](std::size_t i, const GroupLoads& loads, std::size_t lane) {
      add_block(p.length[i], loads, lane, pos, vel, &blocks[9 * i]);
    });
  }

  void add_both(double t, const Points& p, double pos, double vel, InOut f,
                InOut blocks) const noexcept override {
    if (!all_.partners_.updated()) return;
    groups_.ready(p.x, p.length);
    const double elapsed = all_.partners_.motion().elapsed(t);
    GroupLoads loads;
    for (std::size_t g = 0; g < groups_.groups(); ++g) {
      if (!groups_.feels(g)) continue;
      groups_.loads(g, all_.law_, p.v, elapsed, loads);
      each_point_of(g, p, [&](std::size_t i, std::size_t lane) {
        add_force(p.length[i], loads, lane, &f[3 * i]);
        add_block(p.length[i], loads, lane, pos, vel, &blocks[9 * i]);
      });
    }
  }

  double potential(double, const Points&) const noexcept override { return 0; }
  double next_breakpoint(double t) const noexcept override {
    return t < all_.end_ ? all_.end_ : std::numeric_limits<double>::infinity();
  }

  double power(double t, const Points& p) const noexcept override {
    look(t, p);
    double sum = 0;
    each_point(p, [&](std::size_t i, const GroupLoads& loads, std::size_t lane) {
      sum += p.length[i] * dot(lane_of(loads.force, lane), load3(&p.v[3 * i]));
    });
    return sum;
  }

 private:
  /// Sets loads_ for the current points, for who asks for load and derivatives at the
  /// same state one after the other.
  void look(double t, const Points& p) const {
    const StrandPartners& partners = all_.partners_;
    if (!partners.updated()) return;
    const double elapsed = partners.motion().elapsed(t);
    if (update_ == partners.updates() && elapsed == elapsed_ &&
        std::ranges::equal(p.x, x_) && std::ranges::equal(p.v, v_)) {
      return;
    }
    groups_.ready(p.x, p.length);
    loads_.resize(groups_.groups());
    for (std::size_t g = 0; g < loads_.size(); ++g) {
      groups_.loads(g, all_.law_, p.v, elapsed, loads_[g]);
    }
    x_.assign(p.x.begin(), p.x.end());
    v_.assign(p.v.begin(), p.v.end());
    elapsed_ = elapsed;
    update_ = partners.updates();
  }

  /// Calls act(point, loads, lane) for points that feel anything.
  template <class F>
  void each_point(const Points& p, F act) const {
    for (std::size_t g = 0; g < loads_.size(); ++g) {
      if (!groups_.feels(g)) continue;
      each_point_of(g, p,
                    [&](std::size_t i, std::size_t lane) { act(i, loads_[g], lane); });
    }
  }
  template <class F>
  static void each_point_of(std::size_t group, const Points& p, F act) {
    const std::size_t first = points_of_group * group,
                      count =
                          std::min<std::size_t>(points_of_group, p.length.size() - first);
    for (std::size_t lane = 0; lane < count; ++lane) act(first + lane, lane);
  }
  static void add_force(double length, const GroupLoads& loads, std::size_t lane,
                        double* f) {
    store3(load3(f) + length * lane_of(loads.force, lane), f);
  }
  static void add_block(double length, const GroupLoads& loads, std::size_t lane,
                        double pos, double vel, double* block) {
    for (std::size_t row = 0; row < 3; ++row, block += 3) {
      store3(load3(block) + (pos * length) * lane_of(loads.by_place[row], lane), block);
      block[row] += vel * length * loads.by_velocity[lane];
    }
  }

  const StrandInteraction& all_;
  mutable PointGroups groups_;
  mutable std::vector<GroupLoads> loads_;
  // Where they are those of.
  mutable std::vector<double> x_, v_;
  mutable double elapsed_ = 0;
  mutable long update_ = -1;
};

std::unique_ptr<const Effect> StrandInteraction::effect(std::size_t strand) const {
  return std::make_unique<OnStrand>(*this, static_cast<int>(strand));
}

long StrandInteraction::touching_pairs(const Loop& loop) const {
  return partners_.updated() ? models::touching_pairs(partners_, law_.inner(), loop) : 0;
}

double StrandInteraction::mean_distance(const Loop& loop) const {
  return partners_.updated() ? models::mean_distance(partners_, law_.inner(), loop)
                             : std::numeric_limits<double>::infinity();
}

}  // namespace tress::models
