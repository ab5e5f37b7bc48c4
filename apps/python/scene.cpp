// Scenes, points of joints, and what is known of their entries.
#include "scene_handle.hpp"

#include "base/text.hpp"
#include "base/units.hpp"
#include "base/value.hpp"
#include "base/xml.hpp"
#include "model/point.hpp"
#include "model/run.hpp"
#include "physics/material_library.hpp"

#include <fmt/ranges.h>

#include <filesystem>
#include <sstream>

namespace sprekk::python {

using Teuchos::Array;
using Teuchos::ParameterList;

namespace {

/// Whether it is an integer that an int can hold; larger ones are taken as doubles.
bool is_int(const py::handle& value) {
  return py::isinstance<py::int_>(value) && !py::isinstance<py::bool_>(value) && std::abs(value.cast<double>()) < 2e9;
}

/// A list of numbers, quantities ("1 mm") or words; numbers may stand among quantities.
void set_array(ParameterList& list, const std::string& name, const py::sequence& values) {
  bool integers = true, numbers = true;
  std::vector<std::string> texts;
  for (const auto& value : values) {
    integers = integers && is_int(value);
    numbers = numbers && (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value));
    texts.push_back(py::isinstance<py::str>(value) ? value.cast<std::string>()
                                                   : base::number_text(value.cast<double>()));
  }
  if (integers) {
    list.set(name, Array<int>(values.cast<std::vector<int>>()));
  } else if (numbers) {
    list.set(name, Array<double>(values.cast<std::vector<double>>()));
  } else {
    try {
      base::set_from_text(list, name, "Array(double)", fmt::format("{{{}}}", fmt::join(texts, ", ")));
    } catch (const Error&) {
      list.set(name, Array<std::string>(texts));
    }
  }
}

void fill(ParameterList& list, const py::dict& entries);

void set_entry(ParameterList& list, const std::string& name, const py::handle& value) {
  if (py::isinstance<py::dict>(value))
    fill(list.sublist(name), py::reinterpret_borrow<py::dict>(value));
  else if (py::isinstance<py::bool_>(value))
    list.set(name, value.cast<bool>());
  else if (is_int(value))
    list.set(name, value.cast<int>());
  else if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value))
    list.set(name, value.cast<double>());
  else if (py::isinstance<py::str>(value))
    list.set(name, value.cast<std::string>());
  else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
    set_array(list, name, py::reinterpret_borrow<py::sequence>(value));
  else
    throw py::type_error(fmt::format("\"{}\" is a {}, must be a number, a text, a list of these, or a dict", name,
                                     std::string(py::str(py::type::of(value).attr("__name__")))));
}

void fill(ParameterList& list, const py::dict& entries) {
  for (const auto& [name, value] : entries) set_entry(list, name.cast<std::string>(), value);
}

ParameterList list_of(const py::dict& entries) {
  ParameterList list("Sprekk");
  fill(list, entries);
  return list;
}

template <class T>
bool add_if_it_is(py::dict& entries, const std::string& name, const Teuchos::ParameterEntry& entry) {
  if (entry.isType<T>())
    entries[name.c_str()] = Teuchos::getValue<T>(entry);
  else if (entry.isType<Array<T>>())
    entries[name.c_str()] = Teuchos::getValue<Array<T>>(entry).toVector();
  return entries.contains(name.c_str());
}

py::dict dict_of(const ParameterList& list) {
  py::dict entries;
  for (const auto& named_entry : list) {
    const std::string& name = named_entry.first;
    const auto& entry = named_entry.second;
    if (entry.isList())
      entries[name.c_str()] = dict_of(list.sublist(name));
    else if (entry.isType<base::Quantity>())
      entries[name.c_str()] = base::quantity_text(Teuchos::getValue<base::Quantity>(entry));
    else if (entry.isType<Array<base::Quantity>>()) {
      py::list texts;
      for (const auto& quantity : Teuchos::getValue<Array<base::Quantity>>(entry))
        texts.append(base::quantity_text(quantity));
      entries[name.c_str()] = texts;
    } else if (!(add_if_it_is<int>(entries, name, entry) || add_if_it_is<long long>(entries, name, entry) ||
                 add_if_it_is<double>(entries, name, entry) || add_if_it_is<std::string>(entries, name, entry))) {
      if (entry.isType<bool>()) entries[name.c_str()] = Teuchos::getValue<bool>(entry);
    }
  }
  return entries;
}

py::dict described(const base::SectionSpecification& section) {
  py::list entries, sections;
  for (const auto& entry : section.entries) {
    py::dict one;
    one["name"] = entry.name;
    one["type"] = entry.type;
    one["unit"] = entry.unit;
    one["default"] = entry.value;
    one["meaning"] = entry.meaning;
    one["bounds"] = entry.bounds.text();
    one["length"] = entry.bounds.length_text();
    one["required"] = entry.required;
    one["choices"] = entry.choices;
    entries.append(one);
  }
  for (const auto& inner : section.sections) sections.append(described(inner));
  py::dict all;
  all["name"] = section.name;
  all["meaning"] = section.meaning;
  all["entries"] = entries;
  all["sections"] = sections;
  all["open"] = section.open;
  return all;
}

/// [state, component], those of a path by the names that `sprekk point` prints.
py::dict columns_of(const model::PointCurve& curve) {
  std::ostringstream csv;
  model::write_csv(csv, {curve});
  std::istringstream lines(csv.str());
  std::string line, title;
  std::getline(lines, line);
  std::vector<std::string> titles;
  for (std::istringstream words(line); std::getline(words, title, ',');) titles.push_back(title);
  std::vector<std::vector<double>> columns(titles.size());
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    for (auto& column : columns) {
      std::getline(words, title, ',');
      column.push_back(std::stod(title));
    }
  }
  py::dict all;
  for (std::size_t k = 0; k < titles.size(); ++k) all[titles[k].c_str()] = array_of(std::move(columns[k]));
  return all;
}

std::string folder_of(const std::string& path) { return std::filesystem::path(path).parent_path().string(); }

}  // namespace

SceneHandle::SceneHandle(ParameterList entries, std::string origin, std::string folder,
                         const std::vector<std::string>& overrides, const Comm& comm)
    : entries_(std::move(entries)),
      origin_(std::move(origin)),
      folder_(std::move(folder)),
      scene_(model::scene_of(comm, entries_, origin_, folder_, overrides)) {
  base::apply_overrides(entries_, origin_, overrides);
}

void bind_scene(py::module_& m) {
  using Overrides = std::vector<std::string>;
  py::class_<SceneHandle, std::shared_ptr<SceneHandle>>(m, "Scene")
      .def_static("from_file",
                  [](const std::string& path, const Overrides& overrides, const py::object& comm) {
                    const auto ranks = comm_of(comm);
                    auto list = base::read_xml(*ranks, path, "Sprekk", base::Defects::keep);
                    return std::make_shared<SceneHandle>(std::move(list), path, folder_of(path), overrides, *ranks);
                  })
      .def_static(
          "from_text",
          [](const std::string& text, const std::string& origin, const Overrides& overrides, const py::object& comm) {
            auto list = base::parse_xml(text, origin, "Sprekk", base::Defects::keep);
            return std::make_shared<SceneHandle>(std::move(list), origin, "", overrides, *comm_of(comm));
          })
      .def_static("from_entries",
                  [](const py::dict& entries, const std::string& origin, const std::string& folder,
                     const Overrides& overrides, const py::object& comm) {
                    return std::make_shared<SceneHandle>(list_of(entries), origin, folder, overrides, *comm_of(comm));
                  })
      .def("entries", [](const SceneHandle& self) { return dict_of(self.entries()); })
      .def("effective",
           [](const SceneHandle& self) {
             model::Scene copy = self.scene();
             return dict_of(base::effective(copy, "Sprekk"));
           })
      .def("xml", [](const SceneHandle& self) { return base::to_xml(self.entries()); })
      .def("effective_xml",
           [](const SceneHandle& self) {
             model::Scene copy = self.scene();
             return base::to_xml(base::effective(copy, "Sprekk"));
           })
      .def("times", [](const SceneHandle& self) { return self.scene().time.times(); })
      .def_property_readonly("origin", &SceneHandle::origin)
      .def_property_readonly("folder", &SceneHandle::folder);

  m.def("specification", [] { return described(base::specification<model::Scene>("Sprekk")); });
  m.def("point_specification", [] { return described(base::specification<model::PointScene>("Sprekk")); });
  m.def("drive", [](const py::dict& entries, const std::string& origin, const Overrides& overrides) {
    const auto scene = model::point_scene_of(list_of(entries), origin, overrides);
    std::vector<model::PointCurve> curves;
    {
      const py::gil_scoped_release free;
      curves = model::drive_points(scene);
    }
    py::list all;
    for (auto& curve : curves) {
      const auto specimen = std::exchange(curve.specimen, "");  // a column of texts
      all.append(py::make_tuple(specimen, columns_of(curve), curve.failure));
    }
    return all;
  });
  m.def("read_entries", [](const std::string& path, const py::object& comm) {
    return dict_of(base::read_xml(*comm_of(comm), path, "Sprekk", base::Defects::refuse));
  });
  m.def("materials", [] { return physics::library_markdown(); });
}

}  // namespace sprekk::python
