// Whether order two is worth it where sweeps are few: xpbd_bdf2 beside xpbd, step for
// step.
#include <array>
#include <cmath>
#include <string>

#include "experiments/family/family.h"
#include "experiments/numerics/tip_track.h"
#include "integrators/integrator_options.h"

namespace tress::experiments::family {
namespace {

constexpr double accepted = 1.2;  // times the error of xpbd

constexpr Claim claims[] = {
    {"sweep_order2_at_300x4",
     "the error of xpbd_bdf2 is at most 1.2 times that of xpbd, 1/300 s and 4 sweeps",
     "error of xpbd_bdf2 over that of xpbd"},
    {"sweep_order2_at_300x20",
     "the error of xpbd_bdf2 is at most 1.2 times that of xpbd, 1/300 s and 20 sweeps",
     "error of xpbd_bdf2 over that of xpbd"},
    {"sweep_order2_at_1500x4",
     "the error of xpbd_bdf2 is at most 1.2 times that of xpbd, 1/1500 s and 4 sweeps",
     "error of xpbd_bdf2 over that of xpbd"},
    {"sweep_order2_at_1000x1",
     "the error of xpbd_bdf2 is at most 1.2 times that of xpbd, 1 ms and 1 sweep",
     "error of xpbd_bdf2 over that of xpbd"}};

struct Pace {
  double dt;  // s
  const char* sweeps;
};
constexpr Pace paces[] = {
    {1.0 / 300, "4"}, {1.0 / 300, "20"}, {1.0 / 1500, "4"}, {1e-3, "1"}};
static_assert(std::size(paces) == std::size(claims));

constexpr double t_end = 0.2;  // s
constexpr int samples = 12, elements = 20;
constexpr double fine_step = 5e-5;  // s, of the references
constexpr double most_gap = 1e-3;   // over the length

/// The springs of the rod, straightened: natural curls of springs need springs of their
/// own.
TipRun run_at(const Rod& rod, std::string_view integrator, const Options& options) {
  const auto system = make_system(straightened(rod), "mass_spring", elements);
  return run_tip(integrator, *system, options, t_end, samples);
}

double error_at(const Rod& rod, std::string_view integrator, const Pace& pace,
                In reference) {
  Options options;
  options.step = pace.dt;
  integrators::apply(options, "sweeps", pace.sweeps, "family");
  const TipRun run = run_at(rod, integrator, options);
  return tip_error(run.tip, reference, rod.length);
}

std::vector<Row> run(const Rod& rod, const Row& row) {
  Options fine;
  fine.step = fine_step;
  const TipRun reference = run_at(rod, "bdf2", fine);
  const TipRun other = run_at(rod, "generalized_alpha", fine);
  const double gap = tip_error(other.tip, reference.tip, rod.length);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < std::size(claims); ++i) {
    Row of_claim = row;
    of_claim.set("elements", elements);
    if (!(gap <= most_gap)) {
      rows.push_back(no_answer(of_claim, claims[i], "no_reference",
                               "bdf2 and generalized_alpha at 50 us do not agree"));
      continue;
    }
    of_claim.set("gap", gap);
    const double euler = error_at(rod, "xpbd", paces[i], reference.tip);
    const double order2 = error_at(rod, "xpbd_bdf2", paces[i], reference.tip);
    if (!std::isfinite(euler)) {
      rows.push_back(no_answer(of_claim, claims[i], "not_met", "xpbd itself diverges"));
    } else {
      constexpr double diverged = 1e3;
      const double ratio = std::isfinite(order2) ? order2 / euler : diverged;
      rows.push_back(answer(of_claim, claims[i], ratio, ratio <= accepted));
    }
  }
  return rows;
}

}  // namespace

const Study sweeps{.id = "sweeps", .claims = claims, .run = run, .quick = {.stride = 4}};

}  // namespace tress::experiments::family
