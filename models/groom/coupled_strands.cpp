#include "models/groom/coupled_strands.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <string>

#include "contract/forms/sparse_form.h"
#include "contract/input_error.h"
#include "linear/finite.h"

namespace tress::models {
namespace {

const std::string where_monolithic = "effects.strand_interaction, coupling = monolithic";

[[noreturn]] void refuse(std::size_t k, const std::string& what) {
  throw InputError("strand " + std::to_string(k) + " " + what, where_monolithic,
                   "use coupling = lagged, or a model of nodes without constraints such "
                   "as der, corde or mass_spring");
}

}  // namespace

CoupledStrands::CoupledStrands(std::vector<std::unique_ptr<System>> strands,
                               const Parameters& parameters)
    : CoupledStrands(std::move(strands), ContactLaw(parameters, where_monolithic)) {}

CoupledStrands::CoupledStrands(std::vector<std::unique_ptr<System>> strands,
                               const ContactLaw& law)
    : StrandBlock(std::move(strands)) {
  std::vector<const Pattern*> tangents;
  std::vector<int> points;
  for (std::size_t k = 0; k < this->strands(); ++k) {
    check_and_join(k);
    tangents.push_back(&strand(k).sparse_form()->pattern());
    strand_values_.emplace_back(static_cast<std::size_t>(tangents.back()->nonzeros()));
    points.push_back(strand(k).material_points()->count());
    if (strand(k).contact_form() != nullptr) held_contacts_.push_back(k);
    if (strand(k).stress_form() != nullptr) stressed_.push_back(k);
  }
  solver_ = std::make_unique<CoupledSolver>(std::move(tangents), means_);
  x_.resize(3 * means_.size());
  u_.resize(x_.size());
  place_at_start();
  contacts_ = std::make_unique<StrandContacts>(law, std::move(points), x_);
  couple();
}

void CoupledStrands::check_and_join(std::size_t k) {
  if (strand(k).layout().constraints > 0) {
    refuse(k, "has constraints, whose solver is its own");
  }
  if (strand(k).sparse_form() == nullptr) {
    refuse(k, "has no sparse tangent to put among the others");
  }
  MaterialPoints* points = strand(k).material_points();
  if (points == nullptr || points->count() < 2) refuse(k, "has fewer than two points");
  for (int i = 0; i < points->count(); ++i) {
    std::optional<Mean> mean = points->mean(i);
    if (!mean) {
      refuse(k,
             "has points that are not fixed means of its coordinates, so that forces "
             "between strands have no sparse tangent");
    }
    for (int n = 0; n < mean->count; ++n) {
      mean->coordinate[static_cast<std::size_t>(n)] += first(k);
    }
    means_.push_back(*mean);
  }
}

/// Couples the coordinates of all segments that may touch.
void CoupledStrands::couple() {
  std::vector<CoupledPoints> touching;
  for (std::size_t i = 0; i < contacts_->segments(); ++i) {
    const std::size_t own = contacts_->point(static_cast<int>(i));
    for (const int partner : contacts_->partners(i)) {
      const std::size_t other = contacts_->point(partner);
      touching.push_back({own, own + 1, other, other + 1});
    }
  }
  solver_->touch(touching, std::identity());
  factored_ = Status::retry;
}

/// x_ = positions in the initial state.
void CoupledStrands::place_at_start() {
  std::vector<double> q(static_cast<std::size_t>(layout().coordinates)), v(q.size());
  initial_state(q, v);
  positions(0, q, x_);
}

void CoupledStrands::place(double t, In q, In v) noexcept {
  positions(t, q, x_);
  velocities(t, q, v, u_);
}

Status CoupledStrands::residual(double t, In q, In v, In a, Out r) noexcept {
  for (std::size_t k = 0; k < strands(); ++k) {
    const Status s =
        strand(k).residual(t, part(q, k), part(v, k), part(a, k), part(r, k));
    if (s != Status::ok) return s;
  }
  place(t, q, v);
  contacts_->each_contact(x_, u_, [&](const auto& points, const PieceContact& contact) {
    const Vec force = contact.force(contacts_->law());
    for (std::size_t i = 0; i < 4; ++i) {
      const Mean& mean = means_[points[i]];
      for (std::size_t n = 0; n < static_cast<std::size_t>(mean.count); ++n) {
        double* to = &r[static_cast<std::size_t>(mean.coordinate[n])];
        store3(load3(to) - (mean.weight[n] * contact.weight(i)) * force, to);
      }
    }
  });
  return all_finite(r) ? Status::ok : Status::retry;
}

Status CoupledStrands::linearize(double t, In q, In v, In a, Weights w) noexcept {
  uncoupled_ = w.vel == 0 && w.pos == 0;
  if (uncoupled_) {
    factored_ = Status::ok;
    for (std::size_t k = 0; k < strands() && factored_ == Status::ok; ++k) {
      factored_ = strand(k).linearize(t, part(q, k), part(v, k), part(a, k), w);
    }
    return factored_;
  }
  solver_->clear();
  for (std::size_t k = 0; k < strands(); ++k) {
    const Status s = strand(k).sparse_form()->values(t, part(q, k), part(v, k),
                                                     part(a, k), w, strand_values_[k]);
    if (s != Status::ok) return factored_ = s;
    solver_->add(k, strand_values_[k]);
  }
  place(t, q, v);
  contacts_->each_contact(x_, u_, [&](const auto& points, const PieceContact& contact) {
    solver_->add(contact.coupling(contacts_->law(), points), w);
  });
  return factored_ = solver_->factor();
}

Status CoupledStrands::solve(In b, Out x) noexcept {
  if (factored_ != Status::ok) return factored_;
  if (uncoupled_) {
    for (std::size_t k = 0; k < strands(); ++k) {
      const Status s = strand(k).solve(part(b, k), part(x, k));
      if (s != Status::ok) return s;
    }
    return Status::ok;
  }
  std::ranges::copy(b, x.begin());
  return solver_->solve(x);
}

void CoupledStrands::take_stresses(double t, In q, Stresses stresses) noexcept {
  for (const std::size_t k : stressed_) {
    strand(k).stress_form()->take_stresses(t, part(q, k), stresses);
  }
}

std::size_t CoupledStrands::tracked() const {
  std::size_t all = 0;
  for (const std::size_t k : held_contacts_) all += strand(k).contact_form()->tracked();
  return all;
}

void CoupledStrands::places(double t, In q, In v, Out x) noexcept {
  each_tracked(x, [&](std::size_t k, ContactForm& of, Out own) {
    of.places(t, part(q, k), part(v, k), own);
  });
}

void CoupledStrands::slides(double t, In q, In v, Out u) noexcept {
  each_tracked(u, [&](std::size_t k, ContactForm& of, Out own) {
    of.slides(t, part(q, k), part(v, k), own);
  });
}

void CoupledStrands::begin(double t, double tau, In q0, In v0, In x0) noexcept {
  each_tracked(x0, [&](std::size_t k, ContactForm& of, In own) {
    of.begin(t, tau, part(q0, k), part(v0, k), own);
  });
}

double CoupledStrands::improve(double t, In q, In v) noexcept {
  double worst = 0;
  for (const std::size_t k : held_contacts_) {
    worst = std::max(worst, strand(k).contact_form()->improve(t, part(q, k), part(v, k)));
  }
  return worst;
}

double CoupledStrands::drive() const noexcept {
  double fastest = 0;
  for (const std::size_t k : held_contacts_) {
    fastest = std::max(fastest, strand(k).contact_form()->drive());
  }
  return fastest;
}

void CoupledStrands::extrapolate() noexcept {
  for (const std::size_t k : held_contacts_) strand(k).contact_form()->extrapolate();
}

double CoupledStrands::approach(double t, In q, In v) noexcept {
  double fastest = 0;
  for (const std::size_t k : held_contacts_) {
    fastest =
        std::max(fastest, strand(k).contact_form()->approach(t, part(q, k), part(v, k)));
  }
  return fastest;
}

void CoupledStrands::release() noexcept {
  for (const std::size_t k : held_contacts_) strand(k).contact_form()->release();
}

bool CoupledStrands::rebounds() const {
  return std::ranges::any_of(held_contacts_, [this](std::size_t k) {
    return strand(k).contact_form()->rebounds();
  });
}

bool CoupledStrands::accept(double t, InOut q, InOut v) {
  const bool changed = accept_strands(t, q, v);
  positions(t, q, x_);
  if (!contacts_->update(x_)) return changed;
  couple();
  return true;
}

void CoupledStrands::reset() {
  for (std::size_t k = 0; k < strands(); ++k) strand(k).reset();
  place_at_start();
  if (contacts_->renew(x_)) couple();
}

std::vector<double> CoupledStrands::multipliers() const {
  std::vector<double> all;
  for (const std::size_t k : held_contacts_) {
    const std::vector<double> own = strand(k).contact_form()->multipliers();
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void CoupledStrands::set_multipliers(In values) {
  for (const std::size_t k : held_contacts_) {
    ContactForm& own = *strand(k).contact_form();
    const std::size_t size = own.multipliers().size();
    own.set_multipliers(values.first(size));
    values = values.subspan(size);
  }
}

/// Positions at which the pairs were found, then the memory of the strands.
std::vector<double> CoupledStrands::memory() const {
  std::vector<double> all = contacts_->made_at();
  const std::vector<double> own = memory_of_strands();
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

void CoupledStrands::recall(In memory) {
  if (contacts_->renew(memory.first(x_.size()))) couple();
  recall_strands(memory.subspan(x_.size()));
}

Energy CoupledStrands::energy(double t, In q, In v) {
  Energy sum = StrandBlock::energy(t, q, v);
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

/// A clamp also holds its point against the contacts.
double CoupledStrands::power(double t, In q, In v) {
  double sum = StrandBlock::power(t, q, v);
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

std::optional<MaterialPoints::Mean> CoupledStrands::mean(int point) {
  return means_[static_cast<std::size_t>(point)];
}

}  // namespace tress::models
