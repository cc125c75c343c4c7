#pragma once

#include "simulation/plugin/plugin.h"

namespace example {

tress::models::ModelEntry simo_reissner_entry();
tress::integrators::IntegratorEntry sdirk2_entry();
tress::models::EffectEntry rotating_frame_entry();
tress::models::EffectEntry magnetic_rod_entry();

}  // namespace example
