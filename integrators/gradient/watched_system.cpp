#include "integrators/gradient/watched_system.h"

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
