#include "simulation/scene/strand_table.h"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string>

#include "contract/input_error.h"
#include "models/cut/graded_cut.h"
#include "models/strand/needed_elements.h"
#include "simulation/groom/frames.h"
#include "simulation/scene/shapes.h"
#include "simulation/scene/shared_parameter.h"
#include "simulation/table/along.h"
#include "simulation/table/directions.h"

namespace tress::simulation {
namespace {

constexpr double most = 1e6;
// Models integrate an element with a number of points that grows with its total angle.
constexpr double most_turns = 20, turn = 2 * std::numbers::pi;

constexpr Parameter own_parameters[] = {
    {.name = "position_m",
     .help = "position x, y, z of the root (m)",
     .min = -most,
     .max = most,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "root_tangent",
     .help = "direction at the root, away from it; any length",
     .min = -most,
     .max = most,
     .components = 3,
     .fallback = "1,0,0"},
    {.name = "normal",
     .help =
         "direction of the section's axis e1 at the root; its component across the "
         "tangent counts. Positive curvature about it bends towards -(tangent x normal)",
     .min = -most,
     .max = most,
     .components = 3,
     .fallback = "0,1,0"},
    {.name = "points",
     .help = "rows of x, y, z (m): the natural shape as a smooth curve through at least "
             "three points. They replace length_m, position_m, root_tangent and shape",
     .min = -1e3,
     .max = 1e3,
     .components = 3,
     .rows = true},
    {.name = "natural",
     .help =
         "points: they are the shape at rest; straight: a straight strand is bent into "
         "them at t = 0, as in a knot",
     .choices = "points|straight"},
    {.name = "mesh",
     .help = "placement of the elements: by grading, or with equal shares of "
             "the curvature at rest, clamped and under its weight. "
             "`rest_linear` is for curvature that is linear in an element "
             "(super_clothoid)",
     .choices = "grading|rest|rest_linear"},
    {.name = "tolerance_m",
     .help = "largest distance (m) from the shape at rest, which chooses the number of "
             "elements, up to `elements`. `simulate` tries the motion and adds elements "
             "where it needs them. 0: `elements`",
     .number = 0,
     .min = 0,
     .max = 1e3},
    {.name = "name", .help = "name of the strand in [joints]", .text = true},
    {.name = "root",
     .help =
         "motion of the root. common: as [root] prescribes; free: held by supports and "
         "joints alone. It begins with the velocity of a root that moves as [root] "
         "prescribes",
     .choices = "common|free"},
};

void refuse_beside_points(const Table& table) {
  for (const char* key :
       {"length_m", "position_m", "root_tangent", "shape", "mesh", "tolerance_m"}) {
    if (!table.given(key)) continue;
    throw InputError(std::string(key) + " cannot be combined with points",
                     table.place(key), "leave one of them out");
  }
}

/// e1, across the tangent.
Vec normal(const Table& table, const Vec& tangent) {
  const Vec e1 = across(tangent, direction(table, "normal"));
  if (dot(e1, e1) > 0) return e1;
  throw InputError("normal is along the tangent", table.place("normal"),
                   "give a normal in another direction");
}

/// What the table says, or `otherwise`.
Shape initial_shape(const Table& table, const Shape& otherwise) {
  return table.values().word("initial") == "straight" ? uniform_shape({}) : otherwise;
}

void check_winding(const Strand& strand, const Table& table) {
  for (const Segment& segment : strand.segments) {
    const Vec& darboux = segment.natural;
    const double turns = norm(darboux) * segment.length / turn;
    if (turns <= most_turns) continue;
    throw InputError("an element winds by " + std::to_string(turns) + " turns",
                     table.place(),
                     "give more elements, a shorter strand or less curvature: at most "
                     "20 turns each");
  }
}

/// A strand whose elements share what bends it at rest: `elements`, or as few as are
/// within the tolerance there.
Strand cut_at_rest(const Table& table, const LoadedRod& rod) {
  const Parameters& p = table.values();
  const double tolerance = p.number("tolerance_m");
  const int most = p.whole("elements");
  const bool linear = p.word("mesh") == "rest_linear";
  refuse_if(linear && tolerance > 0,
            "a tolerance cannot be combined with mesh = \"rest_linear\"",
            table.place("tolerance_m"), "give elements, or mesh = \"rest\"");
  try {
    if (linear) {
      Strand strand = cut_into(rod, linear_cut(rod, most), initial_shape(table, {}));
      check_winding(strand, table);
      return strand;
    }
    int elements = tolerance > 0 ? std::min(2, most) : most;
    GradedCut cut = graded_cut(rod, elements);
    while (elements < most && cut.error > tolerance) {
      elements = std::min(most, elements + std::max(1, elements / 4));
      cut = graded_cut(rod, elements);
    }
    Strand strand = cut_into(rod, cut.lengths, initial_shape(table, {}));
    check_winding(strand, table);
    return strand;
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& failure) {
    throw InputError(failure.what(), table.place("mesh"), "use mesh = \"grading\"");
  }
}

/// From its root, which `frame` clamps.
Strand cut_shape(const Table& table, const StrandMaterial& material, const Shape& natural,
                 const Frame& frame, bool clamped) {
  const Parameters& p = table.values();
  const double length = p.number("length_m"), tolerance = p.number("tolerance_m");
  if (p.word("mesh") != "grading") {
    refuse_if(!clamped, "a strand that nothing holds has no shape at rest",
              table.place("mesh"), "leave out one of them");
    const std::string mesh = "mesh = \"" + std::string(p.word("mesh")) + "\"";
    refuse_grading(table, mesh);
    refuse_varied(table, mesh);
    return cut_at_rest(table, {material.material,
                               material.section,
                               length,
                               natural,
                               frame,
                               {0, 0, -material.weight()}});
  }
  if (tolerance == 0) return cut_strand(table, material, length, natural);
  refuse_grading(table, "a tolerance");
  refuse_varied(table, "a tolerance");
  return cut_strand(
      table, material, length, natural, {},
      needed_elements(table, material, length, natural, frame.e0, tolerance));
}

/// Those of all strands, unless the root of this one is free.
RootMotions roots_of(const Table& table, const Common& common) {
  static const std::optional<FreeRoot> at_rest{FreeRoot{}};
  if (table.values().word("root") == "common" || common.roots.free_root) {
    return common.roots;
  }
  return {common.roots.head, at_rest, common.roots.skin, true};
}

}  // namespace

std::vector<Parameter> cut_parameters() {
  std::vector<Parameter> all{shared_parameter("length_m"), shared_parameter("elements"),
                             shared_parameter("grading")};
  all.insert(all.end(), shape_parameters().begin(), shape_parameters().end());
  all.insert(all.end(), along_parameters().begin(), along_parameters().end());
  all.push_back(
      {.name = "initial", .help = "shape at t = 0", .choices = "natural|straight"});
  return all;
}

std::span<const Parameter> strand_table_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list(std::begin(own_parameters), std::end(own_parameters));
    for (const Parameter& p : cut_parameters()) list.push_back(p);
    return list;
  }();
  return all;
}

std::span<const Use> strand_uses() { return shape_uses(); }

Strand cut_strand(const Table& table, const StrandMaterial& material, double length,
                  const Shape& natural, const Shape& initial, int elements) {
  const Parameters& p = table.values();
  const Discretisation cut{elements > 0 ? elements : p.whole("elements"), length,
                           p.number("grading")};
  Strand strand = make_strand(material.material, material.section, cut, natural,
                              initial_shape(table, initial));
  check_winding(strand, table);
  return strand;
}

Strand scene_strand(const Table& table, const Table* own_material, const Common& common,
                    std::uint64_t stream) {
  const Parameters& p = table.values();
  table.refuse_unused("shape", shape_uses());
  const RootMotions roots = roots_of(table, common);
  const StrandMaterial material = strand_material(common.material, own_material);
  if (!p.numbers("points").empty()) {
    refuse_beside_points(table);
    const PointCurve curve =
        through_points(p.numbers("points"), p.whole("elements"), p.number("grading"),
                       direction(table, "normal"), table.place("points"));
    const bool tied = p.word("natural") == "straight";
    if (tied && p.word("initial") == "straight") {
      throw InputError(
          "natural = \"straight\" and initial = \"straight\" contradict points",
          table.place("natural"), "leave one of them out");
    }
    Strand strand =
        cut_strand(table, material, curve.length, tied ? uniform_shape({}) : curve.shape,
                   tied ? curve.shape : Shape{});
    vary_along(table, strand);
    set_root(strand, roots, curve.position, curve.frame);
    return strand;
  }
  if (p.word("natural") == "straight") {
    throw InputError("natural = \"straight\" without points", table.place("natural"),
                     "give points, or leave it out");
  }
  const Vec tangent = direction(table, "root_tangent");
  const Frame frame = frame_of(tangent, normal(table, tangent));
  Strand strand =
      cut_shape(table, material,
                natural_shape(table, material, p.number("length_m"), common.seed, stream),
                frame, !roots.free_root);
  vary_along(table, strand);
  set_root(strand, roots, p.vec("position_m"), frame);
  return strand;
}

int needed_elements(const Table& table, const StrandMaterial& material, double length,
                    const Shape& natural, const Vec& tangent, double tolerance) {
  const Vec stiff = models::stiffness(material.material, material.section);
  return models::elements_for(
      {length, material.weight(), std::min(stiff.y, stiff.z), tangent, natural},
      tolerance, table.values().whole("elements"));
}

void refuse_grading(const Table& table, const std::string& other) {
  refuse_if(table.values().number("grading") != 1,
            "grading cannot be combined with " + other, table.place("grading"),
            "leave out one of them");
}

void refuse_varied(const Table& table, const std::string& other) {
  const std::string_view key = varied_key(table);
  refuse_if(!key.empty(), std::string(key) + " cannot be combined with " + other,
            key.empty() ? table.place() : table.place(key), "leave out one of them");
}

}  // namespace tress::simulation
