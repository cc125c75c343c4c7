#include "integrators/gradient/watched_system.h"

#include "contract/forms/contact_form.h"

namespace tress::integrators {

void WatchedSystem::Motions::add(double t, In q, In v, In a, In lambda) {
  if (count == storage.size()) storage.emplace_back();
  Motion& motion = storage[count++];
  motion.t = t;
  motion.q.assign(q.begin(), q.end());
  motion.v.assign(v.begin(), v.end());
  motion.a.assign(a.begin(), a.end());
  motion.lambda.assign(lambda.begin(), lambda.end());
}

void WatchedSystem::solved(double t, In q, In v, In a, In lambda) noexcept {
  stages_.add(t, q, v, a, lambda);
  ContactForm* const contacts = system_.contact_form();
  if (contacts == nullptr) return;
  contact_.multipliers = contacts->multipliers();
  stages_.storage[stages_.count - 1].contact = contact_;
}

void WatchedSystem::prepared(double tau, In q0, In v0, In x0) noexcept {
  contact_.tau = tau;
  contact_.q0.assign(q0.begin(), q0.end());
  contact_.v0.assign(v0.begin(), v0.end());
  contact_.x0.assign(x0.begin(), x0.end());
}

bool WatchedSystem::accept(double t, InOut q, InOut v) {
  accepted_.t = t;
  accepted_.q.assign(q.begin(), q.end());
  accepted_.v.assign(v.begin(), v.end());
  return moved_ = system_.history()->accept(t, q, v);
}

bool WatchedSystem::carry(double t, InOut q, InOut v, InOut a) const {
  carried_.add(t, q, v, a, {});
  const bool carried = tress::carry(system_, t, q, v, a);
  if (!carried) --carried_.count;
  return carried;
}

}  // namespace tress::integrators
