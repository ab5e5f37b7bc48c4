// Models: steps, views of fields, and outputs of states.
#include "linearised.hpp"
#include "own_module.hpp"
#include "ranks.hpp"
#include "scene_handle.hpp"

#include "assembly/geometry.hpp"
#include "base/over_ranks.hpp"
#include "base/xml.hpp"
#include "model/fracture_table.hpp"
#include "model/growth.hpp"
#include "model/results.hpp"
#include "model/steps.hpp"
#include "physics/poroelasticity/given_pressure.hpp"

#include <fmt/ranges.h>

#include <optional>
#include <string>

namespace sprekk::python {

using assembly::OutputField;
using model::Model;

namespace {

/// Stop request, called in each iteration of Newton's method. True after Ctrl-C, or if Python code has failed.
struct Interrupt {
  Failure failure;

  bool operator()() const {
    if (!failure->empty()) return true;
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() == 0) return false;
    PyErr_Clear();
    return true;
  }
};

py::dict mesh_of(const mesh::Mesh& mesh, LocalIndex n_faces);
py::dict local_mesh(const mesh::Mesh& mesh) { return mesh_of(mesh, mesh.n_fracture_faces()); }

/// Returns the text that must be equal on all ranks.
std::string text_of(const SceneHandle& scene, const std::optional<std::pair<bool, Real>>& host_fluid) {
  model::Scene copy = scene.scene();
  const auto fluid = host_fluid ? fmt::format("pressure of a host {} {}", host_fluid->first, host_fluid->second) : "";
  return base::to_xml(base::effective(copy, "Sprekk")) + fluid;
}

/// Model with the objects that must outlive it.
class ModelHandle {
 public:
  ModelHandle(const SceneHandle& scene, py::object comm, const std::optional<std::pair<bool, Real>>& host_fluid,
              const py::object& modules)
      : comm_(std::move(comm)) {
    const auto ranks = comm_of(comm_);
    check_thread(*ranks);
    check_same(*ranks, scene.origin(), text_of(scene, host_fluid));
    has_modules_ = py::len(modules) > 0;
    const auto more_modules = own_modules(modules, local_mesh, failure_);
    const py::gil_scoped_release free;
    auto own = scene.scene();
    own.solver.should_stop = Interrupt{failure_};
    if (host_fluid) own.host_fluid = physics::HostFluid{host_fluid->first, host_fluid->second};
    model_ = std::make_unique<Model>(own, ranks, more_modules);
  }

  Model& operator*() const {
    SPREKK_CHECK(model_, "the model has been closed");
    return *model_;
  }
  Model* operator->() const { return &**this; }
  void close() { model_.reset(); }

  const py::object& comm() const { return comm_; }

  ~ModelHandle() {
    const Alone alone;
    model_.reset();
  }

  void change(const SceneHandle& changed) {
    check_same(*(*this)->mesh().comm, changed.origin(), text_of(changed, {}));
    auto own = changed.scene();
    own.host_fluid = (*this)->scene().host_fluid;
    own.solver.should_stop = Interrupt{failure_};
    (*this)->change(own);
  }

  /// Throws an Error on all ranks if Python code has failed on any rank during an evaluation. `in_step`: the step is
  /// undone. Collective.
  void check(bool in_step = true) {
    const auto& ranks = *(*this)->mesh().comm;
    if (!has_modules_ || !base::on_any_rank(ranks, !failure_->empty())) return;
    const auto what = std::exchange(*failure_, "");
    if (in_step) model_->take_back();
    base::collectively(ranks, [&] { SPREKK_CHECK(what.empty(), "{}", what); });
  }

 private:
  py::object comm_;
  Failure failure_ = std::make_shared<std::string>();
  bool has_modules_ = false;
  std::unique_ptr<Model> model_;
};

/// Loop over the steps of a scene.
struct StepsHandle {
  explicit StepsHandle(ModelHandle& of) : model(of), steps(*of), log(*of->mesh().comm, false) { tips.begin(*of); }
  ModelHandle& model;
  model::Steps steps;
  base::Log log;
  model::Tips tips;

  model::StepTaken take() {
    const auto taken = tips.take(*model, steps, log);
    model.check();
    return taken;
  }
};

/// Returns a view of a field. The array keeps the memory alive after the model ends.
py::array_t<Real> view_of(Model& model, const std::string& name) {
  struct Owner {
    model::FieldView field;
    fields::BlockVector unknowns;
  };
  auto* owner = new Owner{model.field(name), model.state()};
  const py::capsule keeper(owner, [](void* p) {
    const Alone alone;
    delete static_cast<Owner*>(p);
  });
  const auto& values = owner->field.values;
  return py::array_t<Real>({values.extent(0), values.extent(1)}, values.data(), keeper);
}

py::array_t<Real> values_of(OutputField& output) {
  const auto n = static_cast<py::ssize_t>(output.values.size()) / output.n_components;
  if (output.n_components == 1) return array_of(std::move(output.values), {n});
  return array_of(std::move(output.values), {n, output.n_components});
}

py::tuple kind_of(const fields::Field& field) {
  return py::make_tuple(fields::name_of(field.entity), field.n_components, field.unit);
}

/// Returns entity, number of components and unit by name.
py::dict fields_of(Model& model) {
  py::dict all;
  for (const auto& layout : model.system().layouts()) all[layout.field().name.c_str()] = kind_of(layout.field());
  for (const auto& [field, values] : model.system().histories()) all[field.name.c_str()] = kind_of(field);
  return all;
}

std::vector<OutputField> outputs_of(Model& model) { return model.system().outputs(model.state()); }

py::dict dict_of(std::vector<OutputField> outputs) {
  py::dict all;
  for (auto& output : outputs) {
    const auto kind = py::make_tuple(fields::name_of(output.entity), output.n_components, output.unit);
    all[output.name.c_str()] = py::make_tuple(values_of(output), kind);
  }
  return all;
}

/// Returns the weights of the mean over a face at a side: [node], and the mean of the bubble.
std::pair<std::vector<Real>, Real> face_mean(const mesh::Mesh& mesh, LocalIndex f, int side) {
  const auto& face = mesh.fracture_faces[f];
  const auto shares = assembly::mean_shares(mesh, face.cell[side], face.local_face[side]);
  return std::pair(std::vector<Real>(shares.begin(), shares.begin() + mesh::n_face_nodes(mesh.shape)),
                   assembly::bubble_mean(mesh, face.cell[side], face.local_face[side]));
}

/// Returns this rank's part of the mesh: owned entities first, all cells and nodes, and n_faces fracture faces.
py::dict mesh_of(const mesh::Mesh& mesh, LocalIndex n_faces) {
  const py::ssize_t dim = mesh.dim(), per_cell = mesh.nodes_per_cell(), n = n_faces;
  const py::ssize_t per_face = mesh::n_face_nodes(mesh.shape);
  std::vector<int> fracture, single, nodes, face_cells;
  std::vector<GlobalIndex> id;
  std::vector<Real> area, centre, frame;
  for (py::ssize_t f = 0; f < n; ++f) {
    const auto& face = mesh.fracture_faces[f];
    id.push_back(face.id);
    fracture.push_back(face.fracture);
    single.push_back(face.single);
    area.push_back(face.area);
    centre.insert(centre.end(), face.centre.begin(), face.centre.begin() + dim);
    for (py::ssize_t i = 0; i < dim; ++i) frame.insert(frame.end(), face.frame[i].begin(), face.frame[i].begin() + dim);
    face_cells.insert(face_cells.end(), face.cell.begin(), face.cell.end());
    for (const auto& side : face.nodes) nodes.insert(nodes.end(), side.begin(), side.begin() + per_face);
  }
  std::vector<Real> shares, bubble, side_shares, side_bubble;
  for (LocalIndex f = 0; f < n_faces; ++f) {
    const bool known = mesh.fracture_faces[f].cell[mesh::minus] >= 0;  // otherwise zero
    const auto [nodes, own] = known ? face_mean(mesh, f, mesh::minus) : std::pair(std::vector<Real>(per_face), Real(0));
    shares.insert(shares.end(), nodes.begin(), nodes.end());
    bubble.push_back(own);
  }
  std::vector<LocalIndex> sides;
  for (const auto& [f, side] : assembly::fracture_sides(mesh)) {
    if (f >= n_faces) continue;
    const auto [nodes, own] = face_mean(mesh, f, side);
    sides.insert(sides.end(), {f, side});
    side_shares.insert(side_shares.end(), nodes.begin(), nodes.end());
    side_bubble.push_back(own);
  }
  const auto n_sides = static_cast<py::ssize_t>(side_bubble.size());
  py::list singles;
  for (const auto& one : mesh.single_fractures) singles.append(one.name);
  constexpr const char* shapes[] = {"triangle",  "quadrilateral",  "tetrahedron",   "hexahedron",
                                    "triangle6", "quadrilateral9", "tetrahedron10", "hexahedron27"};
  py::dict all;
  all["shape"] = shapes[static_cast<int>(mesh.shape)];
  all["dim"] = mesh.dim();
  all["n_owned_nodes"] = mesh.n_owned_nodes;
  all["n_owned_cells"] = mesh.n_owned_cells;
  all["coordinates"] = array_of(mesh.coordinates, {mesh.n_nodes(), dim});
  all["cells"] = array_of(mesh.cells, {mesh.n_cells(), per_cell});
  all["cell_region"] = array_of(mesh.cell_region);
  all["node_id"] = array_of(mesh.node_id);
  all["cell_id"] = array_of(mesh.cell_id);
  all["face_id"] = array_of(std::move(id));
  all["face_fracture"] = array_of(std::move(fracture));
  all["face_single"] = array_of(std::move(single));
  all["face_area"] = array_of(std::move(area));
  all["face_centre"] = array_of(std::move(centre), {n, dim});
  all["face_frame"] = array_of(std::move(frame), {n, dim, dim});
  all["face_nodes"] = array_of(std::move(nodes), {n, 2, per_face});
  all["face_share"] = array_of(std::move(shares), {n, per_face});
  all["face_bubble"] = array_of(std::move(bubble));
  all["face_cells"] = array_of(std::move(face_cells), {n, 2});
  all["sides"] = array_of(std::move(sides), {n_sides, 2});
  all["side_share"] = array_of(std::move(side_shares), {n_sides, per_face});
  all["side_bubble"] = array_of(std::move(side_bubble));
  all["regions"] = mesh.region_names;
  all["boundaries"] = mesh.boundary_names;
  all["fractures"] = mesh.fracture_names;
  all["single_fractures"] = singles;
  return all;
}

py::list table_of(const Model& model, std::vector<OutputField> outputs, bool singles) {
  py::list columns;
  const auto grouping = singles ? model::Grouping::singles : model::Grouping::sets;
  for (auto& column : model::fracture_table(model.mesh(), outputs, grouping)) {
    const auto n = static_cast<py::ssize_t>(column.values.size()) / column.n_components;
    const auto name = column.full_name(), unit = column.unit;
    const py::ssize_t width = column.n_components;
    columns.append(py::make_tuple(name, unit, array_of(std::move(column.values), {n, width})));
  }
  return columns;
}

py::list reactions_of(Model& model) {
  py::list all;
  for (auto& reaction : model.system().reactions_of_step(model.state())) {
    const std::vector<Real> moment(reaction.moment.begin(), reaction.moment.end());
    all.append(py::make_tuple(reaction.condition, reaction.field, reaction.called.unit,
                              array_of(std::move(reaction.force)), array_of(moment)));
  }
  return all;
}

/// Returns numbers that describe the whole state, by name, "a > b". Collective.
py::dict totals_of(Model& model) {
  py::dict all;
  for (const auto& total : model.system().totals(model.state()))
    all[fmt::format("{}", fmt::join(total.names, " > ")).c_str()] = total.value;
  return all;
}

void set_fluid_pressure(Model& model, const std::vector<Real>& cells, const std::vector<Real>& faces) {
  physics::set_fluid_pressure(model.system(), cells, faces);
}

/// Complete state, owned by Python.
struct CheckpointHandle {
  io::Checkpoint checkpoint;
  RCP<const Comm> comm;
  py::object ranks;  ///< mpi4py object of the communicator
};

std::vector<std::string> blocks_of(const Model& model) {
  std::vector<std::string> names;
  for (const auto& block : model.system().blocks()) names.push_back(block.name);
  return names;
}

/// Calls work() without the interpreter lock, so that other threads may run.
template <class Work>
auto freely(const Work& work) {
  const py::gil_scoped_release free;
  return work();
}

void bind_reports(py::module_& m) {
  using solve::StepReport;
  py::class_<StepReport>(m, "StepReport", "How a step went.")
      .def_readonly("converged", &StepReport::converged)
      .def_readonly("stopped", &StepReport::stopped)
      .def_readonly("time", &StepReport::time)
      .def_readonly("newton_iterations", &StepReport::newton_iterations)
      .def_property_readonly("linear_iterations",
                             [](const StepReport& report) { return solve::iterations(report.linear_solves); })
      .def_readonly("substeps", &StepReport::substeps)
      .def_readonly("cuts", &StepReport::cuts)
      .def_readonly("reason", &StepReport::reason)
      .def_readonly("floating", &StepReport::floating);
  using model::StepTaken;
  py::class_<StepTaken>(m, "StepTaken", "A step of a run.")
      .def_readonly("report", &StepTaken::report)
      .def_readonly("begin", &StepTaken::begin)
      .def_readonly("end", &StepTaken::end)
      .def_readonly("stage", &StepTaken::stage)
      .def_readonly("rejected", &StepTaken::n_rejected);
}

void bind_runs(py::module_& m) {
  using model::Results;
  py::class_<StepsHandle>(m, "Steps")
      .def(py::init([](ModelHandle& model) { return freely([&] { return std::make_unique<StepsHandle>(model); }); }),
           py::keep_alive<1, 2>(), py::call_guard<Alone>())
      .def("any", [](const StepsHandle& self) { return self.steps.any(); })
      .def("share_done", [](const StepsHandle& self) { return self.steps.share_done(); })
      .def("take", &StepsHandle::take, py::call_guard<Alone, py::gil_scoped_release>());
  py::class_<Results>(m, "Results")
      .def(py::init([](ModelHandle& model, const std::string& folder) {
             return freely([&] { return std::make_unique<Results>(*model, model->scene(), folder); });
           }),
           py::keep_alive<1, 2>(), py::call_guard<Alone>())
      .def("add_step", &Results::add_step, py::call_guard<Alone, py::gil_scoped_release>())
      .def("take_warnings", &Results::take_warnings)
      .def("finish", &Results::finish, py::call_guard<Alone, py::gil_scoped_release>());
}

}  // namespace

void bind_model(py::module_& m) {
  const py::call_guard<Alone> one_at_a_time;
  bind_reports(m);
  py::class_<CheckpointHandle>(m, "Checkpoint", "All that the next step depends on.")
      .def_property_readonly(
          "time", [](const CheckpointHandle& self) { return self.checkpoint.content.at("time").get<Real>(); })
      .def(
          "write",
          [](const CheckpointHandle& self, const std::string& folder) {
            freely([&] {
              io::Checkpoints all(self.comm, folder);
              all.clear();
              all.write(self.checkpoint);
            });
          },
          one_at_a_time)
      .def_static(
          "read",
          [](const std::string& folder, py::object comm) {
            auto handle = std::make_unique<CheckpointHandle>();
            handle->comm = comm_of(comm);
            handle->ranks = std::move(comm);
            std::vector<std::string> damage;
            handle->checkpoint = io::Checkpoints(handle->comm, folder).read(damage);
            for (const auto& line : damage)
              if (PyErr_WarnEx(PyExc_RuntimeWarning, line.c_str(), 1)) throw py::error_already_set();
            return handle;
          },
          one_at_a_time);

  py::class_<ModelHandle>(m, "Model")
      .def(py::init<const SceneHandle&, py::object, const std::optional<std::pair<bool, Real>>&, const py::object&>(),
           one_at_a_time)
      .def("close", &ModelHandle::close, one_at_a_time)
      .def_property_readonly("comm", &ModelHandle::comm)
      .def_property_readonly(
          "time", [](ModelHandle& self) { return self->time(); }, one_at_a_time)
      .def(
          "step_to",
          [](ModelHandle& self, Real t) {
            return freely([&] {
              check_same(*self->mesh().comm, "the time of a step", fmt::format("{:.17g}", t));
              const auto report = self->step_to(t);
              self.check();
              return report;
            });
          },
          one_at_a_time)
      .def(
          "find_equilibrium",
          [](ModelHandle& self) {
            return freely([&] {
              const auto report = self->find_equilibrium();
              self.check();
              return report;
            });
          },
          one_at_a_time)
      .def(
          "take_back", [](ModelHandle& self) { freely([&] { self->take_back(); }); }, one_at_a_time)
      .def(
          "change", [](ModelHandle& self, const SceneHandle& scene) { freely([&] { self.change(scene); }); },
          one_at_a_time)
      .def(
          "warnings", [](ModelHandle& self) { return freely([&] { return self->warnings(); }); }, one_at_a_time)
      .def(
          "save",
          [](ModelHandle& self) {
            auto handle = std::make_unique<CheckpointHandle>();
            freely([&] { handle->checkpoint = self->save(); });
            handle->comm = self->mesh().comm;
            handle->ranks = self.comm();
            return handle;
          },
          one_at_a_time)
      .def(
          "restore",
          [](ModelHandle& self, const CheckpointHandle& from) { freely([&] { self->restore(from.checkpoint); }); },
          one_at_a_time)
      .def(
          "fields", [](ModelHandle& self) { return fields_of(*self); }, one_at_a_time)
      .def(
          "field", [](ModelHandle& self, const std::string& name) { return view_of(*self, name); }, one_at_a_time)
      .def(
          "outputs", [](ModelHandle& self) { return dict_of(freely([&] { return outputs_of(*self); })); },
          one_at_a_time)
      .def(
          "mesh", [](ModelHandle& self) { return mesh_of(self->mesh(), self->mesh().n_owned_fracture_faces); },
          one_at_a_time)
      .def(
          "fracture_table",
          [](ModelHandle& self, bool singles) {
            return table_of(*self, freely([&] { return outputs_of(*self); }), singles);
          },
          one_at_a_time)
      .def(
          "described_singles", [](ModelHandle& self) { return model::described_singles(self->mesh()).dump(); },
          one_at_a_time)
      .def(
          "reactions", [](ModelHandle& self) { return reactions_of(*self); }, one_at_a_time)
      .def(
          "totals", [](ModelHandle& self) { return totals_of(*self); }, one_at_a_time)
      .def(
          "set_fluid_pressure",
          [](ModelHandle& self, const std::vector<Real>& cells, const std::vector<Real>& faces) {
            set_fluid_pressure(*self, cells, faces);
          },
          one_at_a_time)
      .def(
          "blocks", [](ModelHandle& self) { return blocks_of(*self); }, one_at_a_time)
      .def(
          "residual_at",
          [](ModelHandle& self, const py::list& x, Real t, Real dt, bool raw) {
            const auto found = residual_at(*self, x, t, dt, raw);
            self.check(false);
            return found;
          },
          py::arg("x"), py::arg("t"), py::arg("dt"), py::arg("raw") = false, one_at_a_time)
      .def(
          "linearise", [](ModelHandle& self, Real dt) { linearise(*self, dt); }, one_at_a_time)
      .def(
          "response_to", [](ModelHandle& self, const py::list& b, Real to) { return response_to(*self, b, to); },
          one_at_a_time)
      .def(
          "error_energies", [](ModelHandle& self, const py::list& z) { return error_energies(*self, z); },
          one_at_a_time)
      .def(
          "product_with", [](ModelHandle& self, const py::list& x) { return product_with(*self, x); }, one_at_a_time)
      .def(
          "prescribed", [](ModelHandle& self) { return prescribed_in(*self); }, one_at_a_time)
      .def(
          "boundary", [](ModelHandle& self) { return boundary_of(self->mesh()); }, one_at_a_time)
      .def(
          "jacobian_errors",
          [](ModelHandle& self, const py::list& x, Real t, Real dt) {
            const auto found = jacobian_errors(*self, x, t, dt);
            self.check(false);
            return found;
          },
          one_at_a_time)
      .def(
          "jacobian_at",
          [](ModelHandle& self, const py::list& x, Real t, Real dt, bool raw) {
            const auto found = jacobian_at(*self, x, t, dt, raw);
            self.check(false);
            return found;
          },
          py::arg("x"), py::arg("t"), py::arg("dt"), py::arg("raw") = false, one_at_a_time);
  bind_runs(m);
}

}  // namespace sprekk::python
