// Rocks and joints with published values, available to scenes by name.
#pragma once

#include "physics/scene.hpp"

#include <map>
#include <string>

namespace sprekk::physics {

/// Materials of materials.xml, which is compiled into the library. Not collective.
std::map<std::string, Material> library_materials();

/// Adds the library material of each name in `names` that `materials` does not contain.
void add_library_materials(std::map<std::string, Material>& materials, const std::vector<std::string>& names);

/// Error message if `name` is not a material of the type ("elastic" or "joint") in `materials`; empty: it is.
std::string wrong_material(const std::string& name, const std::string& type,
                           const std::map<std::string, Material>& materials);

/// All materials with their values and sources, as Markdown.
std::string library_markdown();

}  // namespace sprekk::physics
