// Names that differ between Trilinos 13.2 with Kokkos 3.4 and later versions. They occur in this file only.
#pragma once

#include <Kokkos_Core.hpp>

#include <cstddef>

namespace sprekk::base {

namespace detail {

// The second argument, 0, prefers the first function of each pair (names since Trilinos 13.4) to the second (older
// names).
template <class Map>
auto n_elements(const Map& map, int) -> decltype(map.getLocalNumElements()) {
  return map.getLocalNumElements();
}
template <class Map>
auto n_elements(const Map& map, long) -> decltype(map.getNodeNumElements()) {
  return map.getNodeNumElements();
}
template <class Map>
auto elements(const Map& map, int) -> decltype(map.getLocalElementList()) {
  return map.getLocalElementList();
}
template <class Map>
auto elements(const Map& map, long) -> decltype(map.getNodeElementList()) {
  return map.getNodeElementList();
}
template <class Matrix>
auto n_rows(const Matrix& matrix, int) -> decltype(matrix.getLocalNumRows()) {
  return matrix.getLocalNumRows();
}
template <class Matrix>
auto n_rows(const Matrix& matrix, long) -> decltype(matrix.getNodeNumRows()) {
  return matrix.getNodeNumRows();
}
template <class Matrix>
auto n_columns(const Matrix& matrix, int) -> decltype(matrix.getLocalNumCols()) {
  return matrix.getLocalNumCols();
}
template <class Matrix>
auto n_columns(const Matrix& matrix, long) -> decltype(matrix.getNodeNumCols()) {
  return matrix.getNodeNumCols();
}
template <class Matrix>
auto n_entries(const Matrix& matrix, int) -> decltype(matrix.getLocalNumEntries()) {
  return matrix.getLocalNumEntries();
}
template <class Matrix>
auto n_entries(const Matrix& matrix, long) -> decltype(matrix.getNodeNumEntries()) {
  return matrix.getNodeNumEntries();
}

}  // namespace detail

/// Number and list of the indices of a Tpetra map on this rank, in local order.
template <class Map>
std::size_t n_local_elements(const Map& map) {
  return detail::n_elements(map, 0);
}
template <class Map>
auto local_elements(const Map& map) {
  return detail::elements(map, 0);
}

/// Number of rows, columns and entries of a Tpetra matrix on this rank.
template <class Matrix>
std::size_t n_local_rows(const Matrix& matrix) {
  return detail::n_rows(matrix, 0);
}
template <class Matrix>
std::size_t n_local_columns(const Matrix& matrix) {
  return detail::n_columns(matrix, 0);
}
template <class Matrix>
std::size_t n_local_entries(const Matrix& matrix) {
  return detail::n_entries(matrix, 0);
}

#if KOKKOS_VERSION >= 30700
using Kokkos::fabs;
#else
using Kokkos::Experimental::fabs;
#endif

}  // namespace sprekk::base
