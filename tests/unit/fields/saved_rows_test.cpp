#include "fields/saved_rows.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>

namespace sprekk::fields {
namespace {

/// Returns an entry of A. In odd rows every third entry is zero, although J stores it.
Real number(GlobalIndex i, GlobalIndex j) {
  return i % 2 == 1 && j % 3 == 0 ? 0 : std::sin(static_cast<Real>(7 * i + 3 * j + 1));
}

/// Matrix J with 150 full rows (three words of marks each), distributed over the ranks, in blocks of width x width.
struct Full {
  static constexpr GlobalIndex n = 150;
  RCP<const Map> map;
  RCP<const Matrix> J;

  explicit Full(int width) {
    const auto comm = Tpetra::getDefaultComm();
    map = rcp(new const Map(
        -1,
        width * (n / width * (comm->getRank() + 1) / comm->getSize() - n / width * comm->getRank() / comm->getSize()),
        0, comm));
    std::vector<GlobalIndex> all;
    for (std::size_t row = 0; row < base::n_local_elements(*map); ++row) all.push_back(map->getGlobalElement(row));
    for (GlobalIndex j = 0; j < n; ++j)
      if (!map->isNodeGlobalElement(j)) all.push_back(j);
    const View<std::size_t*> start("start", base::n_local_elements(*map) + 1);
    const View<LocalIndex*> column("column", base::n_local_elements(*map) * n);
    for (std::size_t k = 0; k < column.extent(0); ++k) column(k) = static_cast<LocalIndex>(k % n);
    for (std::size_t row = 0; row + 1 < start.extent(0); ++row) start(row + 1) = (row + 1) * n;
    J = rcp(new const Matrix(map, make_map(all, comm), map, start, column, width, width));
    for_numbers([](GlobalIndex i, GlobalIndex j, std::size_t, Real& value) { value = number(i, j); });
  }

  template <class Visit>
  void for_numbers(const Visit& visit) const {  // visit(row, column, position in the row, value)
    const auto numbers = J->numbers();
    for (LocalIndex row = 0; row < numbers.n_rows(); ++row)
      numbers.for_row(row, [&](LocalIndex c, std::size_t k) {
        visit(map->getGlobalElement(row), J->column_map()->getGlobalElement(c), k - numbers.row(row).begin,
              numbers.value(k));
      });
  }

  View<char*> rows(int every) const {
    const View<char*> chosen("chosen", base::n_local_elements(*map));
    for (std::size_t row = 0; row < chosen.extent(0); ++row) chosen(row) = map->getGlobalElement(row) % every == 0;
    return chosen;
  }
};

bool changes(GlobalIndex i, GlobalIndex j, int every) { return i % every == 0 && (i + j) % (every + 1) != 2; }

TEST(SavedRows, MultiplyAndGiveBackWhatWasThere) {
  for (const int width : {1, 2, 3}) {
    const Full full(width);
    ASSERT_EQ(full.J->numbers().width, width);
    SavedRows saved(full.J);
    Vector x(full.map), before(full.map), y(full.map);
    for (std::size_t i = 0; i < x.getLocalLength(); ++i)
      x.replaceLocalValue(i, std::cos(static_cast<Real>(full.map->getGlobalElement(i))));
    saved.add_product(x, before);
    std::size_t n_before = 0;
    for (const int every : {5, 3, 5}) {  // some rows are saved already and have other values in J; finally all
      const auto marks = saved.marks(full.rows(every));
      full.for_numbers([&](GlobalIndex i, GlobalIndex j, std::size_t place, Real&) {
        if (changes(i, j, every)) marks.set(full.map->getLocalElement(i), place);
      });
      saved.keep(marks);
      EXPECT_GE(saved.rows().extent(0), n_before);
      n_before = saved.rows().extent(0);
      full.for_numbers([&](GlobalIndex i, GlobalIndex j, std::size_t, Real& value) {
        if (changes(i, j, every)) value = 1e3 + static_cast<Real>(i + j);
      });
      y.putScalar(0);
      saved.add_product(x, y);
      for (std::size_t i = 0; i < y.getLocalLength(); ++i) EXPECT_EQ(y.getData()[i], before.getData()[i]) << i;
    }
    saved.restore(*full.J);
    full.for_numbers([](GlobalIndex i, GlobalIndex j, std::size_t, Real& value) { ASSERT_EQ(value, number(i, j)); });
  }
}

TEST(SavedRows, MayBeNone) {
  const Full full(3);
  SavedRows saved(full.J);
  saved.keep(saved.marks(View<char*>("none", base::n_local_elements(*full.map))));
  EXPECT_EQ(saved.rows().extent(0), 0u);
  saved.restore(*full.J);
  Vector x(full.map), y(full.map), expected(full.map);
  x.putScalar(1);
  full.J->crs()->apply(x, expected);
  saved.add_product(x, y);
  y.update(-1, expected, 1);
  EXPECT_LE(y.normInf(), 1e-12);
}

}  // namespace
}  // namespace sprekk::fields
