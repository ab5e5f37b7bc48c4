// Modules with residuals in Python, computed with numpy arrays over all entities of a loop at once.
#include "own_module.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/loop.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string>

namespace sprekk::python {

using assembly::Loop;
using assembly::State;
using fields::Entity;

namespace {

/// Runs work() with the interpreter lock. An exception becomes an Error, which is reported on all ranks.
template <class Work>
auto in_python(const std::string& module, const Work& work) {
  const py::gil_scoped_acquire lock;
  try {
    return work();
  } catch (const py::error_already_set& error) {
    throw Error(fmt::format("module \"{}\": {}", module, error.what()));
  } catch (const py::cast_error& error) {
    throw Error(fmt::format("module \"{}\": {}", module, error.what()));
  }
}

template <class T>
T one_of(const std::map<std::string, T>& all, const std::string& name, const char* what) {
  const auto found = all.find(name);
  if (found != all.end()) return found->second;
  std::string names;
  for (const auto& [known, value] : all) names += (names.empty() ? "" : ", ") + known;
  throw Error(fmt::format("there is no {} \"{}\", but {}", what, name, names));
}

Loop loop_of(const std::string& name) {
  const std::map<std::string, Loop> loops = {{"cells", Loop::cells},
                                             {"fracture sides", Loop::fracture_sides},
                                             {"fracture faces", Loop::fracture_faces},
                                             {"fracture cells", Loop::fracture_cells},
                                             {"boundary faces", Loop::boundary_faces},
                                             {"neighbours", Loop::neighbours}};
  return one_of(loops, name, "loop");
}

Entity entity_of(const std::string& name) {
  const std::map<std::string, Entity> entities = {{"node", Entity::node},
                                                  {"cell", Entity::cell},
                                                  {"fracture face", Entity::fracture_face},
                                                  {"facet", Entity::facet}};
  return one_of(entities, name, "kind of entity");
}

assembly::Unknown unknown_of(const py::object& unknown) {
  const auto text = [&](const char* name) { return unknown.attr(name).cast<std::string>(); };
  assembly::Unknown u{{text("name"), entity_of(text("entity")), unknown.attr("components").cast<int>(), text("unit")},
                      text("scale")};
  for (const auto& [scale, factor] : unknown.attr("row").cast<std::map<std::string, Real>>())
    u.row.push_back({scale, factor});
  u.local_group = text("local_group");
  u.condensed_into = text("condensed_into");
  u.balance = unknown.attr("balance").cast<bool>();
  if (unknown.attr("smooth").cast<bool>()) u.near_null_space = assembly::NearNullSpace::constants;
  return u;
}

using Array = py::array_t<Real, py::array::c_style | py::array::forcecast>;

/// Returns an array view of memory. Python code must not store the array.
template <class T>
py::array_t<Real> borrowed(const T* values, std::vector<py::ssize_t> shape) {
  const py::capsule nobody(values, [](void*) {});
  return py::array_t<Real>(std::move(shape), values, nobody);
}

/// Residual on one loop.
struct Block {
  py::object python;
  Loop loop;
  std::vector<std::string> row_names, column_names;
  std::vector<int> rows, columns;  ///< field numbers
  std::vector<assembly::Stencil> row_stencils, column_stencils;
  std::vector<LocalIndex> n_owned;                  ///< [row field] number of owned unknowns
  std::vector<ConstView<LocalIndex***>> positions;  ///< [row * columns + column]

  int n_entities() const { return static_cast<int>(column_stencils.front().first.extent(0)); }
  static py::ssize_t size_of(const assembly::Stencil& stencil) { return stencil.first.extent(1) * stencil.width; }

  /// Returns the unknowns of all entities for each column field, [entity, unknown of the entity].
  py::dict gather(const State& state) const {
    py::dict all;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto& [first, width, writers] = column_stencils[k];
      Array values({py::ssize_t(n_entities()), size_of(column_stencils[k])});
      Real* to = values.mutable_data();
      for (std::size_t e = 0; e < first.extent(0); ++e)
        for (std::size_t g = 0; g < first.extent(1); ++g)
          for (int c = 0; c < width; ++c) *to++ = first(e, g) < 0 ? 0 : state.x[columns[k]](first(e, g) + c);
      all[column_names[k].c_str()] = values;
    }
    return all;
  }

  void check_shape(const Array& values, std::vector<py::ssize_t> shape, const std::string& what) const {
    const std::vector<py::ssize_t> is(values.shape(), values.shape() + values.ndim());
    SPREKK_CHECK(is == shape, "{} has the shape ({}), must have ({})", what, fmt::join(is, ", "),
                 fmt::join(shape, ", "));
  }

  void add_residual(const py::object& result, const assembly::Rows& r) const {
    const auto given = result.cast<py::dict>();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!given.contains(row_names[i].c_str())) continue;
      const auto values = given[row_names[i].c_str()].cast<Array>();
      const auto& [first, width, writers] = row_stencils[i];
      check_shape(values, {n_entities(), size_of(row_stencils[i])},
                  fmt::format("the residual of \"{}\"", row_names[i]));
      const Real* from = values.data();
      for (std::size_t e = 0; e < first.extent(0); ++e)
        for (std::size_t g = 0; g < first.extent(1); ++g, from += width)
          for (int c = 0; c < width && first(e, g) >= 0 && first(e, g) < n_owned[i]; ++c)
            r[rows[i]](first(e, g) + c) += from[c];
    }
  }

  void add_jacobian(const py::object& result, fields::BlockMatrix& J) {
    const auto given = result.cast<py::dict>();
    if (positions.empty())
      for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t k = 0; k < columns.size(); ++k)
          positions.push_back(assembly::find_positions(*J(rows[i], columns[k]), row_stencils[i], column_stencils[k]));
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k < columns.size(); ++k) {
        if (J(rows[i], columns[k]).is_null()) continue;
        const auto key = py::make_tuple(row_names[i], column_names[k]);
        if (given.contains(key)) add_block(given[key].cast<Array>(), i, k, *J(rows[i], columns[k]));
      }
  }

  void add_block(const Array& values, std::size_t i, std::size_t k, fields::CrsMatrix& J) const {
    const py::ssize_t height = size_of(row_stencils[i]), length = size_of(column_stencils[k]);
    check_shape(values, {n_entities(), height, length},
                fmt::format("the derivative of \"{}\" by \"{}\"", row_names[i], column_names[k]));
    const auto local = J.getLocalMatrixDevice();
    const auto& place = positions[i * columns.size() + k];
    const auto& first = row_stencils[i].first;
    const int h = row_stencils[i].width, w = column_stencils[k].width;
    for (std::size_t e = 0; e < first.extent(0); ++e)
      for (std::size_t g = 0; g < first.extent(1); ++g) {
        if (first(e, g) < 0 || first(e, g) >= n_owned[i]) continue;
        for (std::size_t column = 0; column < column_stencils[k].first.extent(1); ++column) {
          const LocalIndex position = place(e, g, column);
          for (int c = 0; c < h && position >= 0; ++c)
            for (int d = 0; d < w; ++d)
              local.values(local.graph.row_map(first(e, g) + c) + position + d) +=
                  values.data()[(e * height + g * h + c) * length + column * w + d];
        }
      }
  }
};

class OwnModule final : public assembly::Module,
                        public assembly::Loads,
                        public assembly::Steps,
                        public assembly::RowWeights {
 public:
  OwnModule(py::object python, const py::object& mesh, Failure failure)
      : python_(std::move(python)), name_(python_.attr("name").cast<std::string>()), failure_(std::move(failure)) {
    for (const auto& block : python_.attr("blocks")(mesh)) {
      Block own;
      own.python = py::reinterpret_borrow<py::object>(block);
      own.loop = loop_of(own.python.attr("loop").cast<std::string>());
      own.row_names = own.python.attr("rows").cast<std::vector<std::string>>();
      own.column_names = own.python.attr("columns").cast<std::vector<std::string>>();
      SPREKK_CHECK(!own.column_names.empty(), "module \"{}\": a block reads no field", name_);
      blocks_.push_back(std::move(own));
    }
  }
  ~OwnModule() override {
    const py::gil_scoped_acquire lock;
    blocks_.clear();
    python_ = py::object();
  }

  std::string name() const override { return name_; }
  std::string fingerprint() const override {
    return in_python(name_, [&] { return python_.attr("fingerprint").cast<std::string>(); });
  }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    return in_python(name_, [&] {
      assembly::Declaration d;
      for (const auto& unknown : python_.attr("unknowns"))
        d.unknowns.push_back(unknown_of(py::reinterpret_borrow<py::object>(unknown)));
      for (const auto& unknown : d.unknowns) {
        const auto& field = unknown.field;
        if (field.entity == Entity::facet) continue;  // absent in result files
        assembly::Summary summary;
        if (field.entity == Entity::fracture_face)
          summary = {assembly::Summary::mean, field.name, field.n_components > 1 ? "local" : ""};
        d.outputs.push_back({{field.name, field.unit, field.entity, field.n_components, summary},
                             [this, field](const State& state) { return values(state, field); }});
      }
      for (const auto& block : blocks_)
        for (const auto& row : block.row_names) d.couplings.push_back({block.loop, row, block.column_names});
      for (const auto& [history, kind] :
           python_.attr("histories").cast<std::map<std::string, std::pair<std::string, int>>>())
        d.history.push_back({history, entity_of(kind.first), kind.second});
      d.scales = python_.attr("scales").cast<std::map<std::string, Real>>();
      d.stores = python_.attr("stores").cast<bool>();
      return d;
    });
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    in_python(name_, [&] {
      for (auto& block : blocks_) {
        for (const auto& row : block.row_names) {
          block.rows.push_back(context.field(row));
          block.row_stencils.push_back(context.stencil(block.loop, block.rows.back()));
          block.n_owned.push_back(context.layout(block.rows.back()).n_owned());
        }
        for (const auto& column : block.column_names) {
          block.columns.push_back(context.field(column));
          block.column_stencils.push_back(context.stencil(block.loop, block.columns.back()));
        }
      }
      for (const auto& unknown : python_.attr("unknowns")) {
        const auto field = unknown.attr("name").cast<std::string>();
        numbers_[field] = context.field(field);
      }
      for (const auto& item : python_.attr("histories").cast<py::dict>())
        history_names_.push_back(item.first.cast<std::string>());
      std::sort(history_names_.begin(), history_names_.end());  // in the order of the declaration
    });
  }

  void residual(const State& state, const assembly::Rows& r) const override {
    attempt([&] {
      const auto now = state_of(state);
      for (const auto& block : blocks_) block.add_residual(block.python.attr("residual")(block.gather(state), now), r);
    });
  }
  void jacobian(const State& state, fields::BlockMatrix& J) const override {
    attempt([&] {
      const auto now = state_of(state);
      for (auto& block : blocks_) block.add_jacobian(block.python.attr("derivative")(block.gather(state), now), J);
    });
  }
  void commit(State& state) const override {
    attempt([&] {
      py::list gathered;
      for (const auto& block : blocks_) gathered.append(block.gather(state));
      python_.attr("commit")(state_of(state), gathered);
    });
  }
  void merit_weights(const assembly::Rows& weights) const override {
    in_python(name_, [&] {
      for (const auto& [row, weight] : python_.attr("merit").cast<std::map<std::string, Real>>())
        Kokkos::deep_copy(weights[numbers_.at(row)], weight);
    });
  }
  bool constant_load() const override { return false; }
  bool symmetric(const State&) const override {
    return in_python(name_, [&] { return python_.attr("symmetric").cast<bool>(); });
  }
  assembly::Scales loads(Real t) const override {
    return in_python(name_, [&] { return python_.attr("loads")(t).cast<std::map<std::string, Real>>(); });
  }

 private:
  /// Returns the values of a field on owned entities, or on all local nodes.
  std::vector<Real> values(const State& state, const fields::Field& field) const {
    const auto& x = state.x[numbers_.at(field.name)];
    const bool on_nodes = field.entity == Entity::node;
    const LocalIndex n = on_nodes ? mesh_->n_nodes() : fields::n_entities(*mesh_, field.entity, false);
    std::vector<Real> values;
    for (LocalIndex e = 0; e < n; ++e)
      for (int i = 0; i < field.n_components; ++i)
        values.push_back(x((on_nodes ? mesh_->free_node(e) : e) * field.n_components + i));
    return values;
  }

  /// Runs work() unless Python code has failed before. Saves the message of a failure.
  template <class Work>
  void attempt(const Work& work) const {
    if (!failure_->empty()) return;
    try {
      in_python(name_, work);
    } catch (const Error& error) {
      *failure_ = error.what();
    }
  }

  /// Returns t, rate and the histories by name, [owned entity, component].
  py::object state_of(const State& state) const {
    py::dict histories;
    for (std::size_t k = 0; k < history_names_.size(); ++k) {
      const auto& values = state.history[k];
      histories[history_names_[k].c_str()] =
          borrowed(values.data(), {py::ssize_t(values.extent(0)), py::ssize_t(values.extent(1))});
    }
    return py::module_::import("sprekk.module").attr("State")(state.t, state.rate, histories);
  }

  py::object python_;
  std::string name_;
  Failure failure_;
  mutable std::vector<Block> blocks_;  // mutable: store positions after the first assembly
  RCP<const mesh::Mesh> mesh_;
  std::map<std::string, int> numbers_;  // of the module's fields
  std::vector<std::string> history_names_;
};

}  // namespace

model::ModuleFactory own_modules(const py::object& modules, MeshOf mesh_of, const Failure& failure) {
  if (modules.is_none() || py::len(modules) == 0) return {};
  const auto kept = std::shared_ptr<py::object>(new py::object(modules), [](py::object* object) {
    const py::gil_scoped_acquire lock;
    delete object;
  });
  return [kept, mesh_of, failure](const mesh::Mesh& mesh) {
    std::vector<std::unique_ptr<assembly::Module>> made;
    in_python("own modules", [&] {
      const py::object arrays = py::module_::import("sprekk.mesh").attr("Mesh")(mesh_of(mesh));
      for (const auto& module : *kept)
        made.push_back(std::make_unique<OwnModule>(py::reinterpret_borrow<py::object>(module), arrays, failure));
    });
    return made;
  };
}

}  // namespace sprekk::python
