#include "solve/elimination_plan.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <numeric>

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

const GlobalIndex count_them = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();

RCP<const Map> make_map(const GlobalIndices& indices, const RCP<const Comm>& comm) {
  return rcp(new Map(count_them, Teuchos::arrayView(indices.data(), indices.size()), 0, comm));
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
    for (auto& group : plan_.groups)
      for (auto& response : group.response) response.column = {};
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
    const auto entities = make_map(owned, comm_);
    GlobalIndices ghosts;
    for (int a : plan_.remaining)
      for (int z : group.blocks) {
        if (matrix(a, z).is_null()) continue;
        for (auto index : matrix(a, z)->getColMap()->getNodeElementList()) {
          const GlobalIndex entity = index / blocks()[z].n_components;
          if (!entities->isNodeGlobalElement(entity)) ghosts.push_back(entity);
        }
      }
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    owned.insert(owned.end(), ghosts.begin(), ghosts.end());
    group.slots = std::make_shared<Halo>(entities, make_map(owned, comm_));
  }

  static LocalIndex slot(const GroupPlan& group, GlobalIndex entity) {
    return group.slots->all()->getLocalElement(entity);
  }

  static LocalIndex n_owned(const GroupPlan& group) { return group.slots->n_owned(); }

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
            SPREKK_CHECK(column / nj == group.slots->owned()->getGlobalElement(entity),
                         "local group '{}': entity {} couples to entity {} in block ('{}', '{}')", group.name,
                         group.slots->owned()->getGlobalElement(entity), column / nj, blocks()[zi].name,
                         blocks()[zj].name);
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

  /// Makes the ghosts' columns known.
  static void exchange(const GroupPlan& group, const ColumnSets& columns, Response& response) {
    const LocalIndex n = n_owned(group), n_slots = group.slots->n_all();
    const View<GlobalIndex*> length("response lengths", n_slots);
    for (LocalIndex e = 0; e < n; ++e) length(e) = columns.start[e + 1] - columns.start[e];
    group.slots->exchange(length, 1);
    response.column_start = View<std::size_t*>("response column start", n_slots + 1);
    for (LocalIndex e = 0; e < n_slots; ++e) response.column_start(e + 1) = response.column_start(e) + length(e);
    response.column = View<GlobalIndex*>("response columns", response.column_start(n_slots));
    std::copy(columns.column.begin(), columns.column.end(), response.column.data());
    group.slots->exchange_rows(response.column_start, response.column, 1);
    response.value = View<Real*>("responses", group.size * response.column.extent(0) + Response::strip);
  }

  void plan_coupling(GroupPlan& group, int a) const {
    const auto for_numbers = [&](const auto& visit) {  // visit(row, slot, component, place)
      for (std::size_t i = 0; i < group.blocks.size(); ++i) {
        const int z = group.blocks[i], nz = blocks()[z].n_components;
        if (matrix(a, z).is_null()) continue;
        for_entries(*matrix(a, z), [&](LocalIndex row, LocalIndex k, GlobalIndex column) {
          visit(row, slot(group, column / nz), group.offset[i] + static_cast<int>(column % nz), k);
        });
      }
    };
    std::vector<GlobalIndices> sets(blocks()[a].map->getNodeNumElements());
    for_numbers([&](LocalIndex row, LocalIndex slot, int, LocalIndex) { sets[row].push_back(slot); });
    const ColumnSets slots(sets);
    const auto pair = [&](LocalIndex row, LocalIndex slot) {
      return position_in(slots.column, slots.start[row], slots.start[row + 1], slot);
    };
    group.coupling.emplace_back();
    Coupling& coupling = group.coupling.back();
    coupling.row_start = to_device(slots.start, "coupling row start");
    coupling.slot = to_device(LocalIndices(slots.column.begin(), slots.column.end()), "coupling slot");
    LocalIndices first(slots.column.size() + 1);
    for_numbers([&](LocalIndex row, LocalIndex slot, int, LocalIndex) { ++first[pair(row, slot) + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    coupling.first = to_device(first, "coupling first");
    coupling.source = View<LocalIndex*>("coupling source", first.back());
    coupling.component = View<std::uint8_t*>("coupling component", first.back());
    for_numbers([&](LocalIndex row, LocalIndex slot, int component, LocalIndex place) {
      const LocalIndex at = first[pair(row, slot)]++;
      coupling.source(at) = place;
      coupling.component(at) = static_cast<std::uint8_t>(component);
    });
  }

  const BlockProblem& problem_;
  RCP<const Comm> comm_;
  std::vector<int> group_of_;  // [block] -1 where it remains
  EliminationPlan plan_;
};

}  // namespace

EliminationPlan plan_elimination(const BlockProblem& problem) { return Planner(problem).plan(); }

}  // namespace sprekk::solve
