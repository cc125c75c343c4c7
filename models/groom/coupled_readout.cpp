// Readouts of strands that form one system: energy, momentum, positions.
#include <algorithm>
#include <iterator>

#include "models/groom/coupled_strands.h"

namespace tress::models {

std::string CoupledStrands::not_finite(double t, In q, In v) {
  for (std::size_t k = 0; k < strands(); ++k) {
    const std::string words = strands_[k]->not_finite(t, part(q, k), part(v, k));
    if (!words.empty()) return "strand " + std::to_string(k) + ": " + words;
  }
  return {};
}

Energetics* CoupledStrands::energetics() {
  const bool all = std::ranges::all_of(
      strands_, [](const auto& strand) { return strand->energetics() != nullptr; });
  return all ? this : nullptr;
}

Energy CoupledStrands::energy(double t, In q, In v) {
  Energy sum;
  for (std::size_t k = 0; k < strands(); ++k) {
    const Energy own = strands_[k]->energetics()->energy(t, part(q, k), part(v, k));
    sum.kinetic += own.kinetic;
    sum.potential += own.potential;
  }
  sum.potential += contact_potential(t, q, v);
  return sum;
}

double CoupledStrands::contact_potential(double t, In q, In v) {
  double sum = 0;
  place(t, q, v);
  contacts_->each_contact(x_, u_, [&](const auto&, const PieceContact& contact) {
    sum += contact.potential(contacts_->law());
  });
  return sum;
}

std::optional<Momentum> CoupledStrands::momentum(double t, In q, In v) {
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

/// A clamp also holds its point against the contacts.
double CoupledStrands::power(double t, In q, In v) {
  double sum = 0;
  for (std::size_t k = 0; k < strands(); ++k) {
    sum += strands_[k]->energetics()->power(t, part(q, k), part(v, k));
  }
  place(t, q, v);
  contacts_->each_contact(x_, u_, [&](const auto& points, const PieceContact& contact) {
    sum += contact.power(contacts_->law());
    const Vec force = contact.force(contacts_->law());
    for (std::size_t i = 0; i < 4; ++i) {
      Vec prescribed = load3(&u_[3 * points[i]]);
      const Mean& mean = means_[points[i]];
      for (std::size_t n = 0; n < static_cast<std::size_t>(mean.count); ++n) {
        const auto c = static_cast<std::size_t>(mean.coordinate[n]);
        prescribed = prescribed - mean.weight[n] * load3(&v[c]);
      }
      sum -= contact.weight(i) * dot(force, prescribed);
    }
  });
  return sum;
}

int CoupledStrands::before(int i) const {
  const auto next = std::ranges::upper_bound(first_point_, i);
  const int first = *std::prev(next);
  const auto k = static_cast<std::size_t>(next - first_point_.begin() - 1);
  const int own = strands_[k]->material_points()->before(i - first);
  return own < 0 ? -1 : first + own;
}

void CoupledStrands::positions(double t, In q, Out x) {
  for (std::size_t k = 0; k < strands(); ++k) {
    const auto from = 3 * static_cast<std::size_t>(first_point_[k]);
    const auto to = 3 * static_cast<std::size_t>(first_point_[k + 1]);
    strands_[k]->material_points()->positions(t, part(q, k), x.subspan(from, to - from));
  }
}

void CoupledStrands::velocities(double t, In q, In v, Out u) {
  for (std::size_t k = 0; k < strands(); ++k) {
    const auto from = 3 * static_cast<std::size_t>(first_point_[k]);
    const auto to = 3 * static_cast<std::size_t>(first_point_[k + 1]);
    strands_[k]->material_points()->velocities(t, part(q, k), part(v, k),
                                               u.subspan(from, to - from));
  }
}

std::optional<double> CoupledStrands::stretch(double t, In q) {
  double most = 0;
  for (std::size_t k = 0; k < strands(); ++k) {
    const auto own = strands_[k]->material_points()->stretch(t, part(q, k));
    if (!own) return {};
    most = std::max(most, *own);
  }
  return most;
}

std::optional<MaterialPoints::Mean> CoupledStrands::mean(int point) {
  return means_[static_cast<std::size_t>(point)];
}

}  // namespace tress::models
