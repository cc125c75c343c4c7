#include "experiments/simulate/pictures.h"

#include <algorithm>
#include <filesystem>

#include "simulation/files/files.h"

namespace tress::experiments::scene_runs {

Pictures::Pictures(const Scene& scene, const World& world, const Readout& readout,
                   const SceneRunOptions& options)
    : scene_(scene),
      readout_(readout),
      options_(options),
      hair_(scene, readout.lines(), options.hairs),
      lines_(hair_.drawn(drawn_lines(scene, world, readout.lines()))) {}

void Pictures::write(const std::vector<Frame3d>& frames) const {
  std::vector<Frame3d> grown;
  if (hair_.hairs() > 0) grown = hair_.frames(frames);
  const std::vector<Frame3d>& drawn = hair_.hairs() > 0 ? grown : frames;
  const SmoothLines curves(hair_.lines(readout_.lines()), drawn);
  const Animation animation{scene_,
                            readout_.series(),
                            readout_.channels(),
                            lines_,
                            drawn,
                            curves,
                            hair_.hairs() > 0 ? readout_.lines().size() : 0};
  // A single particle is no line to draw.
  const auto& lines = readout_.lines();
  if (std::ranges::all_of(lines, [](int points) { return points > 1; })) {
    replace_file(options_.stem + ".json", page_json(animation));
  }
  if (options_.vtk) write_vtk(animation);
  if (options_.usd) replace_file(options_.stem + ".usda", usda(animation));
}

void Pictures::write_vtk(const Animation& animation) const {
  const std::string name = std::filesystem::path(options_.stem).filename();
  const std::string folder = options_.stem + "_vtk/";
  std::error_code shown_by_the_first_file;
  std::filesystem::create_directories(folder, shown_by_the_first_file);
  for (std::size_t f = 0; f < animation.frames.size(); ++f) {
    replace_file(folder + vtp_name(name, f), vtp(animation, animation.frames[f]));
  }
  replace_file(folder + name + ".pvd", pvd(animation, name));
}

}  // namespace tress::experiments::scene_runs
