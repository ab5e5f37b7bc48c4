// Construction: from declarations to blocks, sparsity, ghosts and constant operators.
#include "assembly/system.hpp"

#include "assembly/order_one.hpp"
#include "assembly/rate_errors.hpp"
#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "fields/without_zeros.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::assembly {

using fields::BlockMatrix;
using fields::BlockVector;
using fields::Entity;
using fields::MultiVector;

namespace {

/// Removes zero entries from off-diagonal blocks that only linear modules write, since these blocks never change.
/// Diagonal blocks keep their zeros, so that the unknowns of a node stay together.
void drop_zeros(BlockMatrix& linear, BlockMatrix& all) {
  for (int i = 0; i < all.n_blocks(); ++i)
    for (int j = 0; j < all.n_blocks(); ++j)
      if (const auto A = linear(i, j); i != j && !A.is_null() && all(i, j) == A)
        all(i, j) = linear(i, j) = fields::without_zeros(A);
}

}  // namespace

int Context::field(const std::string& name) const {
  for (std::size_t f = 0; f < layouts_->size(); ++f)
    if ((*layouts_)[f].field().name == name) return static_cast<int>(f);
  throw Error(fmt::format("no module declares the field \"{}\"", name));
}

System::System(RCP<const mesh::Mesh> mesh, std::vector<std::unique_ptr<Module>> modules,
               const std::vector<DirichletCondition>& conditions, RCP<base::Timers> timers, Rates::Scheme scheme)
    : mesh_(mesh),
      geometry_(*mesh),
      stencils_(std::make_shared<Stencils>(mesh, layouts_)),
      timers_(timers),
      scheme_(scheme),
      extent_(mesh::largest_extent(*mesh)) {
  const auto scope = timers_->scope("set-up");
  for (auto& module : modules) modules_.emplace_back(std::move(module));
  declare_fields();
  declare_groups();
  for (std::size_t b = 0; b < layouts_.size(); ++b)
    constraints_.emplace_back(*mesh_, layouts_[b], conditions_on(b, conditions));
  bind_modules();
  declare_gains();
  find_exchanges();
  create_matrices();
  assemble_linear();
  {
    const auto scope_of_structure = timers_->scope("structure of the matrices");
    drop_zeros(linear_, matrix_);
  }
  stencils_->forget_writers();
  set_merit_weights();
  watch_contact();
}

std::vector<DirichletCondition> System::conditions_on(std::size_t block,
                                                      const std::vector<DirichletCondition>& conditions) const {
  const auto& enriched = unknowns_[block].enriches;
  std::vector<DirichletCondition> own;
  for (const auto& condition : conditions) {
    if (condition.field == layouts_[block].field().name) own.push_back(condition);
    if (condition.field != enriched) continue;
    own.push_back(condition);
    for (auto& value : own.back().values)
      if (value) value = base::Expression(0);
  }
  return own;
}

namespace {

/// Throws an Error unless the names are distinct and valid as names of file groups.
void check_names(std::vector<std::string> names, const char* what) {
  for (const auto& name : names)
    SPREKK_CHECK(!name.empty() && name.find('/') == name.npos,
                 "modules declare the {} \"{}\": a name must not be empty or contain \"/\"", what, name);
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  SPREKK_CHECK(twice == names.end(), "modules declare the {} \"{}\" twice", what, *twice);
}

/// Returns the positions of this rank's owned nodes or facets (mean of the corners), [entity, component]. Collective.
RCP<MultiVector> owned_coordinates(const mesh::Mesh& mesh, const fields::Layout& layout) {
  const bool on_facets = layout.field().entity == Entity::facet;
  const auto& all = on_facets ? mesh.facets->id : mesh.node_id;
  const std::vector<GlobalIndex> ids(all.begin(), all.begin() + layout.n_owned_entities());
  auto coordinates = rcp(new MultiVector(fields::make_map(ids, mesh.comm), mesh.dim()));
  auto view = coordinates->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LocalIndex n = 0; n < layout.n_owned_entities() && !on_facets; ++n)
    for (int i = 0; i < mesh.dim(); ++i) view(n, i) = mesh.coordinates[n * mesh.dim() + i];
  const int n_faces = mesh::n_faces(mesh.shape);
  for (LocalIndex face = 0; face < mesh.n_owned_cells * n_faces && on_facets; ++face)
    if (const LocalIndex facet = mesh.facets->of_cell[face]; facet < layout.n_owned_entities()) {
      const auto x = mesh::face_centre(mesh::face_corners(mesh, face / n_faces, face % n_faces));
      for (int i = 0; i < mesh.dim(); ++i) view(facet, i) = x[i];
    }
  const int n_ridges = mesh::n_face_corners(mesh.shape);
  for (LocalIndex ridge = 0; ridge < mesh.n_owned_fracture_faces * n_ridges && on_facets; ++ridge)
    if (const LocalIndex facet = mesh.facets->ridge[ridge]; facet < layout.n_owned_entities()) {
      const auto x = mesh::ridge_centre(mesh, ridge / n_ridges, ridge % n_ridges);
      for (int i = 0; i < mesh.dim(); ++i) view(facet, i) = x[i];
    }
  return coordinates;
}

/// Returns translations and rotations [unknown, mode] for positions [entity, dim]. The rotations are about a point that
/// is not a node. A node at the centre would give an aggregate of this node a zero column. Collective.
RCP<MultiVector> rigid_body_modes(const RCP<const fields::Map>& map, const MultiVector& coordinates) {
  const int dim = static_cast<int>(coordinates.getNumVectors()), n_rotations = dim == 2 ? 1 : 3;
  Teuchos::Array<Real> centre(dim);
  coordinates.meanValue(centre());
  for (int i = 0; i < dim; ++i) centre[i] += 0.0123456789 * (1 + 0.37 * i) * (1 + std::abs(centre[i]));
  auto modes = rcp(new MultiVector(map, dim + n_rotations));
  const auto X = coordinates.getLocalViewHost(Tpetra::Access::ReadOnly);
  auto view = modes->getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t n = 0; n < X.extent(0); ++n) {
    for (int i = 0; i < dim; ++i) view(n * dim + i, i) = 1;
    for (int k = 0; k < n_rotations; ++k) {  // rotation in the plane of axes a, b
      const int a = dim == 2 ? 0 : (k + 1) % 3, b = dim == 2 ? 1 : (k + 2) % 3;
      view(n * dim + a, dim + k) = -(X(n, b) - centre[b]);
      view(n * dim + b, dim + k) = X(n, a) - centre[a];
    }
  }
  return modes;
}

}  // namespace

System::~System() = default;

void System::declare_fields() {
  std::set<std::string> names;
  for (const auto& module : modules_)
    for (const auto& unknown : module->declare(*mesh_).unknowns) names.insert(unknown.field.name);
  for (auto& module : modules_) {
    module->set_fields(names);
    module.declaration = module->declare(*mesh_);
    for (const auto& unknown : module.declaration.unknowns) unknowns_.push_back(unknown);
  }
  std::vector<std::string> fields, histories;
  for (const auto& unknown : unknowns_) fields.push_back(unknown.field.name);
  for (const auto& module : modules_)
    for (const auto& history : module.declaration.history) histories.push_back(module.history_name(history));
  check_names(fields, "field");
  check_names(histories, "history");
  for (const auto& unknown : unknowns_) layouts_.emplace_back(unknown.field, *mesh_);
  for (std::size_t b = 0; b < unknowns_.size(); ++b) {
    const auto& layout = layouts_[b];
    fields::Block block{layout.field().name, layout.owned(), layout.field().n_components, 1, 1, {}, {}};
    block.enriches = unknowns_[b].enriches;
    block.condensed_into = unknowns_[b].condensed_into;
    block.balance = unknowns_[b].balance;
    if (unknowns_[b].near_null_space != NearNullSpace::none) set_multigrid(unknowns_[b], layout, block);
    blocks_.push_back(block);
    ghosted_.push_back(rcp(new fields::Vector(layout.ghosted())));
    weights_.push_back(rcp(new fields::Vector(layout.owned())));
    diagonals_.push_back(rcp(new fields::Vector(layout.owned())));
    schur_.push_back(Teuchos::null);
    load_.push_back(rcp(new fields::Vector(layout.owned())));
  }
  for (const auto& module : modules_)
    for (const auto& name : module.declaration.schur)
      if (auto& schur = schur_[context().field(name)]; schur.is_null())
        schur = rcp(new fields::Vector(layouts_[context().field(name)].owned()));
  coupled_ = couples_balances();
  carried_.assign(unknowns_.size(), 0);
  for (const auto& module : modules_)
    for (const auto& name : module.declaration.carries) {
      carried_[context().field(name)] = 1;
      blocks_[context().field(name)].advected = true;
    }
  changing_ = std::any_of(unknowns_.begin(), unknowns_.end(), [](const auto& unknown) { return unknown.balance; });
  for (std::size_t b = 0; b < unknowns_.size(); ++b)
    if (!unknowns_[b].augmented_by.empty()) contact_blocks_.traction = static_cast<int>(b);
  declare_scales();
}

void System::declare_scales() {
  for (const auto& module : modules_) {
    const auto& declaration = module.declaration;
    for (const auto& [name, least] : declaration.scales) scales_[name] = std::max(scales_[name], least);
    relations_.insert(relations_.end(), declaration.relations.begin(), declaration.relations.end());
    for (const auto& [field, term] : declaration.sizes) unknowns_[context().field(field)].row.push_back(term);
  }
  const auto check = [&](const std::string& name) {
    SPREKK_CHECK(scales_.count(name), "no module declares the scale \"{}\"", name);
  };
  for (const auto& relation : relations_) {
    check(relation.larger);
    check(relation.than);
  }
  for (const auto& unknown : unknowns_) {
    check(unknown.scale);
    if (!unknown.augmented_by.empty()) check(unknown.augmented_by);
    for (const auto& term : unknown.row) check(term.scale);
  }
}

bool System::couples_balances() const {
  const auto is_balance = [&](const std::string& name) { return unknowns_[context().field(name)].balance; };
  for (const auto& module : modules_)
    for (const auto& coupling : module.declaration.couplings)
      for (const auto& column : coupling.columns)
        if (is_balance(coupling.row) != is_balance(column)) return true;
  return false;
}

void System::set_multigrid(const Unknown& unknown, const fields::Layout& layout, fields::Block& block) const {
  block.coordinates = owned_coordinates(*mesh_, layout);
  if (unknown.near_null_space == NearNullSpace::constants) return;  // default of multigrid
  if (mesh::order(mesh_->shape) == 2) {
    block.interpolation = interpolation_from_corners(*mesh_, layout);
    block.coordinates = at_corners(*mesh_, *block.coordinates);
  }
  const auto map = block.interpolation.is_null() ? layout.owned() : block.interpolation->getDomainMap();
  block.near_null_space = {static_cast<int>(contact::rigid_modes(mesh_->dim()).size()),
                           [map, places = block.coordinates] { return rigid_body_modes(map, *places); }};
}

void System::declare_groups() {
  for (int b = 0; b < static_cast<int>(unknowns_.size()); ++b) {
    const auto& name = unknowns_[b].local_group;
    if (name.empty()) continue;
    const auto same = [&](const fields::LocalGroup& group) { return group.name == name; };
    auto found = std::find_if(groups_.begin(), groups_.end(), same);
    if (found == groups_.end()) found = groups_.insert(groups_.end(), {name, {}});
    found->blocks.push_back(b);
  }
}

BlockMatrix System::create_matrix() const {
  const auto context = this->context();
  const int n = static_cast<int>(blocks_.size());
  std::vector<std::vector<std::pair<Stencil, Stencil>>> couplings(n * n);
  for (const auto& module : modules_)
    for (const auto& coupling : module.declaration.couplings) {
      const int row = context.field(coupling.row);
      for (const auto& name : coupling.columns) {
        const int column = context.field(name);
        couplings[row * n + column].emplace_back(context.stencil(coupling.loop, row),
                                                 context.stencil(coupling.loop, column));
      }
    }
  BlockMatrix matrix(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (!couplings[i * n + j].empty()) matrix(i, j) = make_matrix(layouts_[i], layouts_[j], couplings[i * n + j]);
  return matrix;
}

void System::create_matrices() {
  const auto scope = timers_->scope("structure of the matrices");
  const auto context = this->context();
  const int n = static_cast<int>(blocks_.size());
  std::vector<char> linear(n * n, 0), nonlinear(n * n, 0);
  for (const auto& module : modules_)
    for (const auto& coupling : module.declaration.couplings)
      for (const auto& column : coupling.columns)
        (module.declaration.linear ? linear : nonlinear)[context.field(coupling.row) * n + context.field(column)] = 1;
  linear_ = create_matrix();
  matrix_ = linear_;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (!nonlinear[i * n + j]) continue;
      if (linear[i * n + j])
        matrix_(i, j) = rcp(new fields::CrsMatrix(*linear_(i, j), Teuchos::Copy));
      else
        linear_(i, j) = Teuchos::null;
    }
}

void System::bind_modules() {
  const auto context = this->context();
  for (auto& module : modules_) {
    base::collectively(*comm(), [&] { module->bind(context); });
    for (const auto& h : module.declaration.history)
      module.history.emplace_back(h.name, fields::n_entities(*mesh_, h.entity, false), h.n_components);
    if (module.initial_values) module.initial_values->initial_history(module.history);
  }
}

/// Allocates the storage increases of balances.
void System::declare_gains() {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto& field = layouts_[b].field();
    const bool stored = keeps_gains() && unknowns_[b].balance;
    gains_.emplace_back("gain", stored ? fields::n_entities(*mesh_, field.entity, false) : 0, field.n_components);
  }
}

void System::find_exchanges() {
  const auto context = this->context();
  std::vector<int> here(blocks_.size(), 0);
  for (const auto& module : modules_)
    for (const auto& coupling : module.declaration.couplings)
      for (const auto& name : coupling.columns) {
        const int f = context.field(name);
        const auto first = context.stencil(coupling.loop, f).first;
        const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), first);
        for (std::size_t e = 0; e < host.extent(0); ++e)
          for (std::size_t g = 0; g < host.extent(1); ++g) here[f] |= host(e, g) >= layouts_[f].n_owned();
      }
  const auto anywhere = base::max_over_ranks(*comm(), here);
  needs_ghosts_.assign(anywhere.begin(), anywhere.end());
}

void System::assemble_linear() {
  const auto scope = timers_->scope("assembly of the linear part");
  for (const auto& module : modules_)
    if (module.declaration.linear) module->jacobian(state(module), linear_);
}

/// Sets the matrix to the linear part. The Jacobians of the other modules are added to it.
void System::start_matrix() {
  for (int i = 0; i < matrix_.n_blocks(); ++i)
    for (int j = 0; j < matrix_.n_blocks(); ++j) {
      if (matrix_(i, j).is_null() || matrix_(i, j) == linear_(i, j)) continue;
      const auto values = matrix_(i, j)->getLocalMatrixDevice().values;
      if (linear_(i, j).is_null())
        Kokkos::deep_copy(values, 0.0);
      else
        Kokkos::deep_copy(values, linear_(i, j)->getLocalMatrixDevice().values);
    }
}

/// Shares storage between J and a constant diagonal block. Blocks of balances are excluded: they depend on the step and
/// are measured again in each step.
std::shared_ptr<fields::KeptRows> System::share(int block, const RCP<const fields::Matrix>& J) {
  if (auto kept = linear_.kept(block)) {
    kept->restore(*J);
    return kept;
  }
  const auto& A = linear_(block, block);
  const bool constant = !A.is_null() && matrix_(block, block) == A && !unknowns_[block].balance;
  if (!constant) return nullptr;
  const auto kept = std::make_shared<fields::KeptRows>(J);
  linear_.share(block, kept);
  matrix_.share(block, kept);
  return kept;
}

/// Assembles balances at x = 0 without storage. Their diagonals are the conductances of the rows, also for balances
/// without linear modules.
void System::assemble_balances() {
  const auto context = this->context();
  start_matrix();
  for (const auto& module : modules_) {
    const auto& couplings = module.declaration.couplings;
    const bool balances = std::any_of(couplings.begin(), couplings.end(), [&](const auto& coupling) {
      return unknowns_[context.field(coupling.row)].balance;
    });
    if (module.declaration.linear || !balances) continue;
    auto at_rest = state(module);
    at_rest.rate = 0;
    module->jacobian(at_rest, matrix_);
  }
}

void System::set_merit_weights() {
  const auto views = rows(weights_);
  for (const auto& module : modules_)
    if (module.weights) module.weights->merit_weights(views);
  assemble_balances();
  for (int b = 0; b < static_cast<int>(blocks_.size()); ++b) {
    const auto& A = unknowns_[b].balance ? matrix_(b, b) : linear_(b, b);
    if (A.is_null()) continue;
    A->getLocalDiagCopy(*diagonals_[b]);
    if (weights_[b]->normInf() > 0) continue;
    if (!unknowns_[b].balance) {
      weights_[b] = Teuchos::null;
      continue;
    }
    Tpetra::deep_copy(*weights_[b], *diagonals_[b]);
    auto w = weights_[b]->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < w.extent(0); ++i) w(i, 0) = w(i, 0) != 0 ? 1 / std::abs(w(i, 0)) : 0;
  }
}

/// Returns the owned displacement unknowns that conditions and modules support.
std::vector<contact::Support> System::supports_of(int displacement) const {
  auto all = constraints_[displacement].supports();
  const auto n_owned = static_cast<LocalIndex>(base::n_local_elements(*layouts_[displacement].owned()));
  for (const auto& module : modules_) {
    if (!module.supporting) continue;
    for (const auto& support : module.supporting->supports().value_or(std::vector<contact::Support>()))
      if (support.unknown < n_owned) all.push_back(support);
  }
  return all;
}

void System::watch_contact() {
  const bool held = std::any_of(modules_.begin(), modules_.end(),
                                [](const auto& m) { return m.holds_bodies() && !m.supporting->supports(); });
  int& displacement = contact_blocks_.displacement;
  for (int b = 0; b < static_cast<int>(blocks_.size()) && !held; ++b)
    if (unknowns_[b].near_null_space == NearNullSpace::rigid_motions) displacement = b;
  std::unique_ptr<contact::LoosePieces> pieces;
  if (displacement >= 0)
    pieces = std::make_unique<contact::LoosePieces>(mesh_, layouts_[displacement], supports_of(displacement),
                                                    cell_volumes(*mesh_));
  const bool loose = pieces && pieces->possible();
  if (!loose && contact_blocks_.traction < 0) return;
  if (loose) pieces->set_stiffness(*diagonals_[displacement]);
  contact_ = std::make_unique<contact::Contact>(static_cast<contact::Equations&>(*this), mesh_, contact_blocks_,
                                                std::move(pieces));
  contact_->remember(initial());
  if (loose && contact_->pieces()->contrast() > 10 && linear_part_is_invariant())
    contact_->remove_rigid_motions(layouts_[displacement]);
}

fields::Globalisation& System::globalisation() { return contact_ ? *contact_ : BlockProblem::globalisation(); }

/// Returns whether the linear part is zero for rigid motions of pieces. Collective.
bool System::linear_part_is_invariant() const {
  fields::Vector motion(layouts_[contact_blocks_.displacement].ghosted());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto& A = linear_(static_cast<int>(b), contact_blocks_.displacement);
    if (A.is_null()) continue;
    fields::Vector rows(blocks_[b].map);
    for (int mode : contact::rigid_modes(mesh_->dim())) {
      contact_->pieces()->set_rigid(mode, motion);
      A->localApply(motion, rows, Teuchos::NO_TRANS, 1.0, 0.0);
      if (!(rows.normInf() <= 1e-12 * A->getFrobeniusNorm())) return false;
    }
  }
  return true;
}

BlockVector System::initial() const {
  BlockVector x;
  for (const auto& block : blocks_) x.push_back(rcp(new fields::Vector(block.map)));
  const auto views = rows(x);
  for (const auto& module : modules_)
    if (module.initial_values) module.initial_values->initial(views);
  return x;
}

std::vector<std::pair<fields::Field, View<Real**>>> System::histories(bool rates) const {
  std::vector<std::pair<fields::Field, View<Real**>>> all;
  for (const auto& module : modules_)
    for (std::size_t h = 0; h < module.history.size(); ++h)
      all.emplace_back(module.history_field(module.declaration.history[h]), module.history[h]);
  for (std::size_t b = 0; b < gains_.size(); ++b) {
    const auto& field = layouts_[b].field();
    if (gains_[b].extent(0) > 0)
      all.push_back({{"gain of " + field.name, field.entity, field.n_components, ""}, gains_[b]});
  }
  if (rate_errors_ && rates)
    for (auto& rate : rate_errors_->histories()) all.push_back(std::move(rate));
  return all;
}

std::vector<std::pair<fields::Field, View<Real**>>> System::passed_on(const BlockVector& x) {
  refresh_ghosts(x, false);
  std::vector<std::pair<fields::Field, View<Real**>>> all;
  for (const auto& module : modules_) {
    std::vector<std::pair<History, View<Real**>>> histories;
    if (module.transfer) module.transfer->pass_on(state(module), histories);
    for (const auto& [history, values] : histories) all.emplace_back(module.history_field(history), values);
  }
  return all;
}

void System::prescribe(Real t, BlockVector& x) {
  const auto views = rows(x);
  for (std::size_t b = 0; b < constraints_.size(); ++b) {
    base::collectively(*comm(), [&] { constraints_[b].evaluate(t); });
    const auto mask = constraints_[b].mask();
    const auto value = constraints_[b].values();
    const auto unknown = views[b];
    Kokkos::parallel_for(
        "prescribed", Kokkos::RangePolicy<Execution>(0, mask.extent(0)), KOKKOS_LAMBDA(int i) {
          if (mask(i)) unknown(i) = value(i);
        });
  }
}

void System::take_over(const BlockVector& x) {
  refresh_ghosts(x, false);
  for (const auto& module : modules_) {
    if (!module.transfer) continue;
    auto s = state(module);
    module.transfer->take_over(s);
  }
}

void System::resume(const BlockVector& x, const Memory& memory) {
  const auto take_scales = [&] {
    for (auto& [name, scale] : scales_) {
      const auto kept = memory.scales.find(name);
      SPREKK_CHECK(kept != memory.scales.end(), "the scale \"{}\" is missing in the stored state", name);
      scale = kept->second;
    }
  };
  take_scales();
  committed_t_ = memory.t;
  committed_dt_ = memory.dt;
  set_time(memory.t, memory.dt);
  take_scales();    // excludes loads of a rejected step
  at_end_.clear();  // values of a rejected step or another run
  unbalanced_.clear();
  if (contact_) contact_->resume(x, memory.calibration);
  if (rate_errors_) resume_errors(x, memory.errors);
}

void System::tell_unbalanced(const BlockVector& x) {
  auto r = fields::create_like(x);
  residual(x, r);
  for (std::size_t b = 0; b < r.size(); ++b) {
    const auto mask = constraints_[b].mask();
    const auto row = r[b]->getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "prescribed", Kokkos::RangePolicy<Execution>(0, mask.extent(0)), KOKKOS_LAMBDA(int i) {
          if (mask(i)) row(i, 0) = 0;
        });
  }
  const auto views = rows(r);
  for (const auto& module : modules_) {
    if (!module.transfer) continue;
    auto s = state(module);
    module.transfer->take_unbalanced(s, views);
  }
}

System::Memory System::memory() const {
  std::vector<Real> errors = load_change_;
  if (rate_errors_)
    for (const Real number : rate_errors_->memory()) errors.push_back(number);
  return {committed_t_, committed_dt_, scales_, contact_ ? contact_->calibration() : std::vector<Real>(), errors};
}

}  // namespace sprekk::assembly
