#include "experiments/simulate/pictures.h"

#include <algorithm>
#include <filesystem>

#include "simulation/files/files.h"

namespace tress::experiments::scene_runs {
namespace {

/// A file for each frame in the folder <stem>_<kind>, which it returns.
std::string write_frames(const Animation& animation, const std::string& stem,
                         const std::string& kind, const auto& name_of,
                         const auto& text_of) {
  const std::string name = std::filesystem::path(stem).filename();
  const std::string folder = stem + "_" + kind + "/";
  std::error_code shown_by_the_first_file;
  std::filesystem::create_directories(folder, shown_by_the_first_file);
  for (std::size_t f = 0; f < animation.frames.size(); ++f) {
    replace_file(folder + name_of(name, f), text_of(animation, animation.frames[f]));
  }
  return folder;
}

}  // namespace

Pictures::Pictures(const Scene& scene, const World& world, const Readout& readout,
                   const SceneRunOptions& options)
    : scene_(scene),
      readout_(readout),
      options_(options),
      hair_(scene, readout.lines(), options.hairs),
      lines_(hair_.drawn(drawn_lines(scene, world, readout.lines()))) {}

std::vector<Frame3d> Pictures::with(const std::vector<FurtherChannel>& further,
                                    std::vector<Frame3d> frames) const {
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<float>& channels = frames[f].channels;
    for (const FurtherChannel& channel : further) {
      const std::vector<float> values = readout_.at_drawn(channel.frames[f]);
      channels.insert(channels.end(), values.begin(), values.end());
    }
  }
  return frames;
}

void Pictures::write(const std::vector<Frame3d>& frames,
                     const std::vector<FurtherChannel>& further) const {
  if (further.empty()) return write(frames, readout_.channels());
  std::vector<Reading> channels = readout_.channels();
  for (const FurtherChannel& channel : further) channels.push_back(channel.reading);
  write(with(further, frames), channels);
}

void Pictures::write(const std::vector<Frame3d>& frames,
                     const std::vector<Reading>& channels) const {
  std::vector<Frame3d> grown;
  if (hair_.hairs() > 0) grown = hair_.frames(frames);
  const std::vector<Frame3d>& drawn = hair_.hairs() > 0 ? grown : frames;
  const SmoothLines curves(hair_.lines(readout_.lines()), drawn);
  const Animation animation{scene_,
                            readout_.series(),
                            channels,
                            lines_,
                            drawn,
                            curves,
                            hair_.hairs() > 0 ? readout_.lines().size() : 0};
  write_pictures(animation, options_);
}

void write_pictures(const Animation& animation, const SceneRunOptions& options) {
  // A single particle is no line to draw.
  if (std::ranges::all_of(animation.curves.lines(), [](int n) { return n > 1; })) {
    replace_file(options.stem + ".json", page_json(animation));
  }
  if (options.vtk) {
    const std::string name = std::filesystem::path(options.stem).filename();
    const std::string folder =
        write_frames(animation, options.stem, "vtk", vtp_name, vtp);
    replace_file(folder + name + ".pvd", pvd(animation, name));
  }
  if (options.hair) write_frames(animation, options.stem, "hair", hair_name, hair);
  if (options.usd) replace_file(options.stem + ".usda", usda(animation));
  if (options.gltf) replace_file(options.stem + ".glb", glb(animation));
}

}  // namespace tress::experiments::scene_runs
