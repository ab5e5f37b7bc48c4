// Remaining blocks after elimination: their graphs, and the columns of the added products.
#include <algorithm>
#include <iterator>
#include <utility>

#include "base/host_table.hpp"
#include "solve/elimination_plan.hpp"

namespace sprekk::solve {
namespace {

using GlobalIndices = std::vector<GlobalIndex>;

using base::to_host;

class CondensedPlanner {
 public:
  CondensedPlanner(const BlockProblem& problem, EliminationPlan& plan) : problem_(problem), plan_(plan) {}

  /// Plans J_ab: its graph is that of A_ab and all products. Then finds the columns of A_ab and the responses in it.
  /// Collective.
  void plan(int a, int b) {
    const auto bulk = this->bulk(a, b);
    bool present = a == b || !bulk.is_null();
    for (const auto& group : plan_.groups) {
      const auto some = [&](const auto& matrix_of) {
        return std::any_of(group.blocks.begin(), group.blocks.end(), [&](int z) { return !matrix_of(z).is_null(); });
      };
      present = present || (some([&](int z) { return matrix(a, z); }) && some([&](int z) { return matrix(z, b); }));
    }
    plan_.condensed.emplace_back();
    for (auto& group : plan_.groups) group.column.emplace_back();
    if (!present) return;
    auto products = this->products(a, b);
    const auto columns = find_columns(a, b, bulk, products);
    for (auto& product : products)
      for (std::size_t c = 0; c < product.column.size(); ++c)
        if (product.column[c] == 0) product.column[c] = columns->getLocalElement(product.global(c));
    LocalIndices of_matrix;  // [column of A_ab]
    for_columns(bulk, [&](GlobalIndex column) { of_matrix.push_back(columns->getLocalElement(column)); });
    make_matrix(a, b, columns, bulk, of_matrix, products);
    auto& condensed = plan_.condensed.back();
    condensed.bulk = bulk;
    condensed.bulk_column = to_device(of_matrix, "bulk column");
    for (std::size_t g = 0; g < products.size(); ++g)
      plan_.groups[g].column.back() = to_device(products[g].column, "product column");
  }

 private:
  const std::vector<Block>& blocks() const { return problem_.blocks(); }
  RCP<const CrsMatrix> matrix(int i, int j) const { return problem_.matrix()(i, j); }

  /// Returns A_ab with all its columns, or the matrix that stores it.
  RCP<const Matrix> bulk(int a, int b) const {
    if (a == b && problem_.matrix().saved(a)) return problem_.matrix().saved(a)->J();
    return matrix(a, b).is_null() ? Teuchos::null : fields::wrapped(matrix(a, b));
  }

  /// Calls visit(global column) for the local columns of a matrix; none if it is null.
  template <class Visit>
  static void for_columns(const RCP<const Matrix>& matrix, const Visit& visit) {
    if (matrix.is_null()) return;
    const auto& columns = *matrix->column_map();
    for (LocalIndex i = 0, n = base::n_local_elements(columns); i < n; ++i) visit(columns.getGlobalElement(i));
  }

  int index(int block) const {
    return std::find(plan_.remaining.begin(), plan_.remaining.end(), block) - plan_.remaining.begin();
  }

  /// Products of each group that couple rows of block a with columns of block b, on the host.
  struct Products {
    using Indices = decltype(to_host(View<LocalIndex*>()));
    decltype(to_host(View<std::size_t*>())) start;   // see Response
    decltype(to_host(View<GlobalIndex*>())) global;  // columns of the response
    Indices row_start, slot;                         // see Coupling
    LocalIndices column;                             // [as global] column of J_ab, or -1 if no owned row needs it

    template <class Visit>
    void for_columns(LocalIndex row, const Visit& visit) const {
      for (LocalIndex pair = row_start(row); pair < row_start(row + 1); ++pair)
        for (std::size_t c = start(slot(pair)); c < start(slot(pair) + 1); ++c) visit(c);
    }
  };

  std::vector<Products> products(int a, int b) const {
    std::vector<Products> all;
    for (const auto& group : plan_.groups) {
      const auto& response = group.response[index(b)];
      const auto& coupling = group.coupling[index(a)];
      all.push_back({to_host(response.column_start), to_host(response.column), to_host(coupling.row_start),
                     to_host(coupling.slot), LocalIndices(response.column.extent(0), -1)});
    }
    return all;
  }

  /// Returns the local columns of J_ab. The order is: owned columns, other columns of A_ab, others by owning rank.
  /// Collective.
  RCP<const Map> find_columns(int a, int b, const RCP<const Matrix>& bulk, std::vector<Products>& products) const {
    const auto& domain = *blocks()[b].map;
    std::vector<char> wanted(base::n_local_elements(domain), a == b);  // [owned unknown]
    GlobalIndices of_bulk, others;
    const auto add = [&](GlobalIndex column, GlobalIndices& not_owned) {
      if (const LocalIndex owned = domain.getLocalElement(column); owned >= 0)
        wanted[owned] = true;
      else
        not_owned.push_back(column);
    };
    for_columns(bulk, [&](GlobalIndex column) { add(column, of_bulk); });
    for (auto& product : products)
      for (std::size_t pair = 0; pair < product.slot.extent(0); ++pair)
        for (std::size_t c = product.start(product.slot(pair)), end = product.start(product.slot(pair) + 1);
             c < end && product.column[c] != 0; ++c) {
          add(product.global(c), others);
          product.column[c] = 0;
        }
    GlobalIndices all;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i]) all.push_back(domain.getGlobalElement(i));
    all.insert(all.end(), of_bulk.begin(), of_bulk.end());
    for (auto column : by_rank(others, of_bulk, domain)) all.push_back(column);
    return fields::make_map(all, problem_.comm());
  }

  /// Returns the columns that are not in `known`, each once, sorted by owning rank. Collective.
  static GlobalIndices by_rank(GlobalIndices columns, GlobalIndices known, const Map& domain) {
    std::sort(columns.begin(), columns.end());
    std::sort(known.begin(), known.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    GlobalIndices found;
    std::set_difference(columns.begin(), columns.end(), known.begin(), known.end(), std::back_inserter(found));
    std::vector<int> ranks(found.size());
    domain.getRemoteIndexList(Teuchos::arrayView(found.data(), found.size()),
                              Teuchos::arrayView(ranks.data(), ranks.size()));
    std::vector<std::pair<int, GlobalIndex>> pairs;
    for (std::size_t i = 0; i < found.size(); ++i) pairs.emplace_back(ranks[i], found[i]);
    std::sort(pairs.begin(), pairs.end());
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = pairs[i].second;
    return found;
  }

  void make_matrix(int a, int b, const RCP<const Map>& columns, const RCP<const Matrix>& bulk,
                   const LocalIndices& of_bulk, const std::vector<Products>& products) {
    const auto& rows = blocks()[a].map;
    const LocalIndex n_rows = base::n_local_elements(*rows);
    LocalIndices met(base::n_local_elements(*columns), -1);  // [column] last row with this column
    const auto for_new = [&](LocalIndex row, const auto& visit) {
      const auto meet = [&](LocalIndex column) {
        if (met[column] != row) visit(column);
        met[column] = row;
      };
      if (!bulk.is_null()) bulk->numbers().for_row(row, [&](LocalIndex c, std::size_t) { meet(of_bulk[c]); });
      if (a == b) meet(columns->getLocalElement(rows->getGlobalElement(row)));
      for (const auto& product : products) product.for_columns(row, [&](std::size_t c) { meet(product.column[c]); });
    };
    const View<std::size_t*> start("start", n_rows + 1);
    for (LocalIndex row = 0; row < n_rows; ++row) {
      start(row + 1) = start(row);
      for_new(row, [&](LocalIndex) { ++start(row + 1); });
    }
    std::fill(met.begin(), met.end(), -1);
    const View<LocalIndex*> entries("columns", start(n_rows));
    for (LocalIndex row = 0; row < n_rows; ++row) {
      auto *begin = entries.data() + start(row), *end = begin;
      for_new(row, [&](LocalIndex column) { *end++ = column; });
      if (!std::is_sorted(begin, end)) std::sort(begin, end);
    }
    auto& condensed = plan_.condensed.back();
    condensed.matrix = rcp(new const Matrix(rows, columns, blocks()[b].map, start, entries, blocks()[a].n_components,
                                            blocks()[b].n_components));
    condensed.constrained = View<char*>("constrained", base::n_local_elements(*columns));
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
