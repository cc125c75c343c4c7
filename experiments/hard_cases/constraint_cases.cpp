#include <algorithm>
#include <set>

#include "experiments/hard_cases/gauges.h"
#include "experiments/problems/strand_models.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr double displaced = 0.1;  // of the length

std::string has_constraints(System& system) {
  return system.layout().constraints > 0 ? "" : "it has no constraint to violate";
}

/// Moves all free parts along x by a tenth of the length: the first constraint is
/// violated by as much.
void move_along(const Situation& s, State& start) {
  MaterialPoints& points = *s.system->material_points();
  std::set<int> x;  // coordinates
  for (int i = 0; i < points.count(); ++i) {
    const auto mean = points.mean(i);
    if (!mean) {  // particles: coordinates are places
      x.insert(3 * i);
      continue;
    }
    const auto own =
        std::span(mean->coordinate).first(static_cast<std::size_t>(mean->count));
    x.insert(own.begin(), own.end());
  }
  for (const int c : x) start.q[static_cast<std::size_t>(c)] += displaced * s.length;
}

/// A chain as the limit of springs: the hair's mass, length and links.
const ModelSettings hair_of_links{
    {"links", "20"}, {"length_m", "0.1"}, {"mass_kg", "6.5e-7"}};
const ModelSettings hair_of_bars{
    {"structure", "chain"}, {"size", "20"}, {"length_m", "0.1"}, {"mass_kg", "6.5e-7"}};

}  // namespace

std::vector<HardCase> constraint_cases() {
  std::vector<HardCase> all;
  // Tension of a falling hair stays below some 100 of its weights, 6e-4 N; EA = 1.5e3 N.
  all.push_back(
      {.name = "nearly_inextensible",
       .why = "EI and mass of a hair with 100 times its EA: stretching is 1e9 "
              "times as stiff as bending, waves along it pass 100 000 elements in 1/30 s",
       .measure = "stretch_rel",
       .criterion = "no length changes by more than 1e-4, hundreds of times what 100 "
                    "weights of the strand do; the energy rises by less than 1 % of what "
                    "falling can turn into motion",
       .limit = 1e-4,
       .settings = {{"motion", "fixed"},
                    {"root_tangent", "x"},
                    {"youngs_modulus_pa", "3e13"},
                    {"radius_m", "4e-6"},
                    {"density_kg_m3", "1.3e5"}},
       .particles = {{"inextensible_chain", hair_of_links}, {"tinkertoys", hair_of_bars}},
       .bounds = passive_bounds,
       .gauge = stretch_gauge});
  all.push_back(
      {.name = "inconsistent_start",
       .why = "starts a tenth of its length off its first constraint: there is no "
              "motion that begins so",
       .measure = "left_over_bound",
       .criterion = "at the end constraints hold to 1e-3 of their scale, and the energy "
                    "rose by less than it takes to lift the strand by its length",
       .settings = {{"motion", "fixed"}, {"root_tangent", "x"}},
       .t_end = 0.3,
       .horizon = 0,
       .particles = {{"inextensible_chain", hair_of_links},
                     {"tinkertoys", hair_of_bars},
                     {"tinkertoys", {{"structure", "tree"}}}},
       .bounds = no_bounds,
       .gauge =
           [](const Situation& s) {
             return recovery_gauge(
                 s, s.mass * s.parameters.number("gravity_m_s2") * s.length);
           },
       .displace = move_along,
       .objection = has_constraints});
  all.push_back({.name = "redundant_constraints",
                 .why =
                     "loops that close and bars that are one too many: the constraints' "
                     "matrix has no full rank, multipliers are not unique",
                 .measure = "violation_rel",
                 .criterion = "constraints hold to 1e-3 of their scale, and the energy "
                              "rises by less than 1 % of m g L",
                 .limit = 1e-3,
                 .horizon = 0.2,
                 .not_for_strands = "a strand has no loop to close and no spare bars",
                 .particles = {{"inextensible_chain", {{"closed", "yes"}}},
                               {"tinkertoys", {{"structure", "ring"}}},
                               {"tinkertoys", {{"structure", "net"}}},
                               {"tinkertoys", {{"structure", "truss"}}}},
                 .bounds = passive_bounds,
                 .gauge = violation_gauge});
  return all;
}

}  // namespace tress::experiments::hard_cases
