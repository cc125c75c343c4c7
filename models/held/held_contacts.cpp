#include "models/held/held_contacts.h"

#include <algorithm>

namespace tress::models {

HeldContacts::HeldContacts(Effects& effects, std::size_t points, PointsAt points_at)
    : points_at_(std::move(points_at)) {
  for (auto& effect : effects) {
    std::shared_ptr<Effect> own = effect->for_strand(points);
    if (!own) continue;
    held_.push_back(own);
    effect = own;
  }
}

std::size_t HeldContacts::tracked() const {
  std::size_t all = 0;
  for (const auto& effect : held_) all += effect->multipliers()->tracked();
  return all;
}

void HeldContacts::places(double t, In q, In v, Out x) noexcept {
  const Points p = points_at_(t, q, v);
  each(x, [&](const Multipliers& of, Out own) { of.places(t, p, own); });
}

void HeldContacts::slides(double t, In q, In v, Out u) noexcept {
  const Points p = points_at_(t, q, v);
  each(u, [&](const Multipliers& of, Out own) { of.slides(t, p, own); });
}

void HeldContacts::begin(double t, double tau, In q0, In v0, In x0) noexcept {
  const Points p = points_at_(t - tau, q0, v0);
  each(x0, [&](Multipliers& of, In own) { of.begin(t, tau, p, own); });
}

double HeldContacts::improve(double t, In q, In v) noexcept {
  const Points p = points_at_(t, q, v);
  double worst = 0;
  for (const auto& effect : held_) {
    worst = std::max(worst, effect->multipliers()->improve(t, p));
  }
  return worst;
}

double HeldContacts::drive() const noexcept {
  double fastest = 0;
  for (const auto& effect : held_) {
    fastest = std::max(fastest, effect->multipliers()->drive());
  }
  return fastest;
}

void HeldContacts::extrapolate() noexcept {
  for (const auto& effect : held_) effect->multipliers()->extrapolate();
}

double HeldContacts::approach(double t, In q, In v) noexcept {
  const Points p = points_at_(t, q, v);
  double fastest = 0;
  for (const auto& effect : held_) {
    fastest = std::max(fastest, effect->multipliers()->approach(t, p));
  }
  return fastest;
}

void HeldContacts::release() noexcept {
  for (const auto& effect : held_) effect->multipliers()->release();
}

bool HeldContacts::rebounds() const {
  return std::ranges::any_of(
      held_, [](const auto& effect) { return effect->multipliers()->rebounds(); });
}

Complementarity* HeldContacts::complementarity() {
  const auto rigid = [](const auto& effect) { return effect->multipliers()->rigid(); };
  if (!std::ranges::all_of(held_, rigid)) return nullptr;
  ContactForm& own = *this;
  if (!taken_) taken_ = std::make_unique<TakenContacts>(own, held_, points_at_);
  return taken_.get();
}

std::vector<double> HeldContacts::multipliers() const {
  std::vector<double> all;
  for (const auto& effect : held_) {
    const In own = effect->multipliers()->values();
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void HeldContacts::set_multipliers(In values) {
  for (const auto& effect : held_) {
    const InOut own = effect->multipliers()->values();
    std::ranges::copy(values.first(own.size()), own.begin());
    values = values.subspan(own.size());
  }
}

}  // namespace tress::models
