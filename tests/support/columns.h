#pragma once

#include <gtest/gtest.h>

#include <string>

#include "simulation/run/readout.h"

namespace tress::testing_support {

/// Value of a column of the series in a frame.
inline double column(const simulation::Readout& readout, const simulation::Frame3d& frame,
                     const std::string& name) {
  for (std::size_t i = 0; i < frame.series.size(); ++i) {
    if (readout.series()[i].name == name) return frame.series[i];
  }
  ADD_FAILURE() << name;
  return 0;
}

}  // namespace tress::testing_support
