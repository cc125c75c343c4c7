#include "experiments/simulate/head_series.h"

#include <algorithm>

namespace tress::experiments::scene_runs {

std::vector<Reading> head_series(const Scene& scene) {
  std::vector<Reading> all{
      {"t_s", "time"},
      {"tip_x_m",
       "tip, mean over the strands that have not failed; empty if all have. Energies "
       "leave failed strands out"},
      {"tip_y_m", "tip, mean over the strands"},
      {"tip_z_m", "tip, mean over the strands"},
      {"kinetic_j", "kinetic energy of all strands"},
      {"elastic_j", "elastic energy of all strands"},
      {"gravity_j", "potential energy of gravity, 0 at the origin"},
      {"most_kinetic_j", "largest kinetic energy of a strand"},
      {"most_elastic_j", "largest elastic energy of a strand"},
      {"fastest_m_s", "largest speed of an element's end"},
      {"failed_strands", "strands that have stopped, for their step was impossible"},
  };
  const models::Effects effects = make_effects(scene);
  const std::vector<std::string> names = effect_names(scene);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (effects[i]->uniform_acceleration()) continue;
    all.push_back({names[i] + "_j", "potential energy of the effect"});
  }
  return all;
}

void HeadSeriesRow::add(const models::HeadEnergy& one, std::span<const double> potentials,
                        bool lost) {
  ++strands_;
  effects_.resize(potentials.size());
  if (lost) {
    ++lost_;
    return;
  }
  tip_ = tip_ + one.tip;
  kinetic_ += one.kinetic;
  elastic_ += one.elastic;
  gravity_ += one.gravity;
  most_kinetic_ = std::max(most_kinetic_, one.kinetic);
  most_elastic_ = std::max(most_elastic_, one.elastic);
  fastest_ = std::max(fastest_, one.fastest);
  for (std::size_t i = 0; i < potentials.size(); ++i) effects_[i] += potentials[i];
}

std::vector<double> HeadSeriesRow::at(double t) const {
  const Vec tip = 1 / static_cast<double>(strands_ - lost_) * tip_;
  std::vector<double> row{t,
                          tip.x,
                          tip.y,
                          tip.z,
                          kinetic_,
                          elastic_,
                          gravity_,
                          most_kinetic_,
                          most_elastic_,
                          fastest_,
                          static_cast<double>(lost_)};
  row.insert(row.end(), effects_.begin(), effects_.end());
  return row;
}

}  // namespace tress::experiments::scene_runs
