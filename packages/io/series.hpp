// Time series in CSV and HDF5: tables with one row, or one row for each place, in every step of a run.
#pragma once

#include "base/types.hpp"

#include <string>
#include <vector>

namespace sprekk::io {

struct SeriesColumn {
  std::string name, unit;
};

/// Values at one time.
struct SeriesRow {
  Real time;                 ///< s
  std::vector<Real> values;  ///< [place * columns + column]
};

/// Table of a time series. Its columns after the time are the coordinates of each place, for instance along a line, and
/// the values.
struct SeriesTable {
  std::string name;
  std::vector<SeriesColumn> columns = {};
  std::vector<SeriesColumn> place_columns = {};  ///< none: one place, without columns
  std::vector<Real> places = {};                 ///< [place * place columns + column]
  std::vector<SeriesRow> rows = {};

  std::size_t n_places() const { return place_columns.empty() ? 1 : places.size() / place_columns.size(); }
};

/// Unit of the times in files: name, and length in s.
struct TimeUnit {
  std::string name;
  Real seconds;
};

/// Returns a table as CSV text. It contains the titles, `time [d],length [m]`, and all rows, or the last row only.
/// Numbers are reproduced exactly when read.
std::string to_csv(const SeriesTable& table, const TimeUnit& unit, bool last_alone = false);

/// Returns the content of an HDF5 file that is also a netCDF-4 file. Each table is a group. Each column is a variable
/// over the dimension `time` and, for tables with places, over the first place column. Attributes `units` contain the
/// units. Throws an Error if HDF5 fails. Not collective.
std::string to_netcdf(const std::vector<SeriesTable>& tables, const TimeUnit& unit);

/// Time series in DIRECTORY/probes/NAME.csv for each table, complete after every step, and in DIRECTORY/probes.h5 for
/// all tables. Only rank 0 stores rows. All members are collective. Errors name the path and are thrown on every rank.
class SeriesFiles {
 public:
  /// Creates the files and replaces those of an earlier run.
  SeriesFiles(RCP<const Comm> comm, const std::string& directory, std::vector<SeriesTable> tables, TimeUnit unit);

  void add(Real time, std::vector<std::vector<Real>> values);  ///< one row of each table; same on every rank
  void write_all() const;                                      ///< writes the file of all tables
  const std::vector<SeriesTable>& tables() const { return tables_; }

 private:
  std::string path(const SeriesTable& table) const { return directory_ + "/probes/" + table.name + ".csv"; }

  RCP<const Comm> comm_;
  std::string directory_;
  std::vector<SeriesTable> tables_;
  TimeUnit unit_;
};

}  // namespace sprekk::io
