#include "models/catalogue.h"

#include <string>
#include <vector>

#include "models/constrained/bead_on_wire.h"
#include "models/constrained/inextensible_chain.h"
#include "models/constrained/tinkertoys.h"
#include "models/input_error.h"

namespace tress {

std::span<const ModelEntry> models() {
  static const ModelEntry entries[] = {
      {"bead_on_wire", "bead on circle, ellipse, helix or trefoil: x with lambda, or s",
       "Witkin 1997", bead_on_wire_parameters(), make_bead_on_wire},
      {"tinkertoys", "3n particles in a chain, ring, net, tree or over-constrained truss",
       "Witkin 1997", tinkertoys_parameters(), make_tinkertoys},
      {"inextensible_chain", "hanging strand of n rigid links: 3n with n lambda, open or closed",
       "Baraff 1996", inextensible_chain_parameters(), make_inextensible_chain},
  };
  return entries;
}

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
