#include "solve/preconditioner.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "base/text.hpp"
#include "multigrid/multigrid.hpp"
#include "solve/condensed_pair.hpp"
#include "solve/factor_cost.hpp"
#include "solve/fine_level.hpp"
#include "solve/reuse.hpp"
#include "solve/sweep.hpp"

namespace sprekk::solve {
namespace {

using fields::Operator;
using multigrid::Multigrid;
using Teuchos::ParameterList;

/// Smallest Chebyshev degree if enriching functions are smoothed as well.
constexpr int degree_with_enrichment = 6;

/// Multigrid on the nodes of a block. Blocks that enrich it take part in smoothing on the finest level.
class NodeMultigrid : public Preconditioner {
 public:
  NodeMultigrid(const MultigridOptions& options, const std::vector<Block>& blocks)
      : Preconditioner("multigrid", blocks.front().name) {
    const auto& first = blocks.front();
    const bool at_corners = first.n_components == 1 && !first.interpolation.is_null();
    const int dim = first.coordinates.is_null() ? 3 : dimension(first);
    options_ = at_corners ? options.of_corners(dim) : options.of_nodes(dim);
    for (std::size_t b = 1; b < blocks.size(); ++b) enriching_.push_back(blocks[b].name);
    if (!enriching_.empty()) options_.finest_degree = degree_with_enrichment;
  }

  RCP<const Operator> matrix() const override { return matrix_.matrix(); }
  bool has_cycles() const override { return true; }
  int coarse_size() const override { return options_.coarse_size; }
  void describe(ParameterList& blocks) const override {
    auto& list = blocks.sublist(block());
    list.set("type", "multigrid");
    list.sublist("multigrid")
        .set("degree", options_.degree, "of Chebyshev's polynomial")
        .set("coarsest level", options_.direct_limit(1), "unknowns at most, below the finest")
        .set("minimum per rank", options_.minimum_per_rank, "numbers of a matrix, on average");
    for (const auto& name : enriching_) blocks.sublist(name).set("with", block());
  }

 private:
  void prepare(const LinearSystem& system, SolverCost& cost) override {
    const auto& first = system.diagonal.front();
    matrix_.update(system);
    if (multigrid_.is_null() || first.is_other_graph || has_other_couplings(system)) make(system);
    multigrid_->setup(matrix_.matrix(), first.symmetric, first.careful);
    cost.operator_complexity = multigrid_->operator_complexity();
    cost.bytes = multigrid_->bytes();
    cost.cycle_bytes = multigrid_->cycle_bytes();
    cost.n_unknowns = multigrid_->n_unknowns();
    cost.n_ranks = multigrid_->n_ranks();
    const auto traffic = multigrid_->traffic();
    cost.messages = traffic.messages;
    cost.message_bytes = traffic.bytes;
  }
  bool renew(const LinearSystem& system) override {
    matrix_.update(system);
    return false;
  }
  RCP<const Operator> made() const override { return multigrid_; }

  void make(const LinearSystem& system) {
    const auto& first = system.diagonal.front();
    const int n = first.block.n_components;
    const auto modes = first.block.near_null_space.make();
    multigrid::Nodes nodes;
    look(system,
         [&](const auto& A) { nodes = multigrid::nodes_of(A, modes, first.block.coordinates, options_.strong); });
    weak_ = nodes.weak;
    nodes.add_smoothed(base::n_local_elements(*system.joined->map()) / n);
    multigrid_ = rcp(new Multigrid(matrix_.matrix(), std::move(nodes), n, modes, options_));
  }

  /// Returns whether more than a thousandth of the couplings changed between strong and weak. Nodes must then be
  /// grouped again. Collective.
  bool has_other_couplings(const LinearSystem& system) const {
    constexpr GlobalIndex few = 1000;
    const auto& comm = *system.joined->map()->getComm();
    if (!base::any_rank(comm, [&] { return !weak_.empty(); })) return false;
    bool result = false;
    look(system,
         [&](const auto& A) { result = differ(comm, weak_, multigrid::weak_couplings(A, options_.strong), few); });
    return result;
  }

  /// Calls use(matrix) with the matrix that determines the groups of nodes.
  template <class Use>
  static void look(const LinearSystem& system, const Use& use) {
    const auto& first = system.diagonal.front();
    const auto of = [&](const RCP<const Matrix>& bulk) {
      use(multigrid::node_matrix(*bulk, first.block.n_components));
    };
    first.bulk ? first.bulk(of) : of(first.matrix);
  }

  multigrid::Options options_;
  std::vector<std::string> enriching_;  // names of the enriching blocks
  WholeMatrix matrix_;
  RCP<Multigrid> multigrid_;
  std::vector<bool> weak_;  // weak couplings when nodes were grouped; empty: not relevant
};

/// Preconditioner with the factors of the matrix of a group.
class Direct : public Preconditioner {
 public:
  explicit Direct(const std::string& block) : Preconditioner("direct solver", block) {}
  void describe(ParameterList& blocks) const override { blocks.sublist(block()).set("type", "direct"); }

 private:
  void prepare(const LinearSystem& system, SolverCost&) override {
    matrix_.update(system);
    const int n_ranks = system.joined->map()->getComm()->getSize();
    if (direct_.is_null())
      direct_ = rcp(new multigrid::DirectInverse(matrix_.crs(), "its matrix", system.reproducible ? 1 : n_ranks));
    direct_->setup(system.symmetric);
  }
  RCP<const Operator> made() const override { return direct_; }

  WholeMatrix matrix_;
  RCP<multigrid::DirectInverse> direct_;
};

[[noreturn]] void fail(const std::string& block, const std::string& entry, const std::string& what) {
  throw Error(fmt::format("Sprekk > Solver > Blocks > {} > \"{}\": {}", block, entry, what));
}

std::string names_of(const std::vector<Block>& blocks) {
  std::vector<std::string> names;
  for (const auto& block : blocks) names.push_back(fmt::format("\"{}\"", block.name));
  return fmt::format("{}", fmt::join(names, ", "));
}

int place_of(const std::string& name, const std::vector<Block>& blocks) {
  const auto found = std::find_if(blocks.begin(), blocks.end(), [&](const Block& block) { return block.name == name; });
  return found == blocks.end() ? -1 : static_cast<int>(found - blocks.begin());
}

/// Returns the first block of the group of this block. Throws an Error for unknown names and cycles.
int first_of_group(const PreconditionerOptions& options, const std::vector<Block>& blocks, int member) {
  int block = member;
  for (std::size_t steps = 0; steps <= blocks.size(); ++steps) {
    const auto& [name, with] = std::pair(blocks[block].name, options.of(blocks[block].name).with);
    const auto& enriched = blocks[block].enriches.empty() ? blocks[block].condensed_into : blocks[block].enriches;
    const auto& to = with.empty() ? enriched : with;
    if (to.empty()) return block;
    const int next = place_of(to, blocks);
    if (next < 0) fail(name, "with", fmt::format("is \"{}\", must be one of {}", to, names_of(blocks)));
    block = next;
  }
  fail(blocks[member].name, "with", "leads in a circle");
}

/// Returns the blocks of each group, [group][member], first members first. Throws an Error for invalid options.
std::vector<std::vector<int>> groups_of(const PreconditionerOptions& options, const std::vector<Block>& blocks) {
  for (const auto& [name, of_block] : options.blocks)
    SPREKK_CHECK(place_of(name, blocks) >= 0,
                 "Sprekk > Solver > Blocks > \"{}\": no such block is left after elimination; there are {}", name,
                 names_of(blocks));
  std::vector<std::vector<int>> members(blocks.size());
  for (int b = 0; b < static_cast<int>(blocks.size()); ++b)
    if (const int first = first_of_group(options, blocks, b); first == b) {
      members[b].insert(members[b].begin(), b);
    } else {
      members[first].push_back(b);
      if (options.of(blocks[b].name).multigrid)
        fail(blocks[b].name, "multigrid",
             fmt::format("has no effect: the block is in the group of \"{}\"", blocks[first].name));
      if (options.of(blocks[b].name).type != "auto")
        fail(blocks[b].name, "type",
             fmt::format("cannot be chosen, for the block is in the group of \"{}\", whose type it takes",
                         blocks[first].name));
    }
  std::vector<std::vector<int>> groups;
  std::copy_if(members.begin(), members.end(), std::back_inserter(groups), [](const auto& g) { return !g.empty(); });
  return groups;
}

/// Returns the groups in the order of the sweep, by default those of rate balances before the others. Throws an Error
/// for an invalid order.
std::vector<std::vector<int>> in_order(const SweepOptions& options, const std::vector<Block>& blocks,
                                       std::vector<std::vector<int>> groups) {
  if (options.order.empty()) {
    std::stable_partition(groups.begin(), groups.end(), [&](const auto& g) { return blocks[g.front()].balance; });
    return groups;
  }
  std::vector<Block> first;
  for (const auto& group : groups) first.push_back(blocks[group.front()]);
  std::vector<std::vector<int>> ordered;
  for (const auto& name : options.order)
    if (const int g = place_of(name, first); g >= 0) ordered.push_back(groups[g]);
  const bool each_once = options.order.size() == groups.size() && ordered.size() == groups.size() &&
                         std::is_permutation(ordered.begin(), ordered.end(), groups.begin());
  SPREKK_CHECK(each_once, "Sprekk > Solver > Sweep > \"order\": is {}, must name each of {} once",
               fmt::join(options.order, ", "), names_of(first));
  return ordered;
}

/// Returns whether the second of two blocks is condensed into the first, which multigrid can solve.
bool is_condensed_pair(const std::vector<Block>& blocks) {
  return blocks.size() == 2 && blocks[1].condensed_into == blocks[0].name && !blocks[0].coordinates.is_null();
}

/// Returns whether all blocks except the first enrich it and have nodes of its size.
bool enrich_first(const std::vector<Block>& blocks) {
  return std::all_of(blocks.begin() + 1, blocks.end(), [&](const Block& block) {
    return block.enriches == blocks.front().name && block.n_components == blocks.front().n_components;
  });
}

/// Returns the options of a group, with the type "direct" in place of "auto" for a field on facets if factors are
/// cheaper than multigrid.
BlockOptions chosen_by_cost(BlockOptions options, const std::vector<Block>& blocks, bool alone) {
  const auto& first = blocks.front();
  const bool on_facets = first.n_components == 1 && !first.interpolation.is_null() && !first.coordinates.is_null();
  if (options.type != "auto" || options.multigrid || !on_facets || takes_flow_order(options, first)) return options;
  if (blocks.size() > 1 && !is_condensed_pair(blocks)) return options;
  const FacetMatrix matrix{.n_unknowns = static_cast<Real>(first.map->getGlobalNumElements()),
                           .dim = dimension(first),
                           .alone = alone,
                           .n_ranks = first.map->getComm()->getSize()};
  if (factors_are_cheaper(matrix)) options.type = "direct";
  return options;
}

std::unique_ptr<Preconditioner> make_group(const PreconditionerOptions& all, const std::vector<Block>& blocks,
                                           bool by_cost, bool alone) {
  const auto& first = blocks.front();
  const auto options = by_cost ? chosen_by_cost(all.of(first.name), blocks, alone) : all.of(first.name);
  if (all.of(first.name).type == "direct" || (options.type == "direct" && !is_condensed_pair(blocks)))
    return make_direct(blocks);
  if (options.type == "Ifpack2") return make_ifpack2(options.ifpack2, blocks);
  if (options.type == "Gauss-Seidel") return make_gauss_seidel(blocks);
  if (options.type == "ILU" && !is_condensed_pair(blocks)) return make_advected(first.name);
  if (!first.coordinates.is_null() && enrich_first(blocks)) return make_cycle(options, blocks);
  if (is_condensed_pair(blocks)) return std::make_unique<CondensedPair>(options, blocks);
  if (options.type == "MueLu") return make_muelu(options.muelu, blocks);
  if (options.type == "multigrid")
    fail(first.name, "type",
         "multigrid requires blocks of unknowns with coordinates, and blocks in their groups; MueLu, Ifpack2, "
         "Gauss-Seidel, ILU and direct do not");
  if (options.multigrid)
    fail(first.name, "multigrid", "has no effect: the unknowns of the block have no coordinates, or it is in a group");
  return blocks.size() == 1 ? make_gauss_seidel(blocks) : make_direct(blocks);
}

}  // namespace

Preconditioner::Preconditioner(const std::string& method, const std::string& block)
    : block_(block), cost_(std::make_shared<SolverCost>()) {
  cost_->name = fmt::format("{} of '{}'", method, block);
}

void Preconditioner::setup(const LinearSystem& system, bool keeps) {
  bool done = true;
  const auto work = [&] { keeps ? static_cast<void>(done = renew(system)) : prepare(system, *cost_); };
  try {
    timed(cost_->setup_seconds, [&] { base::collectively(*system.joined->map()->getComm(), work); });
  } catch (const Error& error) {
    const std::string text = error.what(), mine = "preconditioner of block '";
    if (dynamic_cast<const RefusedList*>(&error) || text.rfind(mine, 0) == 0) throw;  // from a part
    if (!given_list().empty())
      throw RefusedList(
          fmt::format("Sprekk > Solver > Blocks > {} > {}: the library cannot be set up with these "
                      "parameters: {}",
                      block_, given_list(), gist(text)));
    throw Error(fmt::format("{}{}': {}", mine, block_, gist(text)));
  }
  cost_->n_setups += done;
}

RCP<const Operator> Preconditioner::counted(const RCP<const Operator>& inverse) const {
  return rcp(new CountedOperator(inverse, cost_));
}

LinearSystem alone(const DiagonalBlock& block) {
  return {std::make_shared<Joined>(std::vector{block.matrix->row_map()}), {block.matrix}, block.symmetric, {block}, {}};
}

void WholeMatrix::update(const LinearSystem& system) {
  SPREKK_CHECK(!system.blocks.front().is_null(), "it has no matrix of its own; solve directly");
  if (system.joined->n_blocks() == 1) {
    matrix_ = system.blocks.front();
    return;
  }
  if (!joined_) joined_ = std::make_unique<JoinedMatrix>(system.joined, system.blocks);
  joined_->update();
  matrix_ = joined_->matrix();
}

std::unique_ptr<Preconditioner> make_preconditioner(const PreconditionerOptions& options,
                                                    const std::vector<Block>& blocks, bool by_cost) {
  const auto groups = in_order(options.sweep, blocks, groups_of(options, blocks));
  std::vector<std::unique_ptr<Preconditioner>> parts;
  for (const auto& group : groups) {
    std::vector<Block> members;
    for (const int b : group) members.push_back(blocks[b]);
    parts.push_back(make_group(options, members, by_cost, groups.size() == 1));
  }
  const bool whole = groups.size() == 1 && std::is_sorted(groups.front().begin(), groups.front().end());
  if (whole) return std::move(parts.front());
  return std::make_unique<Sweep>(options.sweep, blocks, groups, std::move(parts));
}

int dimension(const Block& block) { return static_cast<int>(block.coordinates->getNumVectors()); }

bool takes_muelu(const BlockOptions& options, const Block& block) {
  const int n_modes = block.near_null_space.n() > 0 ? block.near_null_space.n() : block.n_components;
  const bool own = Multigrid::can_solve(block.n_components, n_modes);
  if (options.type == "MueLu" || (options.type == "auto" && !own)) return true;
  if (!own)
    fail(block.name, "type",
         fmt::format("multigrid is not for {} unknowns of a node and {} motions; MueLu is", block.n_components,
                     n_modes));
  return false;
}

bool takes_flow_order(const BlockOptions& options, const Block& first) {
  return options.type == "ILU" || (options.type == "auto" && first.advected && !options.multigrid);
}

std::unique_ptr<Preconditioner> make_multigrid(const BlockOptions& options, const std::vector<Block>& blocks) {
  if (takes_muelu(options, blocks.front())) return make_muelu(options.muelu, blocks);
  return std::make_unique<NodeMultigrid>(options.multigrid.value_or(MultigridOptions()), blocks);
}

std::unique_ptr<Preconditioner> make_cycle(const BlockOptions& options, const std::vector<Block>& blocks) {
  const auto& first = blocks.front();
  if (options.type == "direct") return make_direct(blocks);
  if (options.type == "ILU") return make_advected(first.name);
  if (needs_fine_level(options, blocks)) return std::make_unique<FineLevel>(options, blocks);
  return make_multigrid(options, blocks);
}

std::unique_ptr<Preconditioner> make_direct(const std::vector<Block>& blocks) {
  return std::make_unique<Direct>(blocks.front().name);
}

void add_to_diagonal(CrsMatrix& A, const Vector& added) {
  const auto local = A.getLocalMatrixHost();
  const auto rows = A.getRowMap()->getLocalMap(), columns = A.getColMap()->getLocalMap();
  const auto values = added.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LocalIndex row = 0; row < local.numRows(); ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
      if (columns.getGlobalElement(local.graph.entries(k)) == rows.getGlobalElement(row))
        local.values(k) += values(row, 0);
}

/// Returns the last paragraph of an exception's text: the cause, without source location.
std::string gist(const std::string& text) {
  const auto end = text.find_last_not_of('\n') + 1, gap = text.rfind("\n\n", end - 1), first = text.find("\n\n");
  if (gap == std::string::npos) return text.substr(0, end);
  const bool with_place = text[first - 1] == ':';
  std::string words = with_place ? text.substr(gap + 2, end - gap - 2) : text.substr(0, first);
  std::replace(words.begin(), words.end(), '\n', ' ');
  return words;
}

void check_names(const std::string& place, const ParameterList& given, const std::vector<ParameterList>& allowed) {
  constexpr std::size_t max_listed = 40;
  std::set<std::string> names;
  for (const auto& list : allowed)
    for (const auto& item : list) names.insert(item.first);
  const std::vector<std::string> known(names.begin(), names.end());
  for (const auto& item : given) {
    if (names.count(item.first) > 0) continue;
    const auto all = known.size() > max_listed ? "" : "; there are " + base::quoted_list(known);
    auto meant = base::did_you_mean(item.first, known);
    if (all.empty() && meant.empty()) meant = "; see the manual of the library for its parameters";
    throw RefusedList(fmt::format("{} > \"{}\": no such parameter{}{}", place, item.first, all, meant));
  }
}

}  // namespace sprekk::solve
