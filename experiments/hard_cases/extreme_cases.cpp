#include <cmath>
#include <numbers>

#include "experiments/hard_cases/gauges.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr std::string_view no_energy =
    "the energy rises by less than 1 % of what falling can turn into motion: nothing but "
    "gravity does work";

/// Falls from the horizontal, as most cases do.
HardCase falling(std::string_view name, std::string_view why, ModelSettings settings) {
  HardCase hard{.name = name,
                .why = why,
                .measure = "energy_gain_over_bound",
                .criterion = no_energy,
                .settings = {{"motion", "fixed"}, {"root_tangent", "x"}},
                .bounds = passive_bounds};
  hard.settings.insert(hard.settings.end(), settings.begin(), settings.end());
  return hard;
}

/// Twice the static sag of a clamped beam under its weight, w L^4/(8 EI): released
/// straight, it swings to it and back.
double swing_of_beam(const Situation& s) {
  const Segment& segment = s.strand.segments.front();
  const double bending = s.strand.material.youngs_modulus * segment.section.inertia1();
  const double weight = s.mass * s.parameters.number("gravity_m_s2") / s.length;
  return 2 * weight * std::pow(s.length, 4) / (8 * bending);
}

/// The last segment weighs a thousand times the others together: a bead of the same
/// density, with the required thickness.
void heavy_end(Strand& strand) {
  constexpr double ratio = 1000;
  Segment& bead = strand.segments.back();
  double others = 0;
  for (const Segment& segment : strand.segments) {
    if (&segment != &bead) others += segment.section.area() * segment.length;
  }
  const double radius = std::sqrt(ratio * others / (bead.length * std::numbers::pi));
  bead.section = {radius, radius};
}

/// The outer half is 1 mm thick.
void thick_end(Strand& strand) {
  for (std::size_t i = strand.segments.size() / 2; i < strand.segments.size(); ++i) {
    strand.segments[i].section = {1e-3, 1e-3};
  }
}

/// The middle one is a ten-thousandth of the others; the previous one takes up the rest.
void vanishing_segment(Strand& strand) {
  constexpr double ratio = 1e-4;
  const std::size_t middle = strand.segments.size() / 2;
  const double length = strand.segments[middle].length;
  strand.segments[middle].length = ratio * length;
  strand.segments[middle - 1].length += (1 - ratio) * length;
}

/// Height of the coil, the scale of its motion.
double coil_height(const Situation& s) {
  const Vec& n = s.strand.segments.front().natural;
  return s.length * std::abs(n.x) / norm(n);
}

}  // namespace

std::vector<HardCase> extreme_cases() {
  std::vector<HardCase> all;
  all.push_back(falling("straight",
                        "no curvature, no twist, and no inertia of the section: without "
                        "it the mass matrix of a helix has no twist left to move",
                        {{"rotary_inertia", "off"}}));

  HardCase fine =
      falling("nodes_200",
              "200 elements of 0.5 mm: the fastest bending wave has 5e5 rad/s,"
              " 5e4 times that of the motion that is looked for",
              {{"elements", "200"}});
  fine.t_end = fine.horizon = 0.1;
  fine.reference_step = 5e-4;
  fine.further_step = 1e-5;
  all.push_back(fine);

  HardCase soft = falling("softest",
                          "E = 1 MPa and 20 um: EI is 2e-5 of a hair's; it "
                          "falls like a chain and folds up",
                          {{"youngs_modulus_pa", "1e6"}, {"radius_m", "20e-6"}});
  soft.t_end = 0.2;
  soft.horizon = 0.1;
  all.push_back(soft);

  HardCase stiff = falling("stiffest",
                           "E = 10 GPa and 1 mm: EI is 6e10 of the softest; steps are "
                           "longer than the period of its slowest motion, 13 ms",
                           {{"youngs_modulus_pa", "1e10"}, {"radius_m", "1e-3"}});
  stiff.measure = "sag_over_bound";
  stiff.criterion =
      "the tip sags by at most 2.2 times the static sag: a straight beam that is "
      "released swings to twice that, and a tenth is for the elements";
  stiff.limit = 1.1;
  stiff.bounds = no_bounds;
  stiff.gauge = [](const Situation& s) { return sag_gauge(s, swing_of_beam(s)); };
  stiff.t_end = 0.2;
  stiff.horizon = 0.05;
  stiff.reference_step = 2.5e-5;
  stiff.error_scale = swing_of_beam;
  all.push_back(stiff);

  HardCase thick =
      falling("radius_jump",
              "20 um thin to the middle, then 1 mm: EI jumps by 6e6 from one "
              "element to the next, and the thin half holds 2500 times its "
              "own mass",
              {{"radius_m", "20e-6"}});
  thick.shape = thick_end;
  thick.horizon = 0.15;
  all.push_back(thick);

  HardCase bead = falling("heavy_tip",
                          "a bead of 1000 times its mass at the tip: the strand is its "
                          "string, stretched by 1000 times its own weight",
                          {});
  bead.shape = heavy_end;
  bead.horizon = 0.15;
  all.push_back(bead);

  HardCase coiled = falling("turns_6_per_element",
                            "a coil of 18 turns by three elements: the shape winds six "
                            "times within one",
                            {{"elements", "3"},
                             {"natural_curvature_per_m", "1100"},
                             {"natural_twist_per_m", "260"}});
  coiled.criterion =
      "the energy rises by less than 1 % of what falling can turn into motion; the error "
      "is that of the tip against a rod with 12 elements per segment, over the height of "
      "the coil";
  coiled.horizon = 0.1;
  coiled.rod_elements = 36;
  coiled.error_scale = coil_height;
  all.push_back(coiled);

  HardCase vanishing = falling("vanishing_element",
                               "one element is a ten-thousandth of the others: stiffness "
                               "goes with the third power of lengths",
                               {});
  vanishing.shape = vanishing_segment;
  all.push_back(vanishing);

  all.push_back(
      falling("one_element", "nothing is left of a curve", {{"elements", "1"}}));
  all.push_back(falling("two_elements", "a single joint", {{"elements", "2"}}));

  HardCase many = falling("elements_500",
                          "500 elements of 0.2 mm: sums of 500 small terms, and bending "
                          "waves of 3e6 rad/s",
                          {{"elements", "500"}});
  many.t_end = many.horizon = 0.1;
  many.reference_step = 1e-3;
  all.push_back(many);

  HardCase curl = falling("long_curl",
                          "2 m of curls that hang and sag: 33 turns, and one curvature "
                          "near the root swings two metres of them farther than they "
                          "fall in a step",
                          {{"elements", "100"},
                           {"length_m", "2"},
                           {"natural_curvature_per_m", "100"},
                           {"natural_twist_per_m", "30"},
                           {"root_tangent", "down"}});
  curl.t_end = 0.2;
  curl.horizon = 0.15;
  curl.reference_step = 1.25e-4;
  all.push_back(curl);
  return all;
}

}  // namespace tress::experiments::hard_cases
