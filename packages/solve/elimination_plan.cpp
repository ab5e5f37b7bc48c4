#include "solve/elimination_plan.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>

#include "base/check.hpp"
#include "solve/small_lu.hpp"

namespace sprekk::solve {

View<LocalIndex*> to_device(const LocalIndices& from, const std::string& name) {
  View<LocalIndex*> to(name, from.size());
  Kokkos::deep_copy(to,
                    Kokkos::View<const LocalIndex*, Kokkos::LayoutRight, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(
                        from.data(), from.size()));
  return to;
}

namespace {

using GlobalIndices = std::vector<GlobalIndex>;
using IndexVector = Tpetra::Vector<GlobalIndex, LocalIndex, GlobalIndex>;

const GlobalIndex count_them = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();

RCP<const Map> make_map(const GlobalIndices& indices, const RCP<const Comm>& comm) {
  return rcp(new Map(count_them, Teuchos::arrayView(indices.data(), indices.size()), 0, comm));
}

RCP<const Map> make_contiguous_map(std::size_t n_owned, const RCP<const Comm>& comm) {
  return rcp(new Map(count_them, n_owned, 0, comm));
}

/// Calls visit(row, position of the value, global column) for the stored entries owned here.
template <class Visit>
void for_entries(const CrsMatrix& matrix, const Visit& visit) {
  const auto graph = matrix.getLocalMatrixHost().graph;
  const auto& columns = *matrix.getColMap();
  for (LocalIndex row = 0, n_rows = graph.numRows(); row < n_rows; ++row)
    for (auto k = graph.row_map(row); k < graph.row_map(row + 1); ++k)
      visit(row, static_cast<LocalIndex>(k), columns.getGlobalElement(graph.entries(k)));
}

LocalIndex position_in(const GlobalIndices& sorted, LocalIndex begin, LocalIndex end, GlobalIndex wanted) {
  return std::lower_bound(sorted.begin() + begin, sorted.begin() + end, wanted) - sorted.begin();
}

/// Global columns of rows or entities, each sorted and without repetition, one after the other.
struct ColumnSets {
  LocalIndices start{0};
  GlobalIndices column;

  explicit ColumnSets(std::vector<GlobalIndices>& sets) {
    for (auto& set : sets) {
      std::sort(set.begin(), set.end());
      column.insert(column.end(), set.begin(), std::unique(set.begin(), set.end()));
      start.push_back(column.size());
    }
  }
};

class Planner {
 public:
  explicit Planner(const BlockProblem& problem) : problem_(problem), comm_(problem.comm()) {}

  EliminationPlan plan() {
    const auto& groups = problem_.local_groups();
    group_of_.assign(blocks().size(), -1);
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (int z : groups[g].blocks) group_of_[z] = g;
    for (std::size_t b = 0; b < blocks().size(); ++b)
      if (group_of_[b] < 0) plan_.remaining.push_back(b);
    check_groups_do_not_couple();
    for (const auto& group : groups) plan_group(group);
    plan_condensed(problem_, plan_);
    return std::move(plan_);
  }

 private:
  const std::vector<Block>& blocks() const { return problem_.blocks(); }
  RCP<const CrsMatrix> matrix(int i, int j) const { return problem_.matrix()(i, j); }

  void check_groups_do_not_couple() const {
    for (std::size_t i = 0; i < blocks().size(); ++i)
      for (std::size_t j = 0; j < blocks().size(); ++j)
        SPREKK_CHECK(group_of_[i] < 0 || group_of_[j] < 0 || group_of_[i] == group_of_[j] || matrix(i, j).is_null(),
                     "blocks '{}' and '{}' couple, but are in different local groups; put them into one",
                     blocks()[i].name, blocks()[j].name);
  }

  void plan_group(const fields::LocalGroup& from) {
    plan_.groups.emplace_back();
    GroupPlan& group = plan_.groups.back();
    group.name = from.name;
    group.blocks = from.blocks;
    for (int z : group.blocks) {
      group.offset.push_back(group.size);
      group.size += blocks()[z].n_components;
    }
    SPREKK_CHECK(group.size <= max_small_size, "local group '{}' has {} unknowns per entity; at most {} are allowed",
                 group.name, group.size, max_small_size);
    find_entities(group);
    plan_dense(group);
    for (int b : plan_.remaining) plan_response(group, b);
    for (int a : plan_.remaining) plan_coupling(group, a);
  }

  /// The owned entities, and the ghosts that owned rows of the remaining blocks couple to.
  void find_entities(GroupPlan& group) {
    GlobalIndices owned;
    base::collectively(*comm_, [&] {
      for (int z : group.blocks) {
        const int n = blocks()[z].n_components;
        const auto indices = blocks()[z].map->getNodeElementList();
        GlobalIndices entities;
        for (int i = 0; i < indices.size(); i += n) entities.push_back(indices[i] / n);
        SPREKK_CHECK(z == group.blocks[0] || entities == owned,
                     "local group '{}': block '{}' does not hold the same entities as the first block", group.name,
                     blocks()[z].name);
        owned = entities;
      }
    });
    group.entities = make_map(owned, comm_);
    GlobalIndices ghosts;
    for (int a : plan_.remaining)
      for (int z : group.blocks) {
        if (matrix(a, z).is_null()) continue;
        for (auto index : matrix(a, z)->getColMap()->getNodeElementList()) {
          const GlobalIndex entity = index / blocks()[z].n_components;
          if (!group.entities->isNodeGlobalElement(entity)) ghosts.push_back(entity);
        }
      }
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    ghosts_ = make_map(ghosts, comm_);
    import_entities_ = rcp(new Import(group.entities, ghosts_));
  }

  LocalIndex slot(const GroupPlan& group, GlobalIndex entity) const {
    const LocalIndex owned = group.entities->getLocalElement(entity);
    return owned >= 0 ? owned : n_owned(group) + ghosts_->getLocalElement(entity);
  }

  static LocalIndex n_owned(const GroupPlan& group) { return group.entities->getNodeNumElements(); }

  template <class Find>
  static Scatter make_scatter(const RCP<const CrsMatrix>& matrix, const Find& find) {
    LocalIndices target(matrix->getNodeNumEntries());
    for_entries(*matrix, [&](LocalIndex row, LocalIndex k, GlobalIndex column) { target[k] = find(row, column); });
    return {matrix, to_device(target, "scatter target")};
  }

  void plan_dense(GroupPlan& group) const {
    const int m = group.size;
    base::collectively(*comm_, [&] {
      for (std::size_t i = 0; i < group.blocks.size(); ++i)
        for (std::size_t j = 0; j < group.blocks.size(); ++j) {
          const int zi = group.blocks[i], zj = group.blocks[j];
          if (matrix(zi, zj).is_null()) continue;
          const int ni = blocks()[zi].n_components, nj = blocks()[zj].n_components;
          group.fill.push_back(make_scatter(matrix(zi, zj), [&](LocalIndex row, GlobalIndex column) {
            const LocalIndex entity = row / ni;
            SPREKK_CHECK(column / nj == group.entities->getGlobalElement(entity),
                         "local group '{}': entity {} couples to entity {} in block ('{}', '{}')", group.name,
                         group.entities->getGlobalElement(entity), column / nj, blocks()[zi].name, blocks()[zj].name);
            return (entity * m + group.offset[i] + row % ni) * m + group.offset[j] + LocalIndex(column % nj);
          }));
        }
    });
    group.dense = View<Real*>("group dense", n_owned(group) * m * m);
    group.lu = View<Real*>("group lu", n_owned(group) * m * m);
    group.pivot = View<int*>("group pivots", n_owned(group) * m);
    group.work = View<Real*>("group work", n_owned(group) * m);
    group.column_scale = View<Real*>("group column scale", m);
  }

  void plan_response(GroupPlan& group, int b) {
    const int m = group.size, n = n_owned(group);
    std::vector<GlobalIndices> sets(n);
    for (int z : group.blocks)
      if (!matrix(z, b).is_null())
        for_entries(*matrix(z, b), [&](LocalIndex row, LocalIndex, GlobalIndex column) {
          sets[row / blocks()[z].n_components].push_back(column);
        });
    const ColumnSets columns(sets);
    group.response.emplace_back();
    Response& response = group.response.back();
    for (std::size_t i = 0; i < group.blocks.size(); ++i) {
      const int z = group.blocks[i], nz = blocks()[z].n_components;
      if (matrix(z, b).is_null()) continue;
      response.fill.push_back(make_scatter(matrix(z, b), [&](LocalIndex row, GlobalIndex column) {
        const LocalIndex begin = columns.start[row / nz], end = columns.start[row / nz + 1];
        return m * begin + (group.offset[i] + row % nz) * (end - begin) +
               position_in(columns.column, begin, end, column) - begin;
      }));
    }
    exchange(group, columns, response);
  }

  /// Makes the ghosts' columns and the import of their values known. Columns, and with them values, are numbered over
  /// all ranks; ghosts learn the range of theirs.
  void exchange(const GroupPlan& group, const ColumnSets& columns, Response& response) const {
    const auto column_map = make_contiguous_map(columns.column.size(), comm_);
    const GlobalIndex first = columns.column.empty() ? 0 : column_map->getMinGlobalIndex();
    IndexVector begin(group.entities), end(group.entities), ghost_begin(ghosts_), ghost_end(ghosts_);
    for (LocalIndex e = 0; e < n_owned(group); ++e) {
      begin.replaceLocalValue(e, first + columns.start[e]);
      end.replaceLocalValue(e, first + columns.start[e + 1]);
    }
    ghost_begin.doImport(begin, *import_entities_, Tpetra::INSERT);
    ghost_end.doImport(end, *import_entities_, Tpetra::INSERT);

    LocalIndices start = columns.start;
    GlobalIndices ghost_columns, ghost_values;
    const auto begins = ghost_begin.getData(), ends = ghost_end.getData();
    for (LocalIndex g = 0; g < begins.size(); ++g) {
      for (auto c = begins[g]; c < ends[g]; ++c) ghost_columns.push_back(c);
      for (auto v = group.size * begins[g]; v < group.size * ends[g]; ++v) ghost_values.push_back(v);
      start.push_back(start.back() + ends[g] - begins[g]);
    }
    IndexVector owned(column_map), ghost(make_map(ghost_columns, comm_));
    for (std::size_t c = 0; c < columns.column.size(); ++c) owned.replaceLocalValue(c, columns.column[c]);
    ghost.doImport(owned, Import(column_map, ghost.getMap()), Tpetra::INSERT);

    response.column_start = to_device(start, "response column start");
    response.column = columns.column;
    const auto ghost_unknowns = ghost.getData();
    response.column.insert(response.column.end(), ghost_unknowns.begin(), ghost_unknowns.end());
    response.owned = rcp(new Vector(make_contiguous_map(columns.column.size() * group.size, comm_)));
    response.ghost = rcp(new Vector(make_map(ghost_values, comm_)));
    response.import = rcp(new Import(response.owned->getMap(), response.ghost->getMap()));
  }

  void plan_coupling(GroupPlan& group, int a) const {
    const int m = group.size;
    std::vector<GlobalIndices> sets(blocks()[a].map->getNodeNumElements());
    for (int z : group.blocks)
      if (!matrix(a, z).is_null())
        for_entries(*matrix(a, z), [&](LocalIndex row, LocalIndex, GlobalIndex column) {
          sets[row].push_back(slot(group, column / blocks()[z].n_components));
        });
    const ColumnSets slots(sets);
    group.coupling.emplace_back();
    Coupling& coupling = group.coupling.back();
    for (std::size_t i = 0; i < group.blocks.size(); ++i) {
      const int z = group.blocks[i], nz = blocks()[z].n_components;
      if (matrix(a, z).is_null()) continue;
      coupling.fill.push_back(make_scatter(matrix(a, z), [&](LocalIndex row, GlobalIndex column) {
        const LocalIndex pair =
            position_in(slots.column, slots.start[row], slots.start[row + 1], slot(group, column / nz));
        return pair * m + group.offset[i] + LocalIndex(column % nz);
      }));
    }
    coupling.row_start = to_device(slots.start, "coupling row start");
    coupling.slot = to_device(LocalIndices(slots.column.begin(), slots.column.end()), "coupling slot");
    coupling.coefficient = View<Real*>("coupling coefficient", slots.column.size() * m);
  }

  const BlockProblem& problem_;
  RCP<const Comm> comm_;
  std::vector<int> group_of_;  // [block] -1 where it remains
  RCP<const Map> ghosts_;      // of the group in work
  RCP<Import> import_entities_;
  EliminationPlan plan_;
};

}  // namespace

EliminationPlan plan_elimination(const BlockProblem& problem) { return Planner(problem).plan(); }

}  // namespace sprekk::solve
