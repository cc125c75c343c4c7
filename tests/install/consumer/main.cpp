// Pulls both catalogues in, and with them every library that static linking needs.
#include <cstdio>

#include "integrators/catalogue.h"
#include "models/catalogue.h"

int main() {
  std::printf("%zu models, %zu integrators\n", tress::models().size(),
              tress::integrators().size());
}
