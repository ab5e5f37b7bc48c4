// Where every number of a local elimination goes: found once from the graphs of the blocks, used at every update.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

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

View<LocalIndex*> to_device(const LocalIndices& from, const std::string& name);

/// out(target(k) + i) = value k * width + i of the matrix, i < width.
struct Scatter {
  RCP<const CrsMatrix> matrix;
  int width;  ///< so many values always stay together
  View<LocalIndex*> target;

  void operator()(const View<Real*>& out) const;
};

/// A_zz^-1 A_zb of one local group z and one remaining block b. An entity's rows are one dense block [m, its columns],
/// row by row; the columns are the union over the rows. Slots count entities: owned ones first, then the ghosts that
/// rows owned here couple to.
struct Response {
  static constexpr int strip = 8;  ///< columns that a kernel reads at a time; so many numbers follow the last value

  std::vector<Scatter> fill;        ///< A_zb -> values of owned slots
  View<std::size_t*> column_start;  ///< [slot + 1] first column of a slot; its first value is m times that
  View<GlobalIndex*> column;        ///< [all columns] global unknown of b; only while graphs are made
  View<Real*> value;                ///< only in an update
};

/// A_az of one remaining block a: where the numbers stand that couple a row with the unknowns of a slot, in runs of
/// numbers that follow one another there and in the entity.
struct Coupling {
  View<LocalIndex*> row_start;    ///< [owned row + 1] first pair of a row and a slot that couple
  View<LocalIndex*> slot;         ///< [pair]
  View<LocalIndex*> first;        ///< [pair + 1] first run of a pair
  View<LocalIndex*> source;       ///< [run] where it starts in A_az
  View<std::uint8_t*> component;  ///< [run] its first unknown within the entity, of 0 ... m-1, which tells z as well
  View<std::uint8_t*> length;     ///< [run]
};

/// One local group. [r] counts remaining blocks.
struct GroupPlan {
  std::string name;
  std::vector<int> blocks;
  std::vector<int> offset;  ///< first unknown of a block within the entity
  int size = 0;             ///< m: unknowns of one entity
  std::shared_ptr<const Halo> slots;
  std::vector<Scatter> fill;
  View<Real*> dense, lu;           ///< [entity * m * m]
  View<int*> pivot;                ///< [entity * m]
  View<Real*> column_scale;        ///< [m]
  View<Real*> work;                ///< [entity * m]
  std::vector<Response> response;  ///< [r]
  std::vector<Coupling> coupling;  ///< [r]
  /// [r * n_r + r'](column of response r') its column in J, -1 where no row here needs it.
  std::vector<View<LocalIndex*>> column;
};

/// J_ab; matrix is null where nothing couples a and b.
struct CondensedBlock {
  RCP<const Matrix> matrix;
  RCP<const Matrix> bulk;                  ///< A_ab; null: there is none, or it stands in J_ab
  View<LocalIndex*> bulk_column;           ///< [column of A_ab] its column in J_ab
  std::shared_ptr<fields::KeptRows> kept;  ///< of A_ab that stands in J_ab, or null
  View<LocalIndex*> rows;   ///< those that may be other ones than A_ab's, where it stands there; else all
  View<LocalIndex*> held;   ///< rows of unknowns that are prescribed, and those with a column of one
  View<char*> constrained;  ///< [column] 1 where the unknown is prescribed
};

struct EliminationPlan {
  std::vector<int> remaining;
  std::vector<GroupPlan> groups;
  std::vector<CondensedBlock> condensed;  ///< [r * n_r + r']
};

/// Adds the blocks that remain and where everything lands in them, for groups that are planned. Collective.
void plan_condensed(const BlockProblem& problem, EliminationPlan& plan);

/// Collective; throws on all ranks where the blocks do not have the shape that BlockProblem promises.
EliminationPlan plan_elimination(const BlockProblem& problem);

}  // namespace sprekk::solve
