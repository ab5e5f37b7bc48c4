#include "model/change.hpp"

#include "base/xml.hpp"

#include <algorithm>
#include <set>

namespace sprekk::model {

namespace {

Teuchos::ParameterList without_free_sections(Scene scene) {  // copy, because describe() could change it
  auto list = base::effective(scene, "Sprekk");
  for (const char* name : {"Output", "Probes", "Stages"}) list.remove(name, false);
  return list;
}

/// Text of an entry; empty for absent entries and for arrays without elements.
std::string text_of(const Teuchos::ParameterList& list, const std::string& name) {
  if (list.isSublist(name)) return base::to_xml(list.sublist(name));
  const auto text = list.isParameter(name) ? base::value_text(list.getEntry(name)) : "";
  return text == "{}" ? "" : text;
}

std::set<std::string> names_in(const Teuchos::ParameterList& a, const Teuchos::ParameterList& b) {
  std::set<std::string> names;
  for (const auto* list : {&a, &b})
    for (const auto& named_entry : *list) names.insert(named_entry.first);
  return names;
}

/// Calls use(path, name, before, after) for all differing entries and sections with fixed names.
template <class Use>
void for_fixed(const Teuchos::ParameterList& before, const Teuchos::ParameterList& after,
               const std::set<std::string>& fixed, const std::string& path, const Use& use) {
  const Teuchos::ParameterList none;
  const auto inside = [&](const auto& list, const std::string& name) -> const Teuchos::ParameterList& {
    return list.isSublist(name) ? list.sublist(name) : none;
  };
  for (const auto& name : names_in(before, after)) {
    if (fixed.count(name)) {
      if (text_of(before, name) != text_of(after, name)) use(path, name, before, after);
    } else if (before.isSublist(name) || after.isSublist(name)) {
      for_fixed(inside(before, name), inside(after, name), fixed, path + (path.empty() ? "" : " > ") + name, use);
    }
  }
}

std::set<std::string> fixed_entries() {
  std::set<std::string> names;
  physics::for_each_physics([&](auto physics) {
    for (const auto& name : physics.fixed_entries()) names.insert(name);
  });
  return names;
}

/// Text such as "is 2e10, was 1e10".
std::string difference(const Teuchos::ParameterList& before, const Teuchos::ParameterList& after,
                       const std::string& name) {
  const auto text = [&](const auto& list) {
    if (!list.isParameter(name)) return std::string("absent");
    return list.isSublist(name) ? std::string("another section") : base::value_text(list.getEntry(name));
  };
  return fmt::format("is {}, was {}", text(after), text(before));
}

/// Compares the rock of regions. The material may be another one if the entries of both agree. A refilled region may
/// have any material.
void compare_rock(const Scene& before, const Scene& after, const std::set<std::string>& fixed,
                  std::vector<std::string>& lines) {
  std::set<std::string> regions = {"bulk"};
  for (const auto* scene : {&before, &after})
    for (const auto& region : scene->regions) regions.insert(region.first);
  for (const auto& region : before.excavated()) regions.erase(region);
  for (const auto& region : regions) {
    auto old = before.material_of(region), now = after.material_of(region);
    for_fixed(base::effective(old, ""), base::effective(now, ""), fixed, "",
              [&](const auto&, const std::string& name, const auto& a, const auto& b) {
                lines.push_back(fmt::format("the rock of \"{}\": \"{}\": {}", region, name, difference(a, b, name)));
              });
  }
}

template <class Place>
void compare_places(const std::string& what, const std::map<std::string, Place>& before,
                    const std::map<std::string, Place>& after, std::vector<std::string>& lines) {
  for (const auto& [name, place] : after)
    if (const auto old = before.find(name); old != before.end() && !(old->second == place))
      lines.push_back(fmt::format("the {} \"{}\": number of values per {}: {}; before: {} per {}", what, name,
                                  fields::name_of(place.entity), place.n_components, old->second.n_components,
                                  fields::name_of(old->second.entity)));
}

/// Copies the values of a field, [owned entity, component], from one part of a mesh to another. Entities only in the
/// target retain their values.
void carry(const fields::Field& field, const mesh::Mesh& whole, const mesh::Mesh& from, const View<Real**>& values,
           const mesh::Mesh& to, const View<Real**>& carried) {
  const int n = field.n_components;
  fields::Vector old(fields::whole_map(field, from)), now(fields::whole_map(field, to)),
      all(fields::owned_map(field, whole));
  Kokkos::deep_copy(fields::by_entity(old, n), values);
  Kokkos::deep_copy(fields::by_entity(now, n), carried);
  for (const auto* part : {&now, &old})
    all.doExport(*part, fields::Export(part->getMap(), all.getMap()), Tpetra::REPLACE);
  now.doImport(all, fields::Import(all.getMap(), now.getMap()), Tpetra::REPLACE);
  Kokkos::deep_copy(carried, fields::by_entity(now, n));
}

}  // namespace

bool same_entries(const Scene& before, const Scene& after) {
  return base::to_xml(without_free_sections(before)) == base::to_xml(without_free_sections(after));
}

std::vector<std::string> refused_changes(const Scene& before, const Scene& after) {
  std::vector<std::string> lines;
  auto old = without_free_sections(before), now = without_free_sections(after);
  for (const char* name : {"Mesh", "Mesh file"})
    if (text_of(old, name) != text_of(now, name))
      lines.push_back(fmt::format("{}: the mesh is another one; only regions of it may be taken away", name));
  const auto fixed = fixed_entries();
  for (auto* list : {&old, &now})
    for (const char* compared : {"Mesh", "Mesh file", "Materials"}) list->remove(compared, false);
  for_fixed(old, now, fixed, "", [&](const auto& path, const std::string& name, const auto& a, const auto& b) {
    lines.push_back(fmt::format("{} > \"{}\": {}", path, name, difference(a, b, name)));
  });
  compare_rock(before, after, fixed, lines);
  physics::for_each_physics([&]<physics::HasChange P>(P) {
    for (const auto& line : P::Change::refuses(before, after)) lines.push_back(line);
  });
  return lines;
}

Storage storage_of(const std::vector<std::unique_ptr<assembly::Module>>& modules, const mesh::Mesh& mesh) {
  Storage storage;
  std::set<std::string> names;
  for (const auto& module : modules)
    for (const auto& unknown : module->declare(mesh).unknowns) names.insert(unknown.field.name);
  for (const auto& module : modules) {
    module->set_fields(names);
    const auto declared = module->declare(mesh);
    for (const auto& [field, scale, row, null_space, group, enriches, into, balance, unbounded, augmented, reactions] :
         declared.unknowns)
      storage.fields[field.name] = {field.entity, field.n_components};
    for (const auto& [name, entity, n, is_amount, is_transferred] : declared.history)
      storage.histories[module->name() + ": " + name] = {entity, n};
  }
  return storage;
}

std::vector<std::string> misfits(const Storage& before, const Storage& after) {
  std::vector<std::string> lines;
  for (const auto& [name, place] : after.fields)
    if (!before.fields.count(name))
      lines.push_back(fmt::format("there would be the unknown \"{}\", which was not", name));
  for (const auto& [name, place] : before.fields)
    if (!after.fields.count(name) && place.entity != fields::Entity::enriched_node)
      lines.push_back(fmt::format("the unknown \"{}\" would be no more", name));
  compare_places("field", before.fields, after.fields, lines);
  compare_places("history", before.histories, after.histories, lines);
  return lines;
}

void carry_over(const mesh::Mesh& whole, assembly::System& from, const fields::BlockVector& x, assembly::System& to,
                fields::BlockVector& carried) {
  const auto &old_mesh = from.mesh(), &mesh = to.mesh();
  for (std::size_t b = 0; b < carried.size(); ++b)
    for (std::size_t o = 0; o < x.size(); ++o)
      if (const auto& field = to.layouts()[b].field(); from.layouts()[o].field().name == field.name)
        carry(field, whole, old_mesh, fields::by_entity(*x[o], field.n_components), mesh,
              fields::by_entity(*carried[b], field.n_components));
  auto saved = from.histories();
  for (auto& passed : from.passed_on(x)) saved.push_back(std::move(passed));
  for (const auto& [field, values] : to.histories())
    for (const auto& [old, old_values] : saved)
      if (old.name == field.name) carry(field, whole, old_mesh, old_values, mesh, values);
  to.take_over(carried);
  const auto before = from.memory();
  auto memory = to.memory();
  memory.t = before.t;
  for (auto& [name, scale] : memory.scales)
    if (const auto old = before.scales.find(name); old != before.scales.end()) scale = std::max(scale, old->second);
  if (memory.errors.size() == before.errors.size()) memory.errors = before.errors;
  memory.energy = before.energy;
  to.resume(carried, memory);
}

}  // namespace sprekk::model
