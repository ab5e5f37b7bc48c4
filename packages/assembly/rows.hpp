// Views of the rows and unknowns of block vectors.
#pragma once

#include "assembly/module.hpp"
#include "fields/types.hpp"

namespace sprekk::assembly {

/// Returns a view of the values of a vector, [row].
inline View<Real*> view_of(fields::Vector& v) {
  const auto local = v.getLocalViewDevice(Tpetra::Access::ReadWrite);
  return View<Real*>(local.data(), local.extent(0));
}

inline ConstView<Real*> const_view_of(const fields::Vector& v) {
  const auto local = v.getLocalViewDevice(Tpetra::Access::ReadOnly);
  return ConstView<Real*>(local.data(), local.extent(0));
}

/// Returns views of all blocks, [block](row).
inline Rows rows_of(const fields::BlockVector& r) {
  Rows views;
  for (const auto& v : r) views.push_back(view_of(*v));
  return views;
}

}  // namespace sprekk::assembly
