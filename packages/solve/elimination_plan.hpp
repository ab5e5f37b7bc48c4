// Positions of all values of a local elimination, found once from the graphs of the blocks and used by every update.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/host_table.hpp"
#include "fields/block_problem.hpp"
#include "fields/halo.hpp"

namespace sprekk::solve {

using fields::Block;
using fields::BlockProblem;
using fields::BlockVector;
using fields::CrsMatrix;
using fields::Halo;
using fields::Map;
using fields::Matrix;
using fields::Vector;

using LocalIndices = std::vector<LocalIndex>;

using base::to_device;

/// Copy of matrix values: out(target(k) + i) = value k * width + i of the matrix, i < width.
struct Scatter {
  RCP<const CrsMatrix> matrix;
  int width;  ///< number of values that are always adjacent
  View<LocalIndex*> target;

  void operator()(const View<Real*>& out) const;
};

/// Response A_zz^-1 A_zb of a local group z to a remaining block b. The rows of an entity are one dense block [m,
/// columns], row by row. The columns are the union over the rows. A slot is an entity: first the owned entities, then
/// the ghosts to which owned rows couple.
struct Response {
  static constexpr int strip = 8;  ///< columns that a kernel reads at a time; as many padding values follow the last

  std::vector<Scatter> fill;        ///< A_zb -> values of owned slots
  View<std::size_t*> column_start;  ///< [slot + 1] first column of a slot; the first value is at m times this number
  View<GlobalIndex*> column;        ///< [all columns] global unknown of b; empty after the first update
  View<Real*> value;                ///< only during an update
};

/// Coupling A_az of a remaining block a: positions of the values that couple a row with the unknowns of a slot. Values
/// that are adjacent both in A_az and in the entity form a run.
struct Coupling {
  View<LocalIndex*> row_start;    ///< [owned row + 1] first coupled pair of row and slot
  View<LocalIndex*> slot;         ///< [pair]
  View<LocalIndex*> first;        ///< [pair + 1] first run of a pair
  View<LocalIndex*> source;       ///< [run] start in A_az
  View<std::uint8_t*> component;  ///< [run] first unknown within the entity, 0 ... m-1; it determines z
  View<std::uint8_t*> length;     ///< [run]
};

/// Plan of one local group. [r] counts remaining blocks.
struct GroupPlan {
  std::string name;
  std::vector<int> blocks;
  std::vector<int> offset;  ///< first unknown of each block within the entity
  int size = 0;             ///< m: unknowns of one entity
  std::shared_ptr<const Halo> slots;
  std::vector<Scatter> fill;
  View<Real*> dense, lu;           ///< [entity * m * m]
  View<int*> pivot;                ///< [entity * m]
  View<Real*> column_scale;        ///< [m]
  View<Real*> work;                ///< [entity * m]
  std::vector<Response> response;  ///< [r]
  std::vector<Coupling> coupling;  ///< [r]
  /// [r * n_r + r'](column of response r') column in J, or -1 if no owned row needs it.
  std::vector<View<LocalIndex*>> column;
};

/// Block J_ab; the matrix is null if a and b do not couple.
struct CondensedBlock {
  RCP<const Matrix> matrix;
  RCP<const Matrix> bulk;                    ///< A_ab; null: absent, or stored in J_ab
  View<LocalIndex*> bulk_column;             ///< [column of A_ab] column in J_ab
  std::shared_ptr<fields::SavedRows> saved;  ///< saved values of A_ab if J_ab stores it, or null
  View<LocalIndex*> rows;                    ///< if J_ab stores A_ab: rows that may differ from it; else all rows
  View<LocalIndex*> constrained_rows;        ///< rows of prescribed unknowns, and rows with such a column
  View<char*> constrained;                   ///< [column] 1 for prescribed unknowns
};

struct EliminationPlan {
  std::vector<int> remaining;
  std::vector<GroupPlan> groups;
  std::vector<CondensedBlock> condensed;  ///< [r * n_r + r']
};

/// Adds the remaining blocks, their graphs and positions to a plan of the groups. Collective.
void plan_condensed(const BlockProblem& problem, EliminationPlan& plan);

/// Returns the plan of the elimination. Throws an Error on all ranks if blocks violate the conditions of LocalGroup.
/// Collective.
EliminationPlan plan_elimination(const BlockProblem& problem);

}  // namespace sprekk::solve
