// Tables that grow by a row, or one row for each place, in every step of a run: CSV and HDF5.
#pragma once

#include "base/types.hpp"

#include <string>
#include <vector>

namespace sprekk::io {

struct SeriesColumn {
  std::string name, unit;
};

/// The values at one time.
struct SeriesRow {
  Real time;                 ///< s
  std::vector<Real> values;  ///< [place * columns + column]
};

/// What a table has in its columns behind the time: where its values are, as along a line, and the values.
struct SeriesTable {
  std::string name;
  std::vector<SeriesColumn> columns = {};
  std::vector<SeriesColumn> place_columns = {};  ///< none: one place, which is not told
  std::vector<Real> places = {};                 ///< [place * place columns + column]
  std::vector<SeriesRow> rows = {};

  std::size_t n_places() const { return place_columns.empty() ? 1 : places.size() / place_columns.size(); }
};

struct TimeUnit {
  std::string name;
  Real seconds;
};

/// Text of a table: of its titles, `time [d],length [m]`, and all rows, or of the last row alone. Every number reads
/// back to the same bits.
std::string to_csv(const SeriesTable& table, const TimeUnit& unit, bool last_alone = false);

/// The content of an HDF5 file that is a netCDF-4 file, too: a group for each table with the variable of each column
/// over the dimension `time`, of tables with places also over the first of their columns; units are attributes
/// `units`. Error if HDF5 fails. Not collective.
std::string to_netcdf(const std::vector<SeriesTable>& tables, const TimeUnit& unit);

/// DIRECTORY/probes/NAME.csv of each table, complete after every step, and DIRECTORY/probes.h5 of all. Rank 0 alone
/// keeps rows. All members are collective; Errors name the path, on every rank.
class SeriesFiles {
 public:
  /// Replaces what an earlier run left.
  SeriesFiles(RCP<const Comm> comm, const std::string& directory, std::vector<SeriesTable> tables, TimeUnit unit);

  void add(Real time, std::vector<std::vector<Real>> values);  ///< of each table a row, the same on every rank
  void write_all() const;                                      ///< the file of all tables
  const std::vector<SeriesTable>& tables() const { return tables_; }

 private:
  std::string path(const SeriesTable& table) const { return directory_ + "/probes/" + table.name + ".csv"; }

  RCP<const Comm> comm_;
  std::string directory_;
  std::vector<SeriesTable> tables_;
  TimeUnit unit_;
};

}  // namespace sprekk::io
