#include "models/batch/strand_block.h"

#include <algorithm>
#include <limits>

namespace tress::models {

StrandBlock::StrandBlock(std::vector<std::unique_ptr<System>> strands)
    : strands_(std::move(strands)),
      unknowns_(static_cast<std::size_t>(strands_.front()->layout().coordinates)),
      points_(strands_.front()->material_points()->count()) {}

Layout StrandBlock::layout() const {
  return {static_cast<int>(strands_.size() * unknowns_), 0};
}

void StrandBlock::initial_state(Out q, Out v) const {
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    strands_[s]->initial_state(of(s, q), of(s, v));
  }
}

void StrandBlock::scale(Out q_typ, Out v_typ) const {
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    strands_[s]->scale(of(s, q_typ), of(s, v_typ));
  }
}

double StrandBlock::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& strand : strands_) next = std::min(next, strand->next_breakpoint(t));
  return next;
}

std::string StrandBlock::not_finite(double t, In q, In v) {
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    const std::string words = strands_[s]->not_finite(t, of(s, q), of(s, v));
    if (!words.empty()) return "strand " + std::to_string(s) + ": " + words;
  }
  return {};
}

ExplicitForm* StrandBlock::explicit_form() {
  const bool all = std::ranges::all_of(
      strands_, [](const auto& strand) { return strand->explicit_form() != nullptr; });
  return all ? this : nullptr;
}

Status StrandBlock::acceleration(double t, In q, In v, Out a) noexcept {
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    const Status status =
        strands_[s]->explicit_form()->acceleration(t, of(s, q), of(s, v), of(s, a));
    if (status != Status::ok) return status;
  }
  return Status::ok;
}

Energy StrandBlock::energy(double t, In q, In v) {
  Energy total;
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    const Energy e = strands_[s]->energetics()->energy(t, of(s, q), of(s, v));
    total.kinetic += e.kinetic;
    total.potential += e.potential;
  }
  return total;
}

std::optional<Momentum> StrandBlock::momentum(double t, In q, In v) {
  Momentum total;
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    const auto own = strands_[s]->energetics()->momentum(t, of(s, q), of(s, v));
    if (!own) return {};
    for (std::size_t k = 0; k < 3; ++k) {
      total.linear[k] += own->linear[k];
      total.angular[k] += own->angular[k];
    }
  }
  return total;
}

double StrandBlock::power(double t, In q, In v) {
  double total = 0;
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    total += strands_[s]->energetics()->power(t, of(s, q), of(s, v));
  }
  return total;
}

int StrandBlock::before(int i) const {
  const int first = i / points_ * points_;
  const int own = strands_.front()->material_points()->before(i - first);
  return own < 0 ? -1 : first + own;
}

void StrandBlock::positions(double t, In q, Out x) {
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    strands_[s]->material_points()->positions(t, of(s, q), points_of(s, x));
  }
}

void StrandBlock::velocities(double t, In q, In v, Out u) {
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    strands_[s]->material_points()->velocities(t, of(s, q), of(s, v), points_of(s, u));
  }
}

std::optional<double> StrandBlock::stretch(double t, In q) {
  double most = 0;
  for (std::size_t s = 0; s < strands_.size(); ++s) {
    const auto own = strands_[s]->material_points()->stretch(t, of(s, q));
    if (!own) return {};
    most = std::max(most, *own);
  }
  return most;
}

}  // namespace tress::models
