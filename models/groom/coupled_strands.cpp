#include "models/groom/coupled_strands.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "contract/input_error.h"
#include "linear/finite.h"
#include "models/effects/coupling_pattern.h"

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
    : strands_(std::move(strands)) {
  for (std::size_t k = 0; k < strands_.size(); ++k) check_and_join(*strands_[k], k);
  std::vector<int> points;
  for (std::size_t k = 0; k < strands_.size(); ++k) {
    points.push_back(first_point_[k + 1] - first_point_[k]);
  }
  x_.resize(3 * means_.size());
  u_.resize(x_.size());
  std::vector<double> q(static_cast<std::size_t>(first_.back())), v(q.size());
  initial_state(q, v);
  positions(0, q, x_);
  contacts_ = std::make_unique<StrandContacts>(law, std::move(points), x_);
  build_matrix();
}

void CoupledStrands::check_and_join(System& strand, std::size_t k) {
  const Layout layout = strand.layout();
  if (layout.constraints > 0) refuse(k, "has constraints, whose solver is its own");
  SparseForm* sparse = strand.sparse_form();
  if (sparse == nullptr) refuse(k, "has no sparse tangent to put among the others");
  MaterialPoints* points = strand.material_points();
  if (points == nullptr || points->count() < 2) refuse(k, "has fewer than two points");
  for (int i = 0; i < points->count(); ++i) {
    std::optional<Mean> mean = points->mean(i);
    if (!mean) {
      refuse(k,
             "has points that are not fixed means of its coordinates, so that forces "
             "between strands have no sparse tangent");
    }
    for (int n = 0; n < mean->count; ++n) {
      mean->coordinate[static_cast<std::size_t>(n)] += first_.back();
    }
    means_.push_back(*mean);
  }
  first_.push_back(first_.back() + layout.coordinates);
  first_point_.push_back(static_cast<int>(means_.size()));
  strand_values_.emplace_back(static_cast<std::size_t>(sparse->pattern().nonzeros()));
}

/// Couples the coordinates of all segments that may touch.
void CoupledStrands::build_matrix() {
  const int n = first_.back();
  CouplingColumns columns(n, means_);
  for (std::size_t i = 0; i < contacts_->segments(); ++i) {
    const std::size_t own = contacts_->point(static_cast<int>(i));
    for (const int partner : contacts_->partners(i)) {
      const std::size_t other = contacts_->point(partner);
      columns.add({own, own + 1, other, other + 1});
    }
  }
  coupling_ = std::move(columns).pattern();
  coupling_values_.resize(static_cast<std::size_t>(coupling_.nonzeros()));
  matrix_ = std::make_unique<BlockMatrix>(n, n);
  for (std::size_t k = 0; k < strands(); ++k) {
    matrix_->add_block(strands_[k]->sparse_form()->pattern(), first_[k], first_[k]);
  }
  matrix_->add_block(coupling_, 0, 0);
  matrix_->finish();
  solver_ = make_linear_solver(LinearKind::klu, matrix_->pattern());
  factored_ = Status::retry;
}

Traits CoupledStrands::traits() const {
  Traits all{.constant_mass = true, .regular_mass = true};
  for (const auto& strand : strands_) {
    const Traits traits = strand->traits();
    all.constant_mass = all.constant_mass && traits.constant_mass;
    all.regular_mass = all.regular_mass && traits.regular_mass;
  }
  return all;
}

void CoupledStrands::initial_state(Out q, Out v) const {
  for (std::size_t k = 0; k < strands(); ++k) {
    strands_[k]->initial_state(part(q, k), part(v, k));
  }
}

void CoupledStrands::scale(Out q_typ, Out v_typ) const {
  for (std::size_t k = 0; k < strands(); ++k) {
    strands_[k]->scale(part(q_typ, k), part(v_typ, k));
  }
}

void CoupledStrands::place(double t, In q, In v) noexcept {
  positions(t, q, x_);
  velocities(t, q, v, u_);
}

Status CoupledStrands::residual(double t, In q, In v, In a, Out r) noexcept {
  for (std::size_t k = 0; k < strands(); ++k) {
    const Status s =
        strands_[k]->residual(t, part(q, k), part(v, k), part(a, k), part(r, k));
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

/// coupling_values_ = -w.pos P^T df/dx P - w.vel P^T df/dv P, at x_ and u_.
void CoupledStrands::add_contacts(Weights w) noexcept {
  std::ranges::fill(coupling_values_, 0.0);
  contacts_->each_contact(x_, u_, [&](const auto& points, const PieceContact& contact) {
    add_coupling(coupling_, means_, contact.coupling(contacts_->law(), points), -w.pos,
                 -w.vel, coupling_values_);
  });
}

Status CoupledStrands::linearize(double t, In q, In v, In a, Weights w) noexcept {
  uncoupled_ = w.vel == 0 && w.pos == 0;
  if (uncoupled_) {
    factored_ = Status::ok;
    for (std::size_t k = 0; k < strands() && factored_ == Status::ok; ++k) {
      factored_ = strands_[k]->linearize(t, part(q, k), part(v, k), part(a, k), w);
    }
    return factored_;
  }
  matrix_->clear();
  for (std::size_t k = 0; k < strands(); ++k) {
    const Status s = strands_[k]->sparse_form()->values(t, part(q, k), part(v, k),
                                                        part(a, k), w, strand_values_[k]);
    if (s != Status::ok) return factored_ = s;
    matrix_->add(static_cast<int>(k), 1, strand_values_[k]);
  }
  place(t, q, v);
  add_contacts(w);
  matrix_->add(static_cast<int>(strands()), 1, coupling_values_);
  if (!all_finite(matrix_->values())) return factored_ = Status::retry;
  return factored_ = solver_->factor(matrix_->values());
}

Status CoupledStrands::solve(In b, Out x) noexcept {
  if (factored_ != Status::ok) return factored_;
  if (uncoupled_) {
    for (std::size_t k = 0; k < strands(); ++k) {
      const Status s = strands_[k]->solve(part(b, k), part(x, k));
      if (s != Status::ok) return s;
    }
    return Status::ok;
  }
  std::ranges::copy(b, x.begin());
  return solver_->solve(x);
}

double CoupledStrands::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& strand : strands_) next = std::min(next, strand->next_breakpoint(t));
  return next;
}

bool CoupledStrands::accept(double t, InOut q, InOut v) {
  bool changed = false;
  for (std::size_t k = 0; k < strands(); ++k) {
    if (strands_[k]->accept(t, part(q, k), part(v, k))) changed = true;
  }
  positions(t, q, x_);
  if (!contacts_->update(x_)) return changed;
  build_matrix();
  return true;
}

void CoupledStrands::reset() {
  for (const auto& strand : strands_) strand->reset();
  std::vector<double> q(static_cast<std::size_t>(first_.back())), v(q.size());
  initial_state(q, v);
  positions(0, q, x_);
  if (contacts_->renew(x_)) build_matrix();
}

/// Positions at which the pairs were found, then per strand the size and data of its
/// memory.
std::vector<double> CoupledStrands::memory() const {
  std::vector<double> all = contacts_->made_at();
  for (const auto& strand : strands_) {
    const std::vector<double> own = strand->memory();
    all.push_back(static_cast<double>(own.size()));
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void CoupledStrands::recall(In memory) {
  if (contacts_->renew(memory.first(x_.size()))) build_matrix();
  std::size_t at = x_.size();
  for (const auto& strand : strands_) {
    const auto size = static_cast<std::size_t>(memory[at]);
    strand->recall(memory.subspan(at + 1, size));
    at += 1 + size;
  }
}

}  // namespace tress::models
