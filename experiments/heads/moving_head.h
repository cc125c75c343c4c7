#pragma once

#include <memory>
#include <string_view>

#include "simulation/files/row.h"
#include "simulation/head/make_head.h"

namespace tress::experiments::heads {

using namespace simulation;

/// A model's head with a method.
struct Kind {
  std::string_view model, integrator;
  std::unique_ptr<models::Head> (*make)(const HeadOptions&, const models::HeadPack&);
  HeadMethod method;
  bool narrow;  // in 32 bits, too
};

/// Effects on the hairs in addition to gravity.
enum class Acting { none, drag, body, interaction };
constexpr std::string_view names_of_acting[] = {"none", "drag", "body", "interaction"};

struct Work {
  Kind kind;
  std::size_t strands;
  int elements;
  models::HeadPack pack;
  int threads;
  double dt;  // s
  int frames;
  Acting acting;
};

/// Builds the head, moves and reads it, and sets what that took and gave.
void run_head(const Work& work, Row& row);

}  // namespace tress::experiments::heads
