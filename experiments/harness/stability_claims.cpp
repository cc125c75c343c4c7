#include "experiments/harness/stability_claims.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace tress {
namespace {

/// All that tells rows apart but for the solver.
std::string setting_of(const Row& row) {
  std::string key;
  for (const std::string_view column :
       {"scene", "model", "integrator", "tangent", "modes", "elements", "damping"}) {
    key.append(row.text(column)).append("/");
  }
  return key;
}

/// Largest stable step by setting, of the rows with this solver whose search was done.
std::map<std::string, double> limits_of(const std::vector<Row>& rows,
                                        std::string_view solver) {
  std::map<std::string, double> limits;
  for (const Row& row : rows) {
    if (row.text("solver") != solver || !row.ok()) continue;
    limits[setting_of(row)] = row.number("dt_max_s");
  }
  return limits;
}

struct Pair {
  std::string setting;
  double first, second;
};

std::vector<Pair> pairs(const std::vector<Row>& rows, std::string_view first,
                        std::string_view second) {
  std::vector<Pair> both;
  const auto others = limits_of(rows, second);
  for (const auto& [setting, limit] : limits_of(rows, first)) {
    const auto found = others.find(setting);
    if (found != others.end()) both.push_back({setting, limit, found->second});
  }
  return both;
}

/// One verdict per scene, on the pair for which `excess` is largest.
template <typename Excess>
void check_pairs(const std::vector<Pair>& all, const std::string& claim, double allowed,
                 Excess excess, Verdicts& verdicts) {
  std::map<std::string, std::pair<double, std::string>> worst;
  for (const Pair& pair : all) {
    auto& [most, where] = worst[pair.setting.substr(0, pair.setting.find('/'))];
    if (where.empty() || excess(pair) > most) {
      most = excess(pair);
      where = pair.setting;
    }
  }
  for (const auto& [scene, at] : worst) {
    verdicts.check(scene + ": " + claim + ", worst at " + at.second, at.first <= allowed,
                   at.first);
  }
}

const Row* shaken(const std::vector<Row>& rows, std::string_view integrator,
                  std::string_view tangent) {
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.text("scene") == "shake" && row.text("model") == "super_helix" &&
           row.text("integrator") == integrator && row.text("solver") == "recursive" &&
           row.text("tangent") == tangent && row.text("modes") == "bend_twist" &&
           row.text("elements") == "20" && row.text("damping") == "none" && row.ok();
  });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

void check_stability_claims(const std::vector<Row>& rows, double resolution,
                            Verdicts& verdicts) {
  // Each limit lies within a factor `resolution` above its dt_max.
  const double same = resolution * (1 + 1e-9);
  check_pairs(
      pairs(rows, "recursive", "composite"),
      "recursive and composite have the same largest step", same,
      [](const Pair& p) { return std::max(p.first / p.second, p.second / p.first); },
      verdicts);
  check_pairs(
      pairs(rows, "less_implicit", "recursive"), "less_implicit never exceeds recursive",
      same, [](const Pair& p) { return p.first / p.second; }, verdicts);

  if (const Row* row = shaken(rows, "backward_euler", "exact")) {
    const double dt = row->number("dt_max_s");
    verdicts.check("shake, undamped, N = 20: backward_euler exact is stable at 33 ms",
                   dt >= 0.033, dt);
  }
  if (const Row* row = shaken(rows, "semi_implicit_euler", "stiff")) {
    const double dt = row->number("dt_max_s");
    verdicts.check("shake, undamped, N = 20: semi_implicit_euler stiff stays below 2 ms",
                   dt < 0.002, dt);
  }
}

}  // namespace tress
