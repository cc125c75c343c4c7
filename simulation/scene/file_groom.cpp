#include "simulation/scene/file_groom.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <system_error>
#include <thread>

#include "contract/input_error.h"
#include "simulation/scene/groom.h"
#include "simulation/table/along.h"

namespace tress::simulation {
namespace {

// The fit of a strand is of third order in its elements.
constexpr int most_fitted_elements = 200;

constexpr Parameter file_keys[] = {
    {.name = "file",
     .help = "strands from a .hair, .data, .bin, .ply, .usda or .vtp instead of from "
             "numbers. Keys of the head, of shape and of length are left out. count "
             "selects a number of strands, evenly spread",
     .text = true},
    {.name = "unit",
     .help = "unit of length of the file; file: the one that it or its format defines "
             "(.usda: cm), else a guess, which is printed",
     .choices = "file|m|cm|mm|inch"},
    {.name = "unit_m",
     .help = "metres per unit of length; 0: by unit",
     .number = 0,
     .min = 0,
     .max = 1e6},
    {.name = "up",
     .help = "axis of the file that points up. `file` takes that of the file or "
             "of its format (.usda: y). Without one, the axis is guessed from "
             "hair that bends as it hangs, and printed",
     .choices = "file|x|y|z|-x|-y|-z"},
    {.name = "position_m",
     .help = "file: place of its origin x, y, z (m)",
     .min = -1e3,
     .max = 1e3,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "every",
     .help = "file: take every n-th strand",
     .number = 1,
     .min = 1,
     .max = 1e9,
     .whole = true},
    {.name = "bad_strands",
     .help = "file: treatment of strands with fewer than two points, repeated points, or "
             "points that are not finite. In a .usda also of strands with a number of "
             "points that does not suit their basis. drop: left out, and counted. Of "
             "repeated "
             "points only the second is left out",
     .choices = "refuse|drop"},
    {.name = "hidden_strands",
     .help =
         "file: curves of a .usda that USD does not render (inactive, invisible, of a "
         "class, of purpose guide or proxy); drop: left out, and counted",
     .choices = "drop|take"},
    {.name = "widths",
     .help = "file: radius of the strands, that of [material], or half the widths of a "
             ".hair or .usda, which vary along a strand",
     .choices = "material|file"},
    {.name = "strand_points",
     .help = "file: points of every strand of a .ply file without strand "
             "sizes; 0: given in the file",
     .number = 0,
     .min = 0,
     .max = 1e6,
     .whole = true},
    {.name = "mesh",
     .help = "file: placement of the elements: half by length and half by "
             "turning, or all equal, as SIMD lanes need",
     .choices = "turning|equal"},
    {.name = "fit",
     .help = "file: shape from which distances are measured: helices "
             "between joints, or straight edges between nodes for models "
             "of nodes",
     .choices = "helices|edges"},
};

/// The keys of a groom that also apply with a file.
constexpr std::string_view with_file[] = {"count",         "guides",
                                          "elements",      "initial",
                                          "radius_along",  "ellipticity_along",
                                          "modulus_along", "density_along"};

bool among(std::span<const Parameter> keys, std::string_view name) {
  return std::ranges::find(keys, name, &Parameter::name) != keys.end();
}

void refuse_with_file(const Table& groom) {
  for (const Parameter& p : groom.declared()) {
    if (!groom.given(p.name) || among(file_keys, p.name) ||
        among(detail_parameters(), p.name) || std::ranges::count(with_file, p.name) > 0) {
      continue;
    }
    throw InputError(
        fmt::format("{} cannot be combined with file, which has the strands", p.name),
        groom.place(p.name), "leave one of them out");
  }
  const Parameters& p = groom.values();
  if (p.number("unit_m") > 0 && p.word("unit") != "file") {
    throw InputError("unit_m cannot be combined with unit", groom.place("unit_m"),
                     "leave one of them out");
  }
  if (p.whole("elements") > most_fitted_elements) {
    throw InputError(fmt::format("{} elements to fit", p.whole("elements")),
                     groom.place("elements"),
                     fmt::format("give at most {}", most_fitted_elements));
  }
  const bool tolerance = detail_tolerance(groom) > 0 || p.number("fit_tolerance") > 0;
  if (tolerance) refuse_varied(groom, "a tolerance");
  if (tolerance && p.whole("guides") > 0) {
    throw InputError("all guide strands must have the same number of elements",
                     groom.place("guides"), "leave out guides, or the tolerance");
  }
}

std::optional<double> metres_per_unit(const Parameters& p) {
  if (p.number("unit_m") > 0) return p.number("unit_m");
  const auto unit = std::ranges::find(file_units, p.word("unit"), &FileUnit::name);
  if (unit == std::end(file_units)) return std::nullopt;
  return unit->metres;
}

std::optional<FileAxis> up_axis(std::string_view up) {
  if (up == "file") return std::nullopt;
  return FileAxis{up.back() - 'x', up.front() == '-'};
}

}  // namespace

std::span<const Parameter> file_groom_parameters() { return file_keys; }

std::shared_ptr<const PlacedGroom> read_file_groom(const Table& groom) {
  const Parameters& p = groom.values();
  const std::string file(p.word("file"));
  if (file.empty()) return nullptr;
  refuse_with_file(groom);
  if (std::error_code error; !std::filesystem::is_regular_file(file, error)) {
    throw InputError("there is no file " + file, groom.place("file"),
                     "name one relative to the scene's folder");
  }
  GroomPlacing placing;
  placing.metres = metres_per_unit(p);
  placing.up = up_axis(p.word("up"));
  placing.position = p.vec("position_m");
  placing.bad = p.word("bad_strands") == "drop" ? BadStrands::drop : BadStrands::refuse;
  placing.widths = p.word("widths") == "file";
  placing.every = static_cast<std::size_t>(p.whole("every"));
  GroomReading reading;
  reading.strand_points = p.whole("strand_points");
  reading.bad = placing.bad;
  reading.widths = placing.widths;
  reading.hidden = p.word("hidden_strands") == "take";
  return std::make_shared<const PlacedGroom>(
      place_groom(read_groom(file, reading), file, placing));
}

void refuse_file_keys(const Table& groom) {
  for (const Parameter& p : groom.declared()) {
    if (!among(file_keys, p.name) && p.name != "fit_tolerance") continue;
    if (groom.values().text(p.name) == p.default_text()) continue;
    throw InputError(fmt::format("{} has no effect without file", p.name),
                     groom.place(p.name), "leave it out, or name a file");
  }
}

std::size_t file_strands(const Table& groom, const PlacedGroom& file) {
  const std::size_t all = file.lines.size();
  if (!groom.given("count")) return all;
  const auto count = static_cast<std::size_t>(groom.values().whole("count"));
  if (count >= 1 && count <= all) return count;
  throw InputError(fmt::format("{} of the {} strands of the file", count, all),
                   groom.place("count"),
                   "give at most as many as there are, or leave it out");
}

std::shared_ptr<const FittedGroom> fit_file_groom(const Table& groom,
                                                  const PlacedGroom& file,
                                                  std::size_t count) {
  const Parameters& p = groom.values();
  GroomFit fit;
  fit.elements = p.whole("elements");
  fit.tolerance_m = detail_tolerance(groom);
  fit.tolerance_rel = p.number("fit_tolerance");
  fit.by_turning = p.word("mesh") == "turning";
  fit.between = p.word("fit") == "edges" ? Between::edges : Between::helices;
  constexpr unsigned most_threads = 16;
  const unsigned threads =
      std::clamp(std::thread::hardware_concurrency(), 1U, most_threads);
  return std::make_shared<const FittedGroom>(
      fit_groom(file, count, fit, static_cast<int>(threads)));
}

Strand file_strand(const Table& groom, const Table* own_material, const Common& common,
                   const FittedStrand& fitted) {
  const StrandMaterial material = strand_material(common.material, own_material);
  const bool straight = groom.values().word("initial") == "straight";
  const HelixChain& chain = fitted.chain;
  Strand strand;
  strand.material = material.material;
  for (int i = 0; i < fitted.elements(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    Segment segment;
    segment.parent = i - 1;
    segment.length = chain.joint[k + 1] - chain.joint[k];
    segment.section = material.section;
    segment.natural = chain.darboux[k];
    if (!straight) segment.initial = segment.natural;
    if (!fitted.radii.empty()) set_radius(strand, fitted.radii[k], segment);
    strand.segments.push_back(segment);
  }
  vary_along(groom, strand);
  set_root(strand, common.roots, chain.place, chain.root);
  models::check(strand);
  return strand;
}

}  // namespace tress::simulation
