#include "simulation/run/strand_maker.h"

#include <algorithm>
#include <utility>

#include "contract/forms/natural_strains.h"
#include "models/driven/driven_system.h"
#include "simulation/scene/joined_start.h"

namespace tress::simulation {
namespace {

void hold(System& system, std::span<const StrandToMake> strands) {
  if (strands.front().held == nullptr) return;
  std::vector<double> natural;
  for (const StrandToMake& strand : strands) {
    natural.insert(natural.end(), strand.held->natural.begin(),
                   strand.held->natural.end());
  }
  natural_strains(system)->set_natural(natural);
}

/// Takes the place of an effect on strands that it does not act on.
class NoEffect final : public Effect {
 public:
  std::string_view name() const override { return "none"; }
  models::Needs needs() const override { return {}; }
  void add_load(double, const Points&, InOut) const noexcept override {}
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }
};

/// Lets strands whose free roots begin with the same velocity and spin turn as one body,
/// about the root of the first.
void spin_together(std::vector<Strand>& strands) {
  const std::optional<models::FreeRoot> first = strands.front().free_root;
  const bool alike = std::ranges::all_of(strands, [&](const Strand& strand) {
    return first && strand.free_root &&
           norm(strand.free_root->velocity - first->velocity) == 0 &&
           norm(strand.free_root->spin - first->spin) == 0;
  });
  if (!alike) return;
  for (Strand& strand : strands) {
    models::FreeRoot& root = *strand.free_root;
    root.velocity = root.velocity + cross(root.spin, root.position - first->position);
  }
}

}  // namespace

StrandMaker::StrandMaker(const Scene& scene)
    : model_(scene.model),
      model_options_(scene),
      method_(&find_integrator(scene.integrator)),
      options_(scene.options),
      effects_(make_effects(scene)),
      supports_(scene),
      joints_(scene),
      guard_(scene.guard) {
  for (const EffectChoice& choice : scene.effects) {
    if (choice.entry->make != nullptr) only_.push_back(choice.strand);
  }
}

/// Those of the scene.
Effects StrandMaker::effects_on(const StrandToMake& strand) const {
  Effects all = strand.held == nullptr ? effects_ : supporting(effects_, *strand.held);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (only_[i].value_or(strand.number) != strand.number) {
      all[i] = std::make_shared<NoEffect>();
    }
  }
  return all;
}

/// Wraps each effect of the scene in a Metered, stored in `meters`.
Effects StrandMaker::acting(const StrandToMake& strand,
                            std::vector<std::shared_ptr<const Metered>>& meters) const {
  Effects all;
  for (const auto& effect : effects_on(strand)) {
    meters.push_back(std::make_shared<Metered>(effect));
    all.push_back(meters.back());
  }
  all.insert(all.end(), strand.between.begin(), strand.between.end());
  return all;
}

std::unique_ptr<System> StrandMaker::metered(
    const StrandToMake& strand,
    std::vector<std::shared_ptr<const Metered>>& meters) const {
  return model_->on_strand(strand.strand, model_options_.of(strand.strand),
                           acting(strand, meters));
}

SteppedSystem StrandMaker::one(const StrandToMake& strand, std::size_t number) const {
  std::vector<std::shared_ptr<const Metered>> meters;
  SteppedSystem made(metered(strand, meters));
  made.meters = std::move(meters);
  hold(*made.system, {&strand, 1});
  made.system = supports_.on(std::move(made.system), strand.strand, number);
  if (supports_.hold(number)) {
    made.supported = begin_on_supports(*made.system, supports_.place(number));
  }
  made.system = models::with_driven_bodies(std::move(made.system), effects_);
  add_guard(made, {&strand, 1}, number);
  return made;
}

SteppedSystem StrandMaker::joined(std::span<const StrandToMake> strands,
                                  const SceneJoints::Group& group) const {
  std::vector<std::shared_ptr<const Metered>> meters;
  std::vector<std::unique_ptr<System>> systems;
  std::vector<Strand> begun;
  for (const StrandToMake& strand : strands) begun.push_back(strand.strand);
  spin_together(begun);
  std::vector<const Strand*> each;
  SupportedStart supported;
  for (std::size_t k = 0; k < strands.size(); ++k) {
    const std::size_t number = group.first + k;
    each.push_back(&begun[k]);
    const StrandToMake own{begun[k], strands[k].between, strands[k].held, number};
    systems.push_back(supports_.on(metered(own, meters), begun[k], number));
    if (!supports_.hold(number)) continue;
    const SupportedStart one =
        begin_on_supports(*systems.back(), supports_.place(number));
    if (one.moved >= supported.moved) supported = one;
  }
  SteppedSystem made(joints_.join(group, std::move(systems), each, effects_));
  made.meters = std::move(meters);
  made.supported = supported;
  if (joints_.hold(group)) begin_on_joints(*made.system, joints_.places(group));
  made.system = models::with_driven_bodies(std::move(made.system), effects_);
  if (!guard_) return made;
  // Joints between strands do no work only in a common frame.
  std::vector<GuardedStrand> all = guarded(strands);
  const auto moving = std::ranges::find_if(
      all, [](const GuardedStrand& strand) { return strand.root.has_value(); });
  for (std::size_t k = 0; moving != all.end() && k < all.size(); ++k) {
    all[k].root = moving->root;
  }
  made.guard.emplace(Guard(*made.system, std::move(all), group.first));
  return made;
}

std::optional<SteppedSystem> StrandMaker::together(std::span<const StrandToMake> strands,
                                                   std::size_t first) const {
  if (model_->on_strands == nullptr || strands.size() < 2) return {};
  std::vector<std::shared_ptr<const Metered>> meters;
  std::vector<Strand> each;
  std::vector<Effects> effects;
  for (const StrandToMake& strand : strands) {
    each.push_back(strand.strand);
    effects.push_back(acting(strand, meters));
  }
  auto system =
      model_->on_strands(each, model_options_.of(each.front()), std::move(effects));
  if (system == nullptr) return {};
  SteppedSystem made(std::move(system));
  made.meters = std::move(meters);
  hold(*made.system, strands);
  if (guard_) {
    made.guard.emplace(dynamic_cast<StrandBlock&>(*made.system), guarded(strands), first);
  }
  return made;
}

std::vector<GuardedStrand> StrandMaker::guarded(
    std::span<const StrandToMake> strands) const {
  std::vector<GuardedStrand> all;
  for (const StrandToMake& strand : strands) {
    Effects effects = effects_on(strand);
    effects.insert(effects.end(), strand.between.begin(), strand.between.end());
    all.push_back(guarded_strand(strand.strand, std::move(effects)));
  }
  return all;
}

void StrandMaker::add_guard(SteppedSystem& system, std::span<const StrandToMake> strands,
                            std::size_t first) const {
  if (guard_) system.guard.emplace(Guard(*system.system, guarded(strands), first));
}

}  // namespace tress::simulation
