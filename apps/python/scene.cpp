// Scenes, points of joints, and specifications of entries.
#include "ranks.hpp"
#include "scene_handle.hpp"

#include "base/text.hpp"
#include "base/units.hpp"
#include "base/value.hpp"
#include "base/xml.hpp"
#include "laboratory/point.hpp"
#include "model/run.hpp"
#include "physics/material_library.hpp"

#include <fmt/ranges.h>

#include <filesystem>
#include <sstream>

namespace sprekk::python {

using Teuchos::Array;
using Teuchos::ParameterList;

namespace {

std::string type_of(const py::handle& value) { return py::str(py::type::of(value).attr("__name__")); }

bool is_number(const py::handle& value) { return py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value); }

double number_of(const std::string& name, const py::handle& value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (!PyErr_Occurred()) return number;
  PyErr_Clear();
  throw Error(fmt::format("\"{}\" is an integer that no number holds, must be below 1.8e308 in size", name));
}

/// Returns whether the value is an integer that fits an int; larger integers are read as doubles.
bool is_int(const std::string& name, const py::handle& value) {
  return py::isinstance<py::int_>(value) && !py::isinstance<py::bool_>(value) && std::abs(number_of(name, value)) < 2e9;
}

/// Sets a list of numbers, quantities ("1 mm") or texts. Numbers may be mixed with quantities. Throws a type_error for
/// other types.
void set_array(ParameterList& list, const std::string& name, const py::sequence& values) {
  bool integers = true, numbers = true;
  std::vector<std::string> texts;
  for (const auto& value : values) {
    if (!is_number(value) && !py::isinstance<py::str>(value))
      throw py::type_error(
          fmt::format("\"{}\" has a {} in its list, must have numbers or texts there", name, type_of(value)));
    integers = integers && is_int(name, value);
    numbers = numbers && is_number(value);
    texts.push_back(py::isinstance<py::str>(value) ? value.cast<std::string>()
                                                   : base::number_text(number_of(name, value)));
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
  else if (is_int(name, value))
    list.set(name, value.cast<int>());
  else if (is_number(value))
    list.set(name, number_of(name, value));
  else if (py::isinstance<py::str>(value))
    list.set(name, value.cast<std::string>());
  else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
    set_array(list, name, py::reinterpret_borrow<py::sequence>(value));
  else
    throw py::type_error(
        fmt::format("\"{}\" is a {}, must be a number, a text, a list of these, or a dict", name, type_of(value)));
}

void fill(ParameterList& list, const py::dict& entries) {
  for (const auto& [name, value] : entries) {
    if (!py::isinstance<py::str>(name))
      throw py::type_error(fmt::format("{} is the name of an entry and a {}, must be a text",
                                       std::string(py::repr(name)), type_of(name)));
    set_entry(list, name.cast<std::string>(), value);
  }
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

/// Returns the columns of a curve, [state], with the titles printed by `sprekk point`.
py::dict columns_of(const laboratory::PointCurve& curve) {
  std::ostringstream csv;
  laboratory::write_csv(csv, {curve});
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

/// Returns the scene of entries. Throws an Error if they differ between ranks. Collective.
model::Scene scene_of_all(const Comm& comm, const ParameterList& entries, const std::string& origin,
                          const std::string& folder, const std::vector<std::string>& overrides) {
  check_same(comm, origin, fmt::format("{}{}", base::to_xml(entries), fmt::join(overrides, "\n")));
  return model::scene_of(comm, entries, origin, folder, overrides);
}

std::string folder_of(const std::string& path) { return std::filesystem::path(path).parent_path().string(); }

}  // namespace

SceneHandle::SceneHandle(ParameterList entries, std::string origin, std::string folder,
                         const std::vector<std::string>& overrides, const Comm& comm)
    : entries_(std::move(entries)),
      origin_(std::move(origin)),
      folder_(std::move(folder)),
      scene_(scene_of_all(comm, entries_, origin_, folder_, overrides)) {
  base::apply_overrides(entries_, origin_, overrides);
}

void bind_scene(py::module_& m) {
  using Overrides = std::vector<std::string>;
  const py::call_guard<Alone> one_at_a_time;
  py::class_<SceneHandle, std::shared_ptr<SceneHandle>>(m, "Scene")
      .def_static(
          "from_file",
          [](const std::string& path, const Overrides& overrides, const py::object& comm) {
            const auto ranks = comm_of(comm);
            auto list = base::read_xml(*ranks, path, "Sprekk", base::Defects::keep);
            return std::make_shared<SceneHandle>(std::move(list), path, folder_of(path), overrides, *ranks);
          },
          one_at_a_time)
      .def_static(
          "from_text",
          [](const std::string& text, const std::string& origin, const Overrides& overrides, const py::object& comm) {
            const auto ranks = comm_of(comm);
            check_same(*ranks, origin, text);
            auto list = base::parse_xml(text, origin, "Sprekk", base::Defects::keep);
            return std::make_shared<SceneHandle>(std::move(list), origin, "", overrides, *ranks);
          },
          one_at_a_time)
      .def_static(
          "from_entries",
          [](const py::dict& entries, const std::string& origin, const std::string& folder, const Overrides& overrides,
             const py::object& comm) {
            const auto ranks = comm_of(comm);
            ParameterList list;
            from_python(*ranks, [&] { list = list_of(entries); });
            return std::make_shared<SceneHandle>(std::move(list), origin, folder, overrides, *ranks);
          },
          one_at_a_time)
      .def(
          "entries", [](const SceneHandle& self) { return dict_of(self.entries()); }, one_at_a_time)
      .def(
          "effective",
          [](const SceneHandle& self) {
            model::Scene copy = self.scene();
            return dict_of(base::effective(copy, "Sprekk"));
          },
          one_at_a_time)
      .def(
          "xml", [](const SceneHandle& self) { return base::to_xml(self.entries()); }, one_at_a_time)
      .def(
          "effective_xml",
          [](const SceneHandle& self) {
            model::Scene copy = self.scene();
            return base::to_xml(base::effective(copy, "Sprekk"));
          },
          one_at_a_time)
      .def(
          "times", [](const SceneHandle& self) { return self.scene().time.times(); }, one_at_a_time)
      .def(
          "outline",
          [](const SceneHandle& self) {
            const auto mesh = self.scene().read_mesh();
            return py::make_tuple(mesh.dim(), mesh.boundary_names);
          },
          one_at_a_time)
      .def_property_readonly("origin", &SceneHandle::origin)
      .def_property_readonly("folder", &SceneHandle::folder);

  m.def("specification", [] { return model::specification(); });
  m.def(
      "drive",
      [](const py::dict& entries, const std::string& origin, const Overrides& overrides) {
        const auto scene = laboratory::point_scene_of(list_of(entries), origin, overrides);
        std::vector<laboratory::PointCurve> curves;
        {
          const py::gil_scoped_release free;
          curves = laboratory::drive_points(scene);
        }
        py::list all;
        for (auto& curve : curves) {
          const auto specimen = std::exchange(curve.specimen, "");  // column of texts
          all.append(py::make_tuple(specimen, columns_of(curve), curve.failure));
        }
        return all;
      },
      one_at_a_time);
  m.def(
      "read_entries",
      [](const std::string& path, const py::object& comm) {
        return dict_of(base::read_xml(*comm_of(comm), path, "Sprekk", base::Defects::refuse));
      },
      one_at_a_time);
  m.def("materials", [] { return physics::library_markdown(); });
}

}  // namespace sprekk::python
