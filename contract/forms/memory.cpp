#include "contract/forms/contact_form.h"
#include "contract/forms/history.h"
#include "contract/system.h"

namespace tress {

bool System::accept(double t, InOut q, InOut v) {
  return history() != nullptr && history()->accept(t, q, v);
}

void System::reset() {
  if (history() != nullptr) history()->reset();
  if (contact_form() == nullptr) return;
  const std::vector<double> none(contact_form()->multipliers().size());
  contact_form()->set_multipliers(none);
}

std::vector<double> System::memory() {
  auto all = history() == nullptr ? std::vector<double>{} : history()->memory();
  if (contact_form() == nullptr) return all;
  const std::vector<double> multipliers = contact_form()->multipliers();
  all.insert(all.end(), multipliers.begin(), multipliers.end());
  return all;
}

void System::recall(In memory) {
  const std::size_t multipliers =
      contact_form() == nullptr ? 0 : contact_form()->multipliers().size();
  const std::size_t of_history = memory.size() - multipliers;
  if (history() != nullptr) history()->recall(memory.first(of_history));
  if (multipliers > 0) contact_form()->set_multipliers(memory.last(multipliers));
}

}  // namespace tress
