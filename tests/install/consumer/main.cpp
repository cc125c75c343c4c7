// Runs a scene for a tenth of a second, or as long as it is, and tells where its last
// point is then and what its energies are: consumer SCENE.TOML
#include <algorithm>
#include <cstdio>
#include <exception>

#include "simulation/run/world.h"

int main(int argc, char** argv) try {
  if (argc != 2) return std::fputs("usage: consumer scene.toml\n", stderr), 2;
  const tress::simulation::Scene scene = tress::simulation::read_scene(argv[1]);
  tress::simulation::World world(scene);
  if (world.advance(std::min(0.1, scene.duration)) != tress::Status::ok) {
    return std::fprintf(stderr, "%s\n", world.failure().c_str()), 3;
  }
  const double* tip = world.positions().data() + world.positions().size() - 3;
  const tress::simulation::Energies energies = world.energies();
  std::printf("t = %g s, %zu strands, last point (%g, %g, %g) m, kinetic %g J\n",
              world.time(), world.strands(), tip[0], tip[1], tip[2], energies.kinetic);
} catch (const std::exception& failure) {
  return std::fprintf(stderr, "%s\n", failure.what()), 2;
}
