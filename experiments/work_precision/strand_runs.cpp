#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "experiments/numerics/tip_track.h"
#include "experiments/problems/reference.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/message.h"
#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {
namespace {

/// Of the reference of models whose fast modes are too fast for explicit methods.
constexpr double release_step = 1e-4;  // s

/// Models without stretch and shear, whose fastest modes are those of bending.
bool resolved_by_explicit_methods(const ModelEntry& model) {
  return model.id == "super_helix" || model.id == "articulated_chain";
}

/// References for errors: computed before any row runs, since rows run in separate
/// processes.
class References {
 public:
  References(const Settings& settings, const std::vector<StrandCase>& cases) {
    for (const StrandCase& c : cases) {
      TipReference& reference = all_[key(c)];
      if (reference.tip.empty()) reference = made(c, settings);
    }
  }

  const TipReference& of(const StrandCase& c) const { return all_.at(key(c)); }

 private:
  /// For the continuous rod: no model and no elements.
  using Key = std::tuple<std::string_view, std::string_view, int>;
  static Key key(const StrandCase& c) {
    if (c.error_kind == "total") return {c.strand->name, "", 0};
    return {c.strand->name, c.model->id, c.elements};
  }

  static TipReference made(const StrandCase& c, const Settings& settings) {
    const FollowedStrand& strand = *c.strand;
    const MakeStrand make = [&](std::string_view model, int elements) {
      const ModelEntry& entry = find_model(model);
      Parameters p = strand_parameters_of(strand, settings, entry, elements);
      if (has_word(entry, "jacobian", "elastic")) set_known(p, {{"jacobian", "elastic"}});
      return entry.make(p);
    };
    if (c.error_kind == "total") {
      tell("{}: continuous rod\n", strand.name);
      return converged_rod(make, strand.sampling);
    }
    tell("{}: converged {}, {} elements\n", strand.name, c.model->id, c.elements);
    if (c.strand == &strand_release || !resolved_by_explicit_methods(*c.model)) {
      return extrapolated_model(make, c.model->id, c.elements, strand.sampling,
                                release_step);
    }
    return converged_model(make, c.model->id, c.elements, strand.sampling);
  }

  std::map<Key, TipReference> all_;
};

void measure(const StrandCase& c, const Parameters& parameters,
             const TipReference& reference, int repeat, Row& row) {
  const TipSampling& sampling = c.strand->sampling;
  const auto system = c.model->make(parameters);
  Guard guard(*system, guarded_strands(*c.model, parameters));
  const TipRun run = run_tip(c.integrator, *system, c.options, sampling.t_end,
                             sampling.samples, repeat, &guard);
  set_counts(run.stats, row);
  if (run.status != Status::ok) {
    row.failed("solver_error", run.failure);
    return;
  }
  const double error = tip_error(run.tip, reference.tip, sampling.length);
  if (!(error <= 0.5)) {
    row.failed("diverged", "error above half the length of the strand");
    return;
  }
  set_error(error, reference.gap, row);
  set_achieved(largest_tip_error(run.tip, reference.tip, sampling.length), c.options,
               row);
  set_time(run.wall_s, sampling.t_end, row);
}

}  // namespace

std::vector<Case> strand_runs(const CommandLine& line, const Settings& settings) {
  const std::vector<StrandCase> chosen = strand_cases(line, settings);
  const auto references =
      line.dry_run ? nullptr : std::make_shared<const References>(settings, chosen);
  std::vector<Case> all;
  all.reserve(chosen.size());
  for (const StrandCase& c : chosen) {
    all.push_back({c.identity(), [c, references, parameters = c.parameters(settings),
                                  repeat = line.repeat](Row& row, const Deadline&) {
                     measure(c, parameters, references->of(c), repeat, row);
                   }});
  }
  return all;
}

}  // namespace tress::experiments::work_precision
