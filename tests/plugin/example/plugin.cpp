#include "example.h"

namespace {

void bring(tress::simulation::Plugin& plugin) {
  plugin.models = {example::simo_reissner_entry()};
#ifndef SPOILT
  plugin.integrators = {example::sdirk2_entry()};
  plugin.effects = {example::rotating_frame_entry(), example::magnetic_rod_entry()};
#endif
}

}  // namespace

TRESS_PLUGIN(bring);
