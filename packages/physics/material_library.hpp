// Rock and joints with published values that scenes may name without defining them.
#pragma once

#include "physics/scene.hpp"

#include <map>
#include <string>

namespace sprekk::physics {

/// The sets of materials.xml, which is part of the library. Not collective.
std::map<std::string, Material> library_materials();

/// Adds the library's set to `materials` for each of `names` that is in the library and not in `materials`.
void add_library_materials(std::map<std::string, Material>& materials, const std::vector<std::string>& names);

/// What is wrong with `name` as a material of a type ("elastic" or "joint"); empty if `materials` has it.
std::string wrong_material(const std::string& name, const std::string& type,
                           const std::map<std::string, Material>& materials);

/// All sets with their values and sources, as Markdown.
std::string library_markdown();

}  // namespace sprekk::physics
