#include "experiments/validation/rods/contact_run.h"

#include <array>

#include "contract/forms/contact_form.h"

namespace tress::experiments::validation {

Strand ContactRun::strand(Strand of_test) const {
  models::RootMotion& root = of_test.root;
  root.position = turned * root.position;
  root.frame = turned * root.frame;
  for (auto& part : root.translations) part.direction = turned * part.direction;
  if (auto& free = of_test.free_root) {
    free->position = turned * free->position;
    free->frame = turned * free->frame;
    free->velocity = turned * free->velocity;
    free->spin = turned * free->spin;
  }
  return of_test;
}

StrandPlace ContactRun::place(const StrandPlace& of_test) const {
  return {turned * of_test.x, turned * of_test.frame};
}

Look ContactRun::look(System& system, int point, int axis) const {
  std::array<Look, 3> world;
  for (int k = 0; k < 3; ++k) {
    world[static_cast<std::size_t>(k)] = validation::place(system, point, k);
  }
  return
      [&system, world, axis, turned = turned, drive = each_drive](double t, In q, In v) {
        if (drive && system.contact_form() != nullptr) {
          drive(system.contact_form()->drive());
        }
        const Vec x{world[0](t, q, v), world[1](t, q, v), world[2](t, q, v)};
        const Vec own = turned.back(x);
        return axis == 0 ? own.x : axis == 1 ? own.y : own.z;
      };
}

}  // namespace tress::experiments::validation
