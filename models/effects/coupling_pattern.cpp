#include "models/effects/coupling_pattern.h"

#include "linear/sparse_pattern.h"

namespace tress::models {

void CouplingColumns::add(const FourPoints& contact) {
  std::vector<int> all;
  for (const std::size_t point : contact) {
    const MaterialPoints::Mean& mean = means_[point];
    for (int n = 0; n < mean.count; ++n) {
      const int c = mean.coordinate[static_cast<std::size_t>(n)];
      all.insert(all.end(), {c, c + 1, c + 2});
    }
  }
  for (const int c : all) {
    auto& column = columns_[static_cast<std::size_t>(c)];
    column.insert(column.end(), all.begin(), all.end());
  }
}

Pattern CouplingColumns::pattern() && {
  const auto n = static_cast<int>(columns_.size());
  return pattern_of(n, std::move(columns_));
}

void add_coupling(const Pattern& pattern, const std::vector<MaterialPoints::Mean>& means,
                  const Coupling& contact, double pos, double vel,
                  InOut values) noexcept {
  const auto add = [&](const MaterialPoints::Mean& row,
                       const MaterialPoints::Mean& column, const double* block) {
    for (std::size_t m = 0; m < static_cast<std::size_t>(row.count); ++m) {
      for (std::size_t n = 0; n < static_cast<std::size_t>(column.count); ++n) {
        const double weight = row.weight[m] * column.weight[n];
        for (int j = 0; j < 3; ++j) {
          const int place =
              place_of(pattern, row.coordinate[m], column.coordinate[n] + j);
          double* at = &values[static_cast<std::size_t>(place)];
          for (int i = 0; i < 3; ++i) at[i] += weight * block[3 * i + j];
        }
      }
    }
  };
  for (std::size_t i = 0; i < contact.ends.size(); ++i) {
    for (std::size_t j = 0; j < contact.ends.size(); ++j) {
      std::array<double, 9> block{};
      contact.add_block(i, j, pos, vel, block.data());
      add(means[contact.ends[i].point], means[contact.ends[j].point], block.data());
    }
  }
}

}  // namespace tress::models
