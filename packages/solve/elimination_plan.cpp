#include "solve/elimination_plan.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/check.hpp"
#include "solve/small_lu.hpp"

namespace sprekk::solve {

namespace {

using GlobalIndices = std::vector<GlobalIndex>;

/// Calls visit(row, position of the value, global column) for the stored entries of owned rows.
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

/// Global columns of rows or entities, set after set. Each set is sorted and without repetitions.
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

  /// Finds the owned entities, and the ghosts to which owned rows of the remaining blocks couple. Throws an Error on
  /// all ranks if the blocks of the group have different entities. Collective.
  void find_entities(GroupPlan& group) {
    GlobalIndices owned;
    base::collectively(*comm_, [&] {
      for (int z : group.blocks) {
        const int n = blocks()[z].n_components;
        const auto& map = *blocks()[z].map;
        GlobalIndices entities;
        for (LocalIndex i = 0, end = base::n_local_elements(map); i < end; i += n)
          entities.push_back(map.getGlobalElement(i) / n);
        SPREKK_CHECK(z == group.blocks[0] || entities == owned,
                     "local group '{}': block '{}' does not hold the same entities as the first block", group.name,
                     blocks()[z].name);
        owned = entities;
      }
    });
    const auto entities = fields::make_map(owned, comm_);
    GlobalIndices ghosts;
    for (int a : plan_.remaining)
      for (int z : group.blocks) {
        if (matrix(a, z).is_null()) continue;
        const auto& columns = *matrix(a, z)->getColMap();
        for (LocalIndex i = 0, n = base::n_local_elements(columns); i < n; ++i) {
          const GlobalIndex entity = columns.getGlobalElement(i) / blocks()[z].n_components;
          if (!entities->isNodeGlobalElement(entity)) ghosts.push_back(entity);
        }
      }
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    owned.insert(owned.end(), ghosts.begin(), ghosts.end());
    group.slots = std::make_shared<Halo>(entities, fields::make_map(owned, comm_));
  }

  static LocalIndex slot(const GroupPlan& group, GlobalIndex entity) {
    return group.slots->all()->getLocalElement(entity);
  }

  static LocalIndex n_owned(const GroupPlan& group) { return group.slots->n_owned(); }

  /// Returns the largest width for which targets form groups of adjacent values.
  static int common_width(const LocalIndices& target) {
    for (int width = max_small_size; width > 1; --width) {
      bool together = target.size() % width == 0;
      for (std::size_t k = 0; k < target.size() && together; ++k)
        together = target[k] == target[k - k % width] + static_cast<LocalIndex>(k % width);
      if (together) return width;
    }
    return 1;
  }

  template <class Find>
  static Scatter make_scatter(const RCP<const CrsMatrix>& matrix, const Find& find) {
    LocalIndices target(base::n_local_entries(*matrix));
    for_entries(*matrix, [&](LocalIndex row, LocalIndex k, GlobalIndex column) { target[k] = find(row, column); });
    const int width = common_width(target);
    for (std::size_t k = 0; k < target.size(); k += width) target[k / width] = target[k];
    target.resize(target.size() / width);
    return {matrix, width, to_device(target, "scatter target")};
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

  /// Copies the columns of ghosts from their owners. Collective.
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
  }

  void plan_coupling(GroupPlan& group, int a) const {
    const auto for_numbers = [&](const auto& visit) {  // visit(row, slot, component, position)
      for (std::size_t i = 0; i < group.blocks.size(); ++i) {
        const int z = group.blocks[i], nz = blocks()[z].n_components;
        if (matrix(a, z).is_null()) continue;
        for_entries(*matrix(a, z), [&](LocalIndex row, LocalIndex k, GlobalIndex column) {
          visit(row, slot(group, column / nz), group.offset[i] + static_cast<int>(column % nz), k);
        });
      }
    };
    std::vector<GlobalIndices> sets(base::n_local_elements(*blocks()[a].map));
    for_numbers([&](LocalIndex row, LocalIndex slot, int, LocalIndex) { sets[row].push_back(slot); });
    const ColumnSets slots(sets);
    const auto pair = [&](LocalIndex row, LocalIndex slot) {
      return position_in(slots.column, slots.start[row], slots.start[row + 1], slot);
    };
    group.coupling.emplace_back();
    Coupling& coupling = group.coupling.back();
    coupling.row_start = to_device(slots.start, "coupling row start");
    coupling.slot = to_device(LocalIndices(slots.column.begin(), slots.column.end()), "coupling slot");
    const auto for_runs = [&](const auto& begin, const auto& go_on) {
      LocalIndex last_pair = -1, last_place = -1;
      int last_component = -1;
      for_numbers([&](LocalIndex row, LocalIndex slot, int component, LocalIndex place) {
        const LocalIndex p = pair(row, slot);
        const bool new_block = std::count(group.offset.begin(), group.offset.end(), component) > 0;
        const bool follows = !new_block && p == last_pair && place == last_place + 1 && component == last_component + 1;
        std::tie(last_pair, last_place, last_component) = std::tuple(p, place, component);
        follows ? go_on(p) : begin(p, component, place);
      });
    };
    LocalIndices first(slots.column.size() + 1);
    for_runs([&](LocalIndex p, int, LocalIndex) { ++first[p + 1]; }, [](LocalIndex) {});
    std::partial_sum(first.begin(), first.end(), first.begin());
    coupling.first = to_device(first, "coupling first");
    coupling.source = View<LocalIndex*>("coupling source", first.back());
    coupling.component = View<std::uint8_t*>("coupling component", first.back());
    coupling.length = View<std::uint8_t*>("coupling length", first.back());
    for_runs(
        [&](LocalIndex p, int component, LocalIndex place) {
          const LocalIndex at = first[p]++;
          coupling.source(at) = place;
          coupling.component(at) = static_cast<std::uint8_t>(component);
          coupling.length(at) = 1;
        },
        [&](LocalIndex p) { ++coupling.length(first[p] - 1); });
  }

  const BlockProblem& problem_;
  RCP<const Comm> comm_;
  std::vector<int> group_of_;  // [block] -1 for remaining blocks
  EliminationPlan plan_;
};

}  // namespace

void Scatter::operator()(const View<Real*>& out) const {
  const auto values = matrix->getLocalMatrixDevice().values;
  const auto to = target;
  const int n = width;
  Kokkos::parallel_for(
      "scatter values", Kokkos::RangePolicy<Execution>(0, to.extent(0)), KOKKOS_LAMBDA(LocalIndex k) {
        for (int i = 0; i < n; ++i) out(to(k) + i) = values(static_cast<std::size_t>(k) * n + i);
      });
}

EliminationPlan plan_elimination(const BlockProblem& problem) { return Planner(problem).plan(); }

}  // namespace sprekk::solve
