#include "physics/material_library.hpp"

#include "base/text.hpp"
#include "base/value.hpp"
#include "base/xml.hpp"

namespace sprekk::physics {

const char* materials_text();  // materials_text.cpp.in

namespace {

constexpr const char* file = "material library";

Teuchos::ParameterList library_list() { return base::parse_xml(materials_text(), file, "Sprekk"); }

/// Section "Materials" in the format of scenes.
struct Library {
  std::map<std::string, Material> materials;
  void describe(base::Section& s) { s.named_sections(materials, "Materials", ""); }
};

/// Entries without type and source, e.g. `Young's modulus 7.8e+10, density 2950`.
std::string values(const Teuchos::ParameterList& set) {
  std::string text;
  for (const auto& named_entry : set) {
    const std::string& name = named_entry.first;
    if (name == "type" || name == "source") continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, base::value_text(named_entry.second));
  }
  return text;
}

}  // namespace

std::map<std::string, Material> library_materials() {
  return base::read<Library>(library_list(), file, "Sprekk").materials;
}

void add_library_materials(std::map<std::string, Material>& materials, const std::vector<std::string>& names) {
  auto library = library_materials();
  for (const auto& name : names) materials.insert(library.extract(name));  // existing materials have priority
}

std::string wrong_material(const std::string& name, const std::string& type,
                           const std::map<std::string, Material>& materials) {
  const auto found = materials.find(name);
  if (found != materials.end() && found->second.type == type) return "";
  std::vector<std::string> own, shipped;
  for (const auto& [key, material] : materials)
    if (material.type == type) own.push_back(key);
  for (const auto& [key, material] : library_materials())
    if (material.type == type && !materials.count(key)) shipped.push_back(key);
  std::vector<std::string> all = own;
  all.insert(all.end(), shipped.begin(), shipped.end());
  return fmt::format("is \"{}\", must be the name of {} {} material{}, or of the library: {}{}", base::shortened(name),
                     type == "elastic" ? "an" : "a", type, own.empty() ? "" : ": " + base::quoted_list(own),
                     base::quoted_list(shipped), base::did_you_mean(name, all));
}

std::string library_markdown() {
  const auto library = library_list();
  const auto& sets = library.sublist("Materials");
  const auto table = [&](const std::string& title, const std::string& type) {
    std::string text = fmt::format("\n## {}\n\n| name | type | values | source |\n|---|---|---|---|\n", title);
    for (const auto& named_entry : sets) {
      const auto& set = sets.sublist(named_entry.first);
      if (set.get<std::string>("type") == type)
        text += fmt::format("| {} | {} | {} | {} |\n", named_entry.first, type, values(set),
                            set.get<std::string>("source"));
    }
    return text;
  };
  return "# Material library\n\nA scene may name these sets as `material` without defining them. Values in SI units, "
         "angles in degrees.\nEntries that a set does not list have their defaults.\n" +
         table("Rock", "elastic") + table("Joints", "joint");
}

}  // namespace sprekk::physics
