#include "io/series.hpp"

#include "base/check.hpp"
#include "io/file.hpp"
#include "io/hdf5_handle.hpp"

#include <hdf5_hl.h>

#include <algorithm>
#include <fstream>
#include <optional>

namespace sprekk::io {

namespace {

std::string title(const SeriesColumn& column) { return fmt::format("{} [{}]", column.name, column.unit); }

/// Adds a text attribute to an object.
void describe(hid_t object, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "a type");
  check(H5Tset_size(type, std::max<std::size_t>(1, text.size())), "the size of a text");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "a data space");
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  check(H5Awrite(attribute, type, text.data()), name);
}

/// Variable of a group with its unit.
class Variable {
 public:
  Variable(hid_t group, const SeriesColumn& column, const std::vector<hsize_t>& extents,
           const std::vector<Real>& values)
      : space_(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose, "a data space"),
        properties_(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "properties"),
        set_(create(group, column.name), H5Dclose, column.name) {
    if (!values.empty()) check(H5Dwrite(set_, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "data");
    describe(set_, "units", column.unit);
  }
  /// Declares the variable as a dimension.
  void set_scale(const std::string& name) const { check(H5DSset_scale(set_, name.c_str()), "a dimension"); }
  void attach(const Variable& scale, unsigned dimension) const {
    check(H5DSattach_scale(set_, scale.set_, dimension), "a dimension");
  }

 private:
  hid_t create(hid_t group, std::string name) const {
    std::replace(name.begin(), name.end(), '/', ' ');                 // / separates groups
    check(H5Pset_obj_track_times(properties_, false), "properties");  // equal values give equal files
    return H5Dcreate2(group, name.c_str(), H5T_NATIVE_DOUBLE, space_, H5P_DEFAULT, properties_, H5P_DEFAULT);
  }

  Handle space_, properties_, set_;
};

void write_table(hid_t file, const SeriesTable& table, const TimeUnit& unit) {
  const Handle group(H5Gcreate2(file, table.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, table.name);
  const auto n_places = table.n_places(), n_columns = table.columns.size(), n_known = table.place_columns.size();
  std::vector<Real> times;
  for (const auto& row : table.rows) times.push_back(row.time / unit.seconds);
  const Variable time(group, {"time", unit.name}, {times.size()}, times);
  time.set_scale("time");
  std::optional<Variable> place;
  for (std::size_t c = 0; c < n_known; ++c) {
    std::vector<Real> values;
    for (std::size_t k = 0; k < n_places; ++k) values.push_back(table.places[k * n_known + c]);
    if (c == 0) {
      place.emplace(group, table.place_columns[c], std::vector<hsize_t>{n_places}, values);
      place->set_scale(table.place_columns[c].name);
    } else {
      Variable(group, table.place_columns[c], {n_places}, values).attach(*place, 0);
    }
  }
  for (std::size_t c = 0; c < n_columns; ++c) {
    std::vector<Real> values;
    for (const auto& row : table.rows)
      for (std::size_t k = 0; k < n_places; ++k) values.push_back(row.values[k * n_columns + c]);
    std::vector<hsize_t> extents = {times.size()};
    if (place) extents.push_back(n_places);
    const Variable variable(group, table.columns[c], extents, values);
    variable.attach(time, 0);
    if (place) variable.attach(*place, 1);
  }
}

}  // namespace

std::string to_csv(const SeriesTable& table, const TimeUnit& unit, bool last_alone) {
  std::string text;
  if (!last_alone) {
    text = fmt::format("time [{}]", unit.name);
    for (const auto* columns : {&table.place_columns, &table.columns})
      for (const auto& column : *columns) text += ',' + title(column);
    text += '\n';
  }
  const auto n_places = table.n_places(), n_columns = table.columns.size(), n_known = table.place_columns.size();
  for (std::size_t r = last_alone ? table.rows.size() - 1 : 0; r < table.rows.size(); ++r)
    for (std::size_t k = 0; k < n_places; ++k) {
      const auto& row = table.rows[r];
      text += fmt::format("{}", row.time / unit.seconds);
      for (std::size_t c = 0; c < n_known; ++c) text += fmt::format(",{}", table.places[k * n_known + c]);
      for (std::size_t c = 0; c < n_columns; ++c) text += fmt::format(",{}", row.values[k * n_columns + c]);
      text += '\n';
    }
  return text;
}

std::string to_netcdf(const std::vector<SeriesTable>& tables, const TimeUnit& unit) {
  const Handle access(in_memory(), H5Pclose, "access in memory");
  const Handle file(H5Fcreate("series", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "a file in memory");
  for (const auto& table : tables) write_table(file, table, unit);
  return image_of(file);
}

SeriesFiles::SeriesFiles(RCP<const Comm> comm, const std::string& directory, std::vector<SeriesTable> tables,
                         TimeUnit unit)
    : comm_(std::move(comm)), directory_(directory), tables_(std::move(tables)), unit_(std::move(unit)) {
  make_directory(*comm_, directory_ + "/probes");
  base::collectively(*comm_, [&] {
    for (auto& table : tables_)
      if (comm_->getRank() == 0)
        write_file(path(table), to_csv(table, unit_));
      else
        table.rows.clear();
  });
  write_all();
}

void SeriesFiles::add(Real time, std::vector<std::vector<Real>> values) {
  base::collectively(*comm_, [&] {
    if (comm_->getRank() != 0) return;
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      auto& table = tables_[t];
      table.rows.push_back({time, std::move(values[t])});
      std::ofstream file(path(table), std::ios::app | std::ios::binary);
      file << to_csv(table, unit_, true) << std::flush;
      SPREKK_CHECK(file.good(), "{}: cannot be written", path(table));
    }
  });
}

void SeriesFiles::write_all() const {
  base::collectively(*comm_, [&] {
    if (comm_->getRank() == 0) write_file(directory_ + "/probes.h5", to_netcdf(tables_, unit_));
  });
}

}  // namespace sprekk::io
