#include "experiments/simulate/head_series.h"

#include <algorithm>

namespace tress::experiments::scene_runs {

const std::vector<Reading>& head_series() {
  static const std::vector<Reading> all{
      {"t_s", "time"},
      {"tip_x_m", "tip, mean over the strands; all without lost strands"},
      {"tip_y_m", "tip, mean over the strands"},
      {"tip_z_m", "tip, mean over the strands"},
      {"kinetic_j", "kinetic energy of all strands"},
      {"elastic_j", "elastic energy of all strands"},
      {"gravity_j", "its potential energy, 0 at the origin"},
      {"most_kinetic_j", "kinetic energy of the strand that has most"},
      {"most_elastic_j", "elastic energy of the strand that has most"},
      {"fastest_m_s", "largest speed of an element's end"},
      {"lost_strands", "strands that have stopped, for their step was impossible"},
  };
  return all;
}

void HeadSeriesRow::add(const models::HeadEnergy& one, bool lost) {
  ++strands_;
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
}

std::vector<double> HeadSeriesRow::at(double t) const {
  const Vec tip = 1 / static_cast<double>(strands_ - lost_) * tip_;
  return {t,
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
}

}  // namespace tress::experiments::scene_runs
