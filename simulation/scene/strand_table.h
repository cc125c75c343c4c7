#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/strand/strand.h"
#include "simulation/scene/material_table.h"
#include "simulation/scene/root_table.h"

namespace tress::simulation {

/// Data common to all strands of a scene.
struct Common {
  const Table& material;  // the scene's [material]
  RootMotions roots;      // motions of the roots
  std::uint64_t seed;     // seed of all random numbers
};

/// The keys for discretisation, shape and initial state that [strand] and [groom] share.
std::vector<Parameter> cut_parameters();

/// [strand]: one strand with the position of its root.
std::span<const Parameter> strand_table_parameters();
/// Returns which keys of [strand] apply to which shape.
std::span<const Use> strand_uses();

/// Throws InputError with the location of an invalid key. `stream` distinguishes the
/// random shapes of one scene.
Strand scene_strand(const Table& table, const Table* own_material, const Common& common,
                    std::uint64_t stream);

/// A strand from cut_parameters(), this natural shape and, unless they say otherwise,
/// that initial one; empty: the natural one. `elements`: other than the table's.
Strand cut_strand(const Table& table, const StrandMaterial& material, double length,
                  const Shape& natural, const Shape& initial = {}, int elements = 0);

/// Returns the smallest number of equal elements, up to the table's, that represents
/// the shape at rest within `tolerance` (m); `jacobian`: at the root.
int needed_elements(const Table& table, const StrandMaterial& material, double length,
                    const Shape& natural, const Vec& tangent, double tolerance);

/// Refuses grading together with another key that sets the lengths of elements.
void refuse_grading(const Table& table, const std::string& other);

/// Refuses a section or material that varies along the strand together with `other`,
/// which expects a uniform strand.
void refuse_varied(const Table& table, const std::string& other);

}  // namespace tress::simulation
