#include "experiments/simulate/head_room.h"

#include <fmt/format.h>

#include <filesystem>

#include "contract/input_error.h"
#include "experiments/run/message.h"
#include "simulation/head/scene_head.h"
#include "simulation/run/memory.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::scene_runs {

void check_room(const SceneOutline& outline, const SceneRunOptions& options) {
  const Scene& scene = outline.scene;
  const Ranks& ranks = *options.ranks;
  const std::optional<NoHead> without = no_lanes(scene, options.pack.number);
  const std::size_t strands = outline.series->size(),
                    elements = scene.strands.front().segments.size(),
                    size = static_cast<std::size_t>(ranks.size()),
                    of_rank = (strands + size - 1) / size;
  const double count = static_cast<double>(strands),
               frame =
                   count * 3 * static_cast<double>(elements + 1) * options.frame_bits / 8;
  // The first rank has a frame, and a number of six for each coordinate while a saved
  // state is read.
  const double first =
      frame + (options.resume ? count * 8.0 * 6 * static_cast<double>(elements) : 0);
  constexpr double scratch = 5e7;  // of threads, of this program
  // Roots and owners of all strands, energies of its own.
  const double each = static_cast<double>(head_bytes(outline, options.pack, of_rank)) +
                      static_cast<double>(of_rank * sizeof(models::HeadEnergy)) +
                      count * (sizeof(Vec) + sizeof(int)) + scratch,
               memory = each * ranks.on_this_machine() + first, free = free_memory(),
               frames = static_cast<double>(scene.last_frame() + 1);
  if (memory > free) {
    throw InputError(
        fmt::format("a batch of {} strands of {} elements needs about {:.2g} "
                    "GB of memory, {:.2g} GB are free",
                    strands, elements, memory / 1e9, free / 1e9),
        scene.name,
        without ? "give fewer strands or elements"
                : "give fewer strands or elements, or --precision 32");
  }
  std::error_code unknown;
  const auto disk =
      std::filesystem::space(std::filesystem::path(options.stem).parent_path(), unknown);
  if (!unknown && frame * frames > static_cast<double>(disk.available)) {
    throw InputError(
        fmt::format(
            "{:.0f} frames of {:.3g} MB may take {:.2g} GB of the disk, {:.2g} GB "
            "are free",
            frames, frame / 1e6, frame * frames / 1e9,
            static_cast<double>(disk.available) / 1e9),
        scene.name, "give fewer frames_per_s, --frames 32 or none, or another --out");
  }
  const std::string engine =
      without ? fmt::format(
                    "replicated systems, each as slow as a single strand: no SIMD "
                    "lanes for {}; for lanes, {}",
                    without->reason, without->remedy)
              : fmt::format("{} bits, {} SIMD lanes", bits_of(options.pack),
                            options.pack.lanes);
  tell(
      "simulate: {}: a batch of {} strand{} of {} element{}: about {:.0f} MB of memory, "
      "{:.0f} frames of {:.3g} MB before compression; {}\n",
      scene.name, strands, strands == 1 ? "" : "s", elements, elements == 1 ? "" : "s",
      memory / 1e6, frames, frame / 1e6, engine);
}

}  // namespace tress::experiments::scene_runs
