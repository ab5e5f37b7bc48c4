// Types of distributed vectors and matrices.
#pragma once

#include "base/trilinos_compat.hpp"
#include "base/types.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include <vector>

namespace sprekk::fields {

using Map = Tpetra::Map<LocalIndex, GlobalIndex>;
using Vector = Tpetra::Vector<Real, LocalIndex, GlobalIndex>;
using MultiVector = Tpetra::MultiVector<Real, LocalIndex, GlobalIndex>;
using CrsGraph = Tpetra::CrsGraph<LocalIndex, GlobalIndex>;
using CrsMatrix = Tpetra::CrsMatrix<Real, LocalIndex, GlobalIndex>;
using Import = Tpetra::Import<LocalIndex, GlobalIndex>;
using Export = Tpetra::Export<LocalIndex, GlobalIndex>;
using Operator = Tpetra::Operator<Real, LocalIndex, GlobalIndex>;

/// One vector for each block, in the order of the blocks.
using BlockVector = std::vector<RCP<Vector>>;

/// Creates zero vectors on the maps of x.
inline BlockVector create_like(const BlockVector& x) {
  BlockVector y;
  for (const auto& v : x) y.push_back(rcp(new Vector(v->getMap())));
  return y;
}

/// Creates the map with these global numbers on this rank. If they are 0, 1, ... over all ranks, it stores no list
/// until the list is requested, for instance by an import. Collective.
RCP<const Map> make_map(const std::vector<GlobalIndex>& numbers, const RCP<const Comm>& comm);

/// Copies the values of all blocks; the maps must agree.
inline void copy(const BlockVector& from, BlockVector& to) {
  for (std::size_t b = 0; b < from.size(); ++b) Tpetra::deep_copy(*to[b], *from[b]);
}

}  // namespace sprekk::fields
