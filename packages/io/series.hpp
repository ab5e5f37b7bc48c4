// Tables that grow by a row, or one row for each place, in every step of a run: CSV and HDF5.
#pragma once

#include "base/types.hpp"

#include <string>
#include <vector>

namespace sprekk::io {

struct SeriesColumn {
  std::string name, unit;
};

/// What a table has in its columns behind the time: where its values are, as along a line, and the values.
struct SeriesTable {
  std::string name;
  std::vector<SeriesColumn> columns = {};
  std::vector<SeriesColumn> place_columns = {};  ///< none: one place, which is not told
  std::vector<Real> places = {};                 ///< [place * place columns + column]

  std::size_t n_places() const { return place_columns.empty() ? 1 : places.size() / place_columns.size(); }
};

/// The values of one step, of each table [place * columns + column].
struct SeriesRow {
  Real time;  ///< s
  std::vector<std::vector<Real>> values;
};

struct TimeUnit {
  std::string name;
  Real seconds;
};

/// Text of a table with titles, `time [d],length [m]`; every number reads back to the same bits.
std::string to_csv(const SeriesTable& table, std::size_t number, const TimeUnit& unit,
                   const std::vector<SeriesRow>& rows, bool titles);

/// The content of an HDF5 file that is a netCDF-4 file, too: a group for each table with the variable of each column
/// over the dimension `time`, of tables with places also over the first of their columns; units are attributes
/// `units`. Error if HDF5 fails. Not collective.
std::string to_netcdf(const std::vector<SeriesTable>& tables, const TimeUnit& unit, const std::vector<SeriesRow>& rows);

/// DIRECTORY/probes/NAME.csv of each table, complete after every step, and DIRECTORY/probes.h5 of all. All members are
/// collective; Errors name the path, on every rank.
class SeriesFiles {
 public:
  /// Replaces what an earlier run left by `rows`.
  SeriesFiles(RCP<const Comm> comm, const std::string& directory, std::vector<SeriesTable> tables, TimeUnit unit,
              std::vector<SeriesRow> rows);

  void add(SeriesRow row);  ///< the same on every rank
  void write_all() const;   ///< the file of all tables
  const std::vector<SeriesTable>& tables() const { return tables_; }
  const std::vector<SeriesRow>& rows() const { return rows_; }

 private:
  std::string path(const SeriesTable& table) const { return directory_ + "/probes/" + table.name + ".csv"; }

  RCP<const Comm> comm_;
  std::string directory_;
  std::vector<SeriesTable> tables_;
  TimeUnit unit_;
  std::vector<SeriesRow> rows_;
};

}  // namespace sprekk::io
