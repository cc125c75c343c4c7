#include "simulation/scene/groom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "simulation/groom/cap.h"
#include "simulation/groom/frames.h"
#include "simulation/groom/random.h"
#include "simulation/scene/file_groom.h"
#include "simulation/scene/shapes.h"
#include "simulation/table/along.h"
#include "simulation/table/directions.h"

namespace tress::simulation {
namespace {

constexpr double pi = std::numbers::pi;

constexpr Parameter own_parameters[] = {
    {.name = "count",
     .help = "number of strands, 0: by density_per_m2",
     .number = 100,
     .min = 0,
     .max = 1e6,
     .whole = true},
    {.name = "density_per_m2",
     .help = "count = 0: strands per area (1/m^2)",
     .number = 0,
     .min = 0,
     .max = 1e9},
    {.name = "guides",
     .help =
         "number of strands that are simulated, chosen among all; the others follow them "
         "in pictures; 0: every strand is simulated. A scene with guides has at most "
         "10000 strands in all",
     .number = 0,
     .min = 0,
     .max = 1e5,
     .whole = true},
    {.name = "centre_m",
     .help = "centre x, y, z of the head, an ellipsoid (m)",
     .min = -1e3,
     .max = 1e3,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "half_axes_m",
     .help = "half axes of the head along x, y, z; it faces x (m)",
     .min = 1e-6,
     .max = 1e3,
     .components = 3,
     .fallback = "0.1,0.08,0.12"},
    {.name = "cap_axis",
     .help = "direction of the middle of the hair; any length",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "-0.4,0,1"},
    {.name = "cap_angle_rad",
     .help = "angle from there to the hairline, on the unit sphere (rad)",
     .number = 1.3,
     .min = 1e-3,
     .max = pi},
    {.name = "tilt_rad",
     .help = "angle of the roots from the head's normal to the way they are combed (rad)",
     .number = 0.8,
     .min = -pi / 2,
     .max = pi / 2},
    {.name = "parting",
     .help = "combed sideways over down, away from the parting; 0: none",
     .number = 0,
     .min = 0,
     .max = 1e3},
    {.name = "parting_m",
     .help = "y of the parting, a plane across y, from the centre (m)",
     .number = 0,
     .min = -1e3,
     .max = 1e3},
    {.name = "length_variation",
     .help = "largest deviation of the length over its mean",
     .number = 0.1,
     .min = 0,
     .max = 0.99},
    {.name = "curl_variation",
     .help = "largest deviation of all natural curvatures over their means",
     .number = 0.1,
     .min = 0,
     .max = 10},
    {.name = "phase",
     .help = "direction in which a root's curvature bends: at random, or down",
     .choices = "random|down"},
};

constexpr Parameter detail_keys[] = {
    {.name = "fit_tolerance",
     .help = "file: largest distance of a strand from its points, over its length, which "
             "chooses its number of elements up to `elements`. 0: all get `elements`; "
             "tolerance_m is the same in m",
     .number = 0,
     .min = 0,
     .max = 1},
    {.name = "tolerance_m",
     .help = "level of detail: largest distance of a strand from its shape at rest (m). "
             "It chooses the number of elements, up to `elements`, by length, curl and "
             "weight. 0: all get `elements`",
     .number = 0,
     .min = 0,
     .max = 1e3},
    {.name = "tolerance_px",
     .help = "tolerance in pixels of the screen, for hair at its least "
             "distance from the camera",
     .number = 0,
     .min = 0,
     .max = 1e6},
    {.name = "pixels_per_m",
     .help = "pixels per metre for tolerance_px: focal length in pixels "
             "over distance in m",
     .number = 0,
     .min = 0,
     .max = 1e9},
};

std::size_t count(const Table& table, const Cap& cap, std::size_t most) {
  const Parameters& p = table.values();
  double wanted = p.number("count");
  std::string_view key = "count";
  if (wanted == 0) {
    wanted = std::floor(p.number("density_per_m2") * cap.area());
    key = "density_per_m2";
  } else if (p.number("density_per_m2") > 0) {
    throw InputError("density_per_m2 cannot be combined with a count",
                     table.place("density_per_m2"), "leave it out, or give count = 0");
  }
  if (wanted >= 1 && wanted <= static_cast<double>(most)) {
    return static_cast<std::size_t>(wanted);
  }
  throw InputError(fmt::format("{:.0f} strands", wanted), table.place(key),
                   most > 0 ? fmt::format("give a count, or a density, for 1 to {}, what "
                                          "the scene has room for",
                                          most)
                            : "the scene has no room for more: give fewer elements");
}

/// The combing direction of a root, along the surface; 0 if it is undefined.
Vec combed(const Parameters& p, const Cap::Place& place) {
  const double side = place.x.y - p.vec("centre_m").y - p.number("parting_m");
  const double sideways = side == 0 ? 0 : std::copysign(p.number("parting"), side);
  return across(place.normal, {0, sideways, -1});
}

Frame root_frame(const Parameters& p, const Cap::Place& place, double phase) {
  const Vec comb = combed(p, place);
  const double tilt = dot(comb, comb) > 0 ? p.number("tilt_rad") : 0;
  const Vec tangent = across({}, std::cos(tilt) * place.normal + std::sin(tilt) * comb);
  // Positive curvature about e1 bends towards e1 x e0, which is down for e1 = e0 x down.
  Vec e1 = across(tangent, cross(tangent, {0, 0, -1}));
  if (dot(e1, e1) == 0) e1 = across(tangent, {0, 1, 0});
  return frame_of(tangent, rotation(tangent, phase) * e1);
}

/// The tolerance, of a groom that can have one.
double detail(const Table& table) {
  const double tolerance = detail_tolerance(table);
  if (tolerance == 0) return 0;
  if (table.values().whole("guides") > 0) {
    throw InputError("all guide strands must have the same number of elements",
                     table.place("guides"), "leave out guides, or the tolerance");
  }
  refuse_grading(table, "a tolerance");
  refuse_varied(table, "a tolerance");
  return tolerance;
}

double varied(Random& random, double variation) {
  return 1 + variation * (2 * random.uniform() - 1);
}

}  // namespace

std::span<const Parameter> groom_table_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list(std::begin(own_parameters), std::end(own_parameters));
    for (const Parameter& p : file_groom_parameters()) list.push_back(p);
    for (const Parameter& p : detail_parameters()) list.push_back(p);
    for (const Parameter& p : cut_parameters()) list.push_back(p);
    return list;
  }();
  return all;
}

std::span<const Parameter> detail_parameters() { return detail_keys; }

double detail_tolerance(const Table& groom) {
  const Parameters& p = groom.values();
  const double metres = p.number("tolerance_m"), pixels = p.number("tolerance_px"),
               size = p.number("pixels_per_m");
  const auto refuse_if = [&groom](bool bad, const char* problem) {
    if (!bad) return;
    throw InputError(problem, groom.place("tolerance_px"),
                     "give tolerance_m, or tolerance_px and pixels_per_m");
  };
  refuse_if(metres > 0 && pixels > 0, "tolerance_px cannot be combined with tolerance_m");
  refuse_if(pixels > 0 && size == 0, "tolerance_px without pixels_per_m");
  refuse_if(pixels == 0 && size > 0, "pixels_per_m without tolerance_px");
  return pixels > 0 ? pixels / size : metres;
}

Groom::Groom(const Table& table, const Table* own_material, const Common& common,
             std::size_t most)
    : table_(table),
      common_(common),
      material_((table.refuse_unused("shape", shape_uses()), refuse_file_keys(table),
                 strand_material(common.material, own_material))),
      cap_(table.values().vec("centre_m"), table.values().vec("half_axes_m"),
           direction(table, "cap_axis"), table.values().number("cap_angle_rad")),
      count_(simulation::count(table, cap_, most)),
      tolerance_(detail(table)) {}

int Groom::elements(double length, const Shape& natural, const Frame& root) const {
  if (tolerance_ == 0) return table_.values().whole("elements");
  return needed_elements(table_, material_, length, natural, root.e0, tolerance_);
}

Strand Groom::strand(std::size_t i, std::uint64_t stream) const {
  const Parameters& p = table_.values();
  Random random(common_.seed, 2 * stream + 1);  // shapes use the even ones
  const double length =
      p.number("length_m") * varied(random, p.number("length_variation"));
  const double curl = varied(random, p.number("curl_variation"));
  const double phase = p.word("phase") == "random" ? 2 * pi * random.uniform() : 0;
  const Shape mean = natural_shape(table_, material_, length, common_.seed, 2 * stream);
  const double share = static_cast<double>(i);
  const double turns = share * (std::numbers::phi - 1);
  const Cap::Place place =
      cap_.place((share + 0.5) / static_cast<double>(count_), turns - std::floor(turns));
  const Frame root = root_frame(p, place, phase);
  const Shape natural = [&](double s) { return curl * mean(s); };
  Strand strand =
      cut_strand(table_, material_, length, natural, {}, elements(length, natural, root));
  vary_along(table_, strand);
  set_root(strand, common_.roots, place.x, root);
  return strand;
}

}  // namespace tress::simulation
