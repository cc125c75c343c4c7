#include "models/catalogue.h"

#include <string>
#include <vector>

#include "models/input_error.h"

namespace tress {

std::span<const ModelEntry> models() { return {}; }

const ModelEntry& find_model(std::string_view id) {
  std::vector<std::string_view> ids;
  for (const ModelEntry& entry : models()) {
    if (entry.id == id) return entry;
    ids.push_back(entry.id);
  }
  const std::string_view near = nearest(id, ids);
  throw InputError("unknown model '" + std::string(id) + "'", "--models",
                   near.empty() ? "--list shows the models"
                                : "did you mean '" + std::string(near) + "'?");
}

}  // namespace tress
