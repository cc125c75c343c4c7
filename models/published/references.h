#pragma once

#include <string_view>

#include "models/system.h"

namespace tress {

/// State at the end time of a published problem, at its default parameters (SI).
struct PublishedEnd {
  std::string_view model;  // catalogue id
  double t;                // s
  In q;                    // (n)
  In v;                    // (n)
  In lambda;               // (m), signs of r - G^T lambda = 0; empty without constraints
  int digits_q;            // digits that tests/models/published reproduces
  int digits_v;
  std::string_view source;
};

/// The published end state of a model, null when there is none.
const PublishedEnd* published_end(std::string_view model);

}  // namespace tress
