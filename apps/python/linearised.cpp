#include "linearised.hpp"

#include "assembly/jacobian_check.hpp"
#include "base/over_ranks.hpp"

namespace sprekk::python {

using model::Model;

namespace {

/// Global numbers of rows and columns of a system with block after block.
struct Numbering {
  std::vector<GlobalIndex> first;  ///< [block] first number
  explicit Numbering(const assembly::System& system) {
    GlobalIndex n = 0;
    for (const auto& block : system.blocks()) {
      first.push_back(n);
      n += static_cast<GlobalIndex>(block.map->getGlobalNumElements());
    }
    first.push_back(n);
  }
};

fields::BlockVector vectors_of(const assembly::System& system, const py::list& unknowns) {
  fields::BlockVector x;
  for (std::size_t b = 0; b < system.blocks().size(); ++b) {
    x.push_back(rcp(new fields::Vector(system.blocks()[b].map)));
    const auto values = unknowns[b].cast<py::array_t<Real, py::array::c_style | py::array::forcecast>>();
    const auto local = x[b]->getLocalViewHost(Tpetra::Access::OverwriteAll);
    SPREKK_CHECK(static_cast<std::size_t>(values.size()) == local.extent(0),
                 "block \"{}\": {} values are given, it has {}", system.blocks()[b].name, values.size(),
                 local.extent(0));
    for (std::size_t i = 0; i < local.extent(0); ++i) local(i, 0) = values.data()[i];
  }
  return x;
}

}  // namespace

py::list residual_at(Model& model, const py::list& unknowns, Real t, Real dt) {
  auto& system = model.system();
  const auto x = vectors_of(system, unknowns);
  auto r = fields::create_like(x);
  system.set_time(t, dt);
  system.residual(x, r);
  py::list all;
  for (const auto& block : r) {
    const auto local = block->getLocalViewHost(Tpetra::Access::ReadOnly);
    std::vector<Real> values;
    for (std::size_t i = 0; i < local.extent(0); ++i) values.push_back(local(i, 0));
    all.append(array_of(std::move(values)));
  }
  return all;
}

py::tuple jacobian_at(Model& model, const py::list& unknowns, Real t, Real dt) {
  auto& system = model.system();
  const auto x = vectors_of(system, unknowns);
  const Numbering numbers(system);
  auto J = system.create_matrix();
  std::vector<GlobalIndex> rows, columns;
  std::vector<Real> values;
  const int n = J.n_blocks();
  system.set_time(t, dt);
  for (std::size_t m = 0; m < system.modules().size(); ++m) {
    system.module_jacobian(static_cast<int>(m), x, J);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        if (J(i, j).is_null()) continue;
        const auto held = system.constrained(i);
        const auto local = J(i, j)->getLocalMatrixDevice();
        const auto& row_map = *J(i, j)->getRowMap();
        const auto& column_map = *J(i, j)->getColMap();
        for (LocalIndex row = 0; row < local.numRows(); ++row) {
          if (held(row)) continue;
          for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k) {
            if (local.values(k) == 0) continue;
            rows.push_back(numbers.first[i] + row_map.getGlobalElement(row));
            columns.push_back(numbers.first[j] + column_map.getGlobalElement(local.graph.entries(k)));
            values.push_back(local.values(k));
          }
        }
      }
  }
  for (int i = 0; i < n; ++i) {
    const auto held = system.constrained(i);
    for (std::size_t row = 0; row < held.extent(0); ++row)
      if (held(row)) {
        rows.push_back(numbers.first[i] + system.blocks()[i].map->getGlobalElement(static_cast<LocalIndex>(row)));
        columns.push_back(rows.back());
        values.push_back(1);
      }
  }
  py::list owned;
  for (int i = 0; i < n; ++i) {
    std::vector<GlobalIndex> here;
    for (const GlobalIndex k : base::local_elements(*system.blocks()[i].map)) here.push_back(numbers.first[i] + k);
    owned.append(array_of(std::move(here)));
  }
  return py::make_tuple(array_of(std::move(rows)), array_of(std::move(columns)), array_of(std::move(values)),
                        numbers.first.back(), owned);
}

py::list jacobian_errors(Model& model, const py::list& unknowns, Real t, Real dt) {
  auto& system = model.system();
  const auto x = vectors_of(system, unknowns);
  system.set_time(t, dt);
  py::list all;
  for (const auto& error : assembly::check_jacobian(system, x))
    all.append(py::make_tuple(error.module, error.row, error.column, error.error));
  return all;
}

}  // namespace sprekk::python
