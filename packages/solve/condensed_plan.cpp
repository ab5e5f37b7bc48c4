// The blocks that remain after elimination: their graphs, and where everything lands in their values.
#include <algorithm>
#include <utility>

#include "solve/elimination_plan.hpp"

namespace sprekk::solve {
namespace {

using GlobalIndices = std::vector<GlobalIndex>;

LocalIndices to_host(const View<LocalIndex*>& from) {
  const auto mirror = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), from);
  return LocalIndices(mirror.data(), mirror.data() + mirror.extent(0));
}

class CondensedPlanner {
 public:
  CondensedPlanner(const BlockProblem& problem, EliminationPlan& plan) : problem_(problem), plan_(plan) {}

  /// Graph of J_ab = graph of A_ab and of all products; then where everything lands in its values.
  void plan(int a, int b) {
    auto products = this->products(a, b);
    bool present = a == b || !matrix(a, b).is_null();
    for (const auto& group : plan_.groups)
      present = present || (!group.response[index(b)].fill.empty() && !group.coupling[index(a)].fill.empty());
    plan_.condensed.emplace_back();
    for (auto& group : plan_.groups) group.product.emplace_back();
    if (!present) return;
    const auto columns = find_columns(a, b, products);
    for (auto& product : products)
      for (std::size_t c = 0; c < product.column.size(); ++c)
        if (product.column[c] == 0) product.column[c] = columns->getLocalElement(product.response->column[c]);
    LocalIndices of_matrix;  // [column of A_ab]
    if (!matrix(a, b).is_null())
      for (auto column : matrix(a, b)->getColMap()->getNodeElementList())
        of_matrix.push_back(columns->getLocalElement(column));
    make_graph(a, b, columns, of_matrix, products);
    find_positions(a, b, of_matrix, products);
  }

 private:
  const std::vector<Block>& blocks() const { return problem_.blocks(); }
  RCP<const CrsMatrix> matrix(int i, int j) const { return problem_.matrix()(i, j); }

  int index(int block) const {
    return std::find(plan_.remaining.begin(), plan_.remaining.end(), block) - plan_.remaining.begin();
  }

  /// What couples rows of block a with columns of block b: A_ab, and the products of each group, on the host.
  struct Products {
    const Response* response;
    LocalIndices start, row_start, slot;  // of columns, pairs and slots, as in Response and Coupling
    LocalIndices column;                  // [as response->column] column of J_ab, -1 where no row here needs it

    template <class Visit>
    void for_columns(LocalIndex row, const Visit& visit) const {
      for (LocalIndex pair = row_start[row]; pair < row_start[row + 1]; ++pair)
        for (LocalIndex c = start[slot[pair]]; c < start[slot[pair] + 1]; ++c) visit(c);
    }
  };

  std::vector<Products> products(int a, int b) const {
    std::vector<Products> all;
    for (const auto& group : plan_.groups) {
      const auto& response = group.response[index(b)];
      const auto& coupling = group.coupling[index(a)];
      all.push_back({&response, to_host(response.column_start), to_host(coupling.row_start), to_host(coupling.slot),
                     LocalIndices(response.column.size(), -1)});
    }
    return all;
  }

  /// The columns that rows of J_ab have here: those owned in their order, then the others by the ranks that own them.
  RCP<const Map> find_columns(int a, int b, std::vector<Products>& products) const {
    const auto& domain = *blocks()[b].map;
    GlobalIndices owned, others;
    const auto add = [&](GlobalIndex column) {
      (domain.isNodeGlobalElement(column) ? owned : others).push_back(column);
    };
    if (!matrix(a, b).is_null())
      for (auto column : matrix(a, b)->getColMap()->getNodeElementList()) add(column);
    const LocalIndex n_rows = blocks()[a].map->getNodeNumElements();
    for (LocalIndex row = 0; row < n_rows; ++row) {
      if (a == b) add(blocks()[a].map->getGlobalElement(row));
      for (auto& product : products)
        product.for_columns(row, [&](LocalIndex c) {
          if (product.column[c] == -1) add(product.response->column[c]);
          product.column[c] = 0;
        });
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    std::vector<int> ranks(others.size());
    domain.getRemoteIndexList(Teuchos::arrayView(others.data(), others.size()),
                              Teuchos::arrayView(ranks.data(), ranks.size()));
    std::vector<std::pair<int, GlobalIndex>> by_rank;
    for (std::size_t i = 0; i < others.size(); ++i) by_rank.emplace_back(ranks[i], others[i]);
    std::sort(by_rank.begin(), by_rank.end());
    const auto before = [&](GlobalIndex i, GlobalIndex j) {
      return domain.getLocalElement(i) < domain.getLocalElement(j);
    };
    std::sort(owned.begin(), owned.end(), before);
    owned.erase(std::unique(owned.begin(), owned.end()), owned.end());
    for (const auto& [rank, column] : by_rank) owned.push_back(column);
    const auto count_them = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    return rcp(new Map(count_them, Teuchos::arrayView(owned.data(), owned.size()), 0, problem_.comm()));
  }

  void make_graph(int a, int b, const RCP<const Map>& columns, const LocalIndices& of_matrix,
                  const std::vector<Products>& products) {
    const auto& rows = blocks()[a].map;
    const LocalIndex n_rows = rows->getNodeNumElements();
    const auto A = matrix(a, b);
    LocalIndices row_columns;
    const auto collect = [&](LocalIndex row) {
      row_columns.clear();
      if (!A.is_null()) {
        const auto graph = A->getLocalMatrixHost().graph;
        for (auto k = graph.row_map(row); k < graph.row_map(row + 1); ++k)
          row_columns.push_back(of_matrix[graph.entries(k)]);
      }
      if (a == b) row_columns.push_back(columns->getLocalElement(rows->getGlobalElement(row)));
      for (const auto& product : products)
        product.for_columns(row, [&](LocalIndex c) { row_columns.push_back(product.column[c]); });
      std::sort(row_columns.begin(), row_columns.end());
      row_columns.erase(std::unique(row_columns.begin(), row_columns.end()), row_columns.end());
    };
    using Local = CrsGraph::local_graph_device_type;
    const Local::row_map_type::non_const_type start("start", n_rows + 1);
    for (LocalIndex row = 0; row < n_rows; ++row) {
      collect(row);
      start(row + 1) = start(row) + row_columns.size();
    }
    const Local::entries_type::non_const_type entries("columns", start(n_rows));
    for (LocalIndex row = 0; row < n_rows; ++row) {
      collect(row);
      std::copy(row_columns.begin(), row_columns.end(), &entries(0) + start(row));
    }
    const auto graph = rcp(new CrsGraph(rows, columns, start, entries));
    graph->expertStaticFillComplete(blocks()[b].map, rows);
    auto& condensed = plan_.condensed.back();
    condensed.matrix = rcp(new CrsMatrix(graph));
    condensed.matrix->fillComplete(blocks()[b].map, rows);
    condensed.constrained = rcp(new Vector(columns));
  }

  /// Where values of A_ab and of the products land in those of J_ab.
  void find_positions(int a, int b, const LocalIndices& of_matrix, const std::vector<Products>& products) {
    auto& condensed = plan_.condensed.back();
    const auto graph = condensed.matrix->getLocalMatrixHost().graph;
    const auto find = [&](LocalIndex row, LocalIndex column) {
      const auto *begin = graph.entries.data() + graph.row_map(row),
                 *end = graph.entries.data() + graph.row_map(row + 1);
      return static_cast<LocalIndex>(std::lower_bound(begin, end, column) - graph.entries.data());
    };
    const LocalIndex n_rows = graph.numRows();
    if (const auto A = matrix(a, b); !A.is_null()) {
      const auto from = A->getLocalMatrixHost().graph;
      LocalIndices target;
      target.reserve(from.entries.extent(0));
      for (LocalIndex row = 0; row < n_rows; ++row)
        for (auto k = from.row_map(row); k < from.row_map(row + 1); ++k)
          target.push_back(find(row, of_matrix[from.entries(k)]));
      condensed.copy = {A, to_device(target, "scatter target")};
    }
    for (std::size_t g = 0; g < products.size(); ++g) {
      const auto& product = products[g];
      LocalIndices first, position;
      for (LocalIndex row = 0; row < n_rows; ++row)
        for (LocalIndex pair = product.row_start[row]; pair < product.row_start[row + 1]; ++pair) {
          first.push_back(position.size());
          for (LocalIndex c = product.start[product.slot[pair]]; c < product.start[product.slot[pair] + 1]; ++c)
            position.push_back(find(row, product.column[c]));
        }
      plan_.groups[g].product.back() = {to_device(first, "product start"), to_device(position, "product position")};
    }
  }

  const BlockProblem& problem_;
  EliminationPlan& plan_;
};

}  // namespace

void plan_condensed(const BlockProblem& problem, EliminationPlan& plan) {
  CondensedPlanner planner(problem, plan);
  for (int a : plan.remaining)
    for (int b : plan.remaining) planner.plan(a, b);
}

}  // namespace sprekk::solve
