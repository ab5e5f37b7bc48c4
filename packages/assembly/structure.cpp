#include "assembly/structure.hpp"

#include "assembly/multigrid_data.hpp"
#include "base/check.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace sprekk::assembly {

int Context::field(const std::string& name) const {
  for (std::size_t f = 0; f < layouts_->size(); ++f)
    if ((*layouts_)[f].field().name == name) return static_cast<int>(f);
  throw Error(fmt::format("no module declares the field \"{}\"", name));
}

namespace {

/// Throws an Error unless the names are distinct and valid as names of file groups.
void check_names(std::vector<std::string> names, const char* kind) {
  for (const auto& name : names)
    SPREKK_CHECK(!name.empty() && name.find('/') == name.npos,
                 "modules declare the {} \"{}\": a name must not be empty or "
                 "contain \"/\"",
                 kind, name);
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  SPREKK_CHECK(twice == names.end(), "modules declare the {} \"{}\" twice", kind, *twice);
}

}  // namespace

Structure::Structure(RCP<const mesh::Mesh> mesh, std::vector<std::unique_ptr<Module>> modules,
                     const std::vector<DirichletCondition>& conditions, RCP<base::Timers> timers)
    : mesh(mesh), timers(timers), geometry(*mesh), stencils(std::make_shared<Stencils>(mesh, layouts)) {
  const auto scope = timers->scope("set-up");
  for (auto& module : modules) this->modules.emplace_back(std::move(module));
  declare_fields();
  declare_groups();
  for (std::size_t b = 0; b < layouts.size(); ++b)
    constraints.emplace_back(*mesh, layouts[b], conditions_on(b, conditions));
  bind_modules();
  find_exchanges();
  coupled = couples_balances();
}

void Structure::declare_fields() {
  std::set<std::string> names;
  for (const auto& module : modules)
    for (const auto& unknown : module->declare(*mesh).unknowns) names.insert(unknown.field.name);
  std::vector<std::string> fields, histories;
  for (auto& module : modules) {
    module->set_fields(names);
    module.declaration = module->declare(*mesh);
    for (const auto& unknown : module.declaration.unknowns) {
      unknowns.push_back(unknown);
      fields.push_back(unknown.field.name);
    }
    for (const auto& history : module.declaration.history) histories.push_back(module.history_name(history));
  }
  check_names(fields, "field");
  check_names(histories, "history");
  for (const auto& unknown : unknowns) layouts.emplace_back(unknown.field, *mesh);
  for (int b = 0; b < static_cast<int>(unknowns.size()); ++b) add_block(unknowns[b], layouts[b]);
  for (const auto& module : modules) {
    for (const auto& name : module.declaration.carries) blocks[context().field(name)].advected = true;
    for (const auto& [field, term] : module.declaration.sizes) unknowns[context().field(field)].row.push_back(term);
  }
  for (int b = 0; b < n_blocks(); ++b)
    if (unknowns[b].near_null_space != NearNullSpace::none)
      set_multigrid(*mesh, unknowns[b].near_null_space, layouts[b], blocks[b]);
}

void Structure::add_block(const Unknown& unknown, const fields::Layout& layout) {
  fields::Block block{layout.field().name, layout.owned(), layout.field().n_components, 1, 1, {}, {}};
  block.enriches = unknown.enriches;
  block.condensed_into = unknown.condensed_into;
  block.balance = unknown.balance;
  if (block.balance) block.quantity = unknown.scale;
  blocks.push_back(block);
}

void Structure::declare_groups() {
  for (int b = 0; b < n_blocks(); ++b) {
    const auto& name = unknowns[b].local_group;
    if (name.empty()) continue;
    const auto same = [&](const fields::LocalGroup& group) { return group.name == name; };
    auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end()) found = groups.insert(groups.end(), {name, {}});
    found->blocks.push_back(b);
  }
}

std::vector<DirichletCondition> Structure::conditions_on(std::size_t block,
                                                         const std::vector<DirichletCondition>& conditions) const {
  const auto& enriched = unknowns[block].enriches;
  std::vector<DirichletCondition> own;
  for (const auto& condition : conditions) {
    if (condition.field == layouts[block].field().name) own.push_back(condition);
    if (condition.field != enriched) continue;
    own.push_back(condition);
    for (auto& value : own.back().values)
      if (value) value = base::Expression(0);
  }
  return own;
}

void Structure::bind_modules() {
  const auto context = this->context();
  for (auto& module : modules) {
    base::collectively(comm(), [&] { module->bind(context); });
    for (const auto& h : module.declaration.history)
      module.history.emplace_back(h.name, fields::n_entities(*mesh, h.entity, false), h.n_components);
    if (module.initial_values) module.initial_values->initial_history(module.history);
  }
}

void Structure::find_exchanges() {
  const auto context = this->context();
  std::vector<int> here(blocks.size(), 0);
  for (const auto& module : modules)
    for (const auto& coupling : module.declaration.couplings)
      for (const auto& name : coupling.columns) {
        const int f = context.field(name);
        const auto first = context.stencil(coupling.loop, f).first;
        const auto host = base::to_host(first);
        for (std::size_t e = 0; e < host.extent(0); ++e)
          for (std::size_t g = 0; g < host.extent(1); ++g) here[f] |= host(e, g) >= layouts[f].n_owned();
      }
  const auto anywhere = base::max_over_ranks(comm(), here);
  exchanged.assign(anywhere.begin(), anywhere.end());
}

bool Structure::couples_balances() const {
  const auto is_balance = [&](const std::string& name) { return unknowns[context().field(name)].balance; };
  for (const auto& module : modules)
    for (const auto& coupling : module.declaration.couplings)
      for (const auto& column : coupling.columns)
        if (is_balance(coupling.row) != is_balance(column)) return true;
  return false;
}

bool Structure::evolves() const {
  return std::any_of(modules.begin(), modules.end(), [](const auto& module) { return module.declaration.evolves; });
}

bool Structure::has_rates() const {
  return std::any_of(modules.begin(), modules.end(), [](const auto& module) { return module.declaration.stores; });
}

fields::BlockVector Structure::create_vector() const {
  fields::BlockVector v;
  for (const auto& block : blocks) v.push_back(rcp(new fields::Vector(block.map)));
  return v;
}

fields::BlockMatrix Structure::create_matrix() const {
  const auto context = this->context();
  const int n = n_blocks();
  std::vector<std::vector<std::pair<Stencil, Stencil>>> couplings(n * n);
  for (const auto& module : modules)
    for (const auto& coupling : module.declaration.couplings) {
      const int row = context.field(coupling.row);
      for (const auto& name : coupling.columns) {
        const int column = context.field(name);
        couplings[row * n + column].emplace_back(context.stencil(coupling.loop, row),
                                                 context.stencil(coupling.loop, column));
      }
    }
  fields::BlockMatrix matrix(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (!couplings[i * n + j].empty()) matrix(i, j) = make_matrix(layouts[i], layouts[j], couplings[i * n + j]);
  return matrix;
}

void Structure::zero_prescribed(const Rows& rows) const {
  for (std::size_t b = 0; b < rows.size(); ++b) {
    const auto mask = constraints[b].mask();
    const auto row = rows[b];
    Kokkos::parallel_for(
        "prescribed", Kokkos::RangePolicy<Execution>(0, mask.extent(0)), KOKKOS_LAMBDA(int i) {
          if (mask(i)) row(i) = 0;
        });
  }
}

void Structure::prescribe(const Rows& x) const {
  for (std::size_t b = 0; b < x.size(); ++b) {
    const auto mask = constraints[b].mask();
    const auto value = constraints[b].values();
    const auto unknown = x[b];
    Kokkos::parallel_for(
        "prescribed", Kokkos::RangePolicy<Execution>(0, mask.extent(0)), KOKKOS_LAMBDA(int i) {
          if (mask(i)) unknown(i) = value(i);
        });
  }
}

}  // namespace sprekk::assembly
