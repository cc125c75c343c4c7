// Prints a file of experiments/calibrate/data: `synthesize_records two_lengths >
// two_lengths.csv`.
#include <algorithm>
#include <cstdio>
#include <string>

#include "experiments/calibrate/shipped_records.h"

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::calibrate;
  const auto all = shipped_records();
  const auto found =
      std::ranges::find(all, argc == 2 ? argv[1] : "", &ShippedRecords::name);
  if (found == all.end()) {
    std::fputs(
        "usage: synthesize_records <name of a file in experiments/calibrate/data>\n",
        stderr);
    return 2;
  }
  const std::string text = csv_of(*found, synthetic(*found, found->seed));
  return std::fputs(text.c_str(), stdout) < 0 ? 1 : 0;
}
