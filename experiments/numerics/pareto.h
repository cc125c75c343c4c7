#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/files/row.h"

namespace tress::experiments {

/// Fills `pareto` of every ok row: true if no other ok row of its group has both less
/// wall_s and less of the column `error`.
void add_pareto(std::vector<Row>& rows, std::string_view error,
                const std::function<std::string(const Row&)>& group);

}  // namespace tress::experiments
