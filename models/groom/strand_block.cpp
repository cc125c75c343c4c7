#include "models/groom/strand_block.h"

#include <algorithm>
#include <limits>

#include "contract/forms/moving_history.h"

namespace tress::models {

StrandBlock::StrandBlock(std::vector<std::unique_ptr<System>> strands, std::size_t bodies)
    : strands_(std::move(strands)) {
  for (const auto& strand : strands_) {
    const MaterialPoints* points = strand->material_points();
    first_.push_back(first_.back() + strand->layout().coordinates);
    if (first_.size() + bodies > strands_.size() + 1) continue;
    first_point_.push_back(first_point_.back() +
                           (points == nullptr ? 0 : points->count()));
  }
}

Traits StrandBlock::traits() const {
  Traits all{.constant_mass = true, .regular_mass = true};
  for (const auto& strand : strands_) {
    const Traits traits = strand->traits();
    all.constant_mass = all.constant_mass && traits.constant_mass;
    all.regular_mass = all.regular_mass && traits.regular_mass;
  }
  return all;
}

void StrandBlock::initial_state(Out q, Out v) const {
  for (std::size_t k = 0; k < strands(); ++k) {
    strands_[k]->initial_state(part(q, k), part(v, k));
  }
}

void StrandBlock::scale(Out q_typ, Out v_typ) const {
  for (std::size_t k = 0; k < strands(); ++k) {
    strands_[k]->scale(part(q_typ, k), part(v_typ, k));
  }
}

double StrandBlock::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& strand : strands_) next = std::min(next, strand->next_breakpoint(t));
  return next;
}

double StrandBlock::next_teleport(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& strand : strands_) {
    if (const Teleports* own = teleports(*strand)) {
      next = std::min(next, own->next_teleport(t));
    }
  }
  return next;
}

void StrandBlock::teleport(double t, InOut q, InOut v) {
  for (std::size_t k = 0; k < strands(); ++k) {
    Teleports* const own = teleports(*strands_[k]);
    if (own != nullptr) own->teleport(t, part(q, k), part(v, k));
  }
}

void StrandBlock::follow(double t) {
  for (const auto& strand : strands_) {
    if (Teleports* const own = teleports(*strand)) own->follow(t);
  }
}

std::string StrandBlock::not_finite(double t, In q, In v) {
  for (std::size_t k = 0; k < strands(); ++k) {
    const std::string words = strands_[k]->not_finite(t, part(q, k), part(v, k));
    if (!words.empty()) return "strand " + std::to_string(k) + ": " + words;
  }
  return {};
}

Energetics* StrandBlock::energetics() {
  const bool all = std::ranges::all_of(
      strands_, [](const auto& strand) { return strand->energetics() != nullptr; });
  return all ? this : nullptr;
}

bool StrandBlock::accept_strands(double t, InOut q, InOut v) {
  bool changed = false;
  for (std::size_t k = 0; k < strands(); ++k) {
    if (strands_[k]->accept(t, part(q, k), part(v, k))) changed = true;
  }
  return changed;
}

bool StrandBlock::carry_strands(double t, InOut q, InOut v, InOut a) const {
  bool carried = true;
  for (std::size_t k = 0; k < strands(); ++k) {
    if (strands_[k]->history() == nullptr) continue;
    carried =
        tress::carry(*strands_[k], t, part(q, k), part(v, k), part(a, k)) && carried;
  }
  return carried;
}

std::string StrandBlock::strands_not_smooth() const {
  for (std::size_t k = 0; k < strands(); ++k) {
    const std::string why = tress::not_smooth(*strands_[k]);
    if (!why.empty()) return "strand " + std::to_string(k) + ": " + why;
  }
  return {};
}

std::vector<double> StrandBlock::memory_of_strands() const {
  std::vector<double> all;
  for (const auto& strand : strands_) {
    const History* history = strand->history();
    const auto own = history == nullptr ? std::vector<double>{} : history->memory();
    all.push_back(static_cast<double>(own.size()));
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void StrandBlock::recall_strands(In memory) {
  std::size_t at = 0;
  for (const auto& strand : strands_) {
    const auto size = static_cast<std::size_t>(memory[at]);
    if (size > 0) strand->history()->recall(memory.subspan(at + 1, size));
    at += 1 + size;
  }
}

Energy StrandBlock::energy(double t, In q, In v) {
  Energy total;
  for (std::size_t k = 0; k < strands(); ++k) {
    const Energy own = strands_[k]->energetics()->energy(t, part(q, k), part(v, k));
    total.kinetic += own.kinetic;
    total.potential += own.potential;
  }
  return total;
}

std::optional<Momentum> StrandBlock::momentum(double t, In q, In v) {
  Momentum total;
  for (std::size_t k = 0; k < strands(); ++k) {
    const auto own = strands_[k]->energetics()->momentum(t, part(q, k), part(v, k));
    if (!own) return {};
    for (std::size_t i = 0; i < 3; ++i) {
      total.linear[i] += own->linear[i];
      total.angular[i] += own->angular[i];
    }
  }
  return total;
}

double StrandBlock::power(double t, In q, In v) {
  double total = 0;
  for (std::size_t k = 0; k < strands(); ++k) {
    total += strands_[k]->energetics()->power(t, part(q, k), part(v, k));
  }
  return total;
}

int StrandBlock::before(int i) const {
  const auto after = std::ranges::upper_bound(first_point_, i);
  const auto k = static_cast<std::size_t>(after - first_point_.begin()) - 1;
  const int own = strands_[k]->material_points()->before(i - first_point_[k]);
  return own < 0 ? -1 : first_point_[k] + own;
}

void StrandBlock::positions(double t, In q, Out x) {
  for (std::size_t k = 0; k < shown(); ++k) {
    strands_[k]->material_points()->positions(t, part(q, k), points_of(k, x));
  }
}

void StrandBlock::velocities(double t, In q, In v, Out u) {
  for (std::size_t k = 0; k < shown(); ++k) {
    strands_[k]->material_points()->velocities(t, part(q, k), part(v, k),
                                               points_of(k, u));
  }
}

std::optional<double> StrandBlock::stretch(double t, In q) {
  double most = 0;
  for (std::size_t k = 0; k < shown(); ++k) {
    const auto own = strands_[k]->material_points()->stretch(t, part(q, k));
    if (!own) return {};
    most = std::max(most, *own);
  }
  return most;
}

}  // namespace tress::models
