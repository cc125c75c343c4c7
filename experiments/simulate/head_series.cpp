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

std::vector<double> head_series_row(double t, const models::Head& head,
                                    std::span<const models::HeadEnergy> each) {
  std::size_t lost = 0;
  Vec tip;
  double kinetic = 0, elastic = 0, gravity = 0, most_kinetic = 0, most_elastic = 0,
         fastest = 0;
  for (std::size_t k = 0; k < each.size(); ++k) {
    if (head.lost(k)) {
      ++lost;
      continue;
    }
    const models::HeadEnergy& one = each[k];
    tip = tip + one.tip;
    kinetic += one.kinetic;
    elastic += one.elastic;
    gravity += one.gravity;
    most_kinetic = std::max(most_kinetic, one.kinetic);
    most_elastic = std::max(most_elastic, one.elastic);
    fastest = std::max(fastest, one.fastest);
  }
  tip = 1 / static_cast<double>(each.size() - lost) * tip;
  return {t,
          tip.x,
          tip.y,
          tip.z,
          kinetic,
          elastic,
          gravity,
          most_kinetic,
          most_elastic,
          fastest,
          static_cast<double>(lost)};
}

}  // namespace tress::experiments::scene_runs
