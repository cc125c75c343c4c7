#include "simulation/table/along.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "contract/input_error.h"
#include "math/piecewise_linear.h"

namespace tress::simulation {
namespace {

using models::CrossSection;
using models::Segment;
using models::Shape;
using models::Strand;

constexpr double most_factor = 1e3, largest_curvature = 1e6;

constexpr Parameter keys_along[] = {
    {.name = "radius_along",
     .help = "radius over that of the material: rows of [arc length over the strand's "
             "length, factor], linear between rows and constant beyond them. A taper is "
             "[[0, 1], [1, 0.5]]",
     .min = 0,
     .max = most_factor,
     .components = 2,
     .rows = true},
    {.name = "ellipticity_along",
     .help = "ellipticity over that of the material: rows as of radius_along",
     .min = 0,
     .max = most_factor,
     .components = 2,
     .rows = true},
    {.name = "modulus_along",
     .help = "Young's modulus and shear modulus over those of the material: rows as of "
             "radius_along",
     .min = 0,
     .max = most_factor,
     .components = 2,
     .rows = true},
    {.name = "density_along",
     .help = "density over that of the material: rows as of radius_along",
     .min = 0,
     .max = most_factor,
     .components = 2,
     .rows = true},
    {.name = "darboux_along",
     .help = "shape = \"along\": natural twist and curvatures about e1 and e2, rows of "
             "[arc length over the strand's length, twist, curvature, curvature] (1/m), "
             "interpolated as radius_along",
     .min = -largest_curvature,
     .max = largest_curvature,
     .components = 4,
     .rows = true,
     .fallback = "0,0,0,0"},
};
constexpr std::array factors{"radius_along", "ellipticity_along", "modulus_along",
                             "density_along"};

/// Values over the share of the length, linear between rows and constant beyond them.
template <std::size_t count>
class Along {
 public:
  using Values = std::array<double, count>;

  /// Throws InputError naming the key if its rows are not in order along the strand.
  Along(const Table& table, std::string_view key) {
    const auto all = table.values().numbers(key);
    for (std::size_t i = 0; i < all.size(); i += count + 1) {
      const double share = all[i];
      refuse_if(share < 0 || share > 1,
                fmt::format("{} has a row at {:g} of the length", key, share),
                table.place(key), "give shares from 0, the root, to 1, the tip");
      refuse_if(!rows_.empty() && share < rows_.back().first,
                fmt::format("the rows of {} are not in order along the strand", key),
                table.place(key), "sort them from the root to the tip");
      Values values;
      std::copy_n(&all[i + 1], count, values.begin());
      rows_.emplace_back(share, values);
    }
  }

  bool empty() const { return rows_.empty(); }
  Values at(double share) const {
    const auto [before, after, part] = between_rows(rows_, share, &Row::first);
    Values values;
    for (std::size_t k = 0; k < count; ++k) {
      values[k] = std::lerp(before->second[k], after->second[k], part);
    }
    return values;
  }

 private:
  using Row = std::pair<double, Values>;
  std::vector<Row> rows_;
};

/// Whether the radius is that of a groom's file.
bool takes_widths(const Table& table) {
  return table.values().knows("widths") && table.values().word("widths") == "file";
}

/// Changes section and moduli of a segment. Its internal friction changes as its mean
/// bending stiffness.
template <class Change>
void change(const Strand& strand, Segment& segment, Change apply) {
  const auto bending = [&] {
    const Vec all = stiffness(strand, segment);
    return all.y + all.z;
  };
  const double before = bending();
  apply();
  segment.factors.friction *= bending() / before;
}

}  // namespace

std::span<const Parameter> along_parameters() { return keys_along; }

std::string_view varied_key(const Table& table) {
  if (takes_widths(table)) return "widths";
  const auto given = std::ranges::find_if(
      factors, [&](const char* key) { return !table.values().numbers(key).empty(); });
  return given == factors.end() ? std::string_view() : *given;
}

bool varies_radius(const Table& table) {
  return takes_widths(table) || !table.values().numbers(factors.front()).empty();
}

void vary_along(const Table& table, Strand& strand) {
  if (varied_key(table).empty()) return;
  std::vector<Along<1>> along;
  for (const char* key : factors) along.emplace_back(table, key);
  const double length = strand.length();
  double from = 0;
  for (Segment& segment : strand.segments) {
    const double middle = (from + segment.length / 2) / length;
    from += segment.length;
    std::array<double, factors.size()> all{};
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = along[k].empty() ? 1 : along[k].at(middle)[0];
      refuse_if(!(all[k] > 0),
                fmt::format("{} is 0 in the middle of an element, at {:g} of the length",
                            factors[k], middle),
                table.place(factors[k]), "give factors above 0");
    }
    const auto [radius, ellipticity, modulus, density] = all;
    change(strand, segment,
           [&, radius = radius, modulus = modulus, density = density,
            stretch = std::sqrt(ellipticity)] {
             segment.section.a1 *= radius * stretch;
             segment.section.a2 *= radius / stretch;
             segment.factors.modulus = modulus;
             segment.factors.density = density;
           });
  }
}

void set_radius(const Strand& strand, double radius, Segment& segment) {
  CrossSection& section = segment.section;
  const double factor = radius / std::sqrt(section.a1 * section.a2);
  change(strand, segment, [&] {
    section.a1 *= factor;
    section.a2 *= factor;
  });
}

Shape shape_along(const Table& table, double length) {
  const Along<3> along(table, "darboux_along");
  refuse_if(along.empty(), "darboux_along has no rows", table.place("darboux_along"),
            "give rows of arc length, twist and two curvatures");
  return [along, length](double s) {
    const auto [twist, first, second] = along.at(s / length);
    return Vec{twist, first, second};
  };
}

}  // namespace tress::simulation
