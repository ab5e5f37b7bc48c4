// Checkpoints in a directory. A checkpoint is complete or absent, even if the program is killed.
#pragma once

#include "io/hdf5.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <vector>

namespace sprekk::io {

/// Size and checksum, to detect damaged data.
using Seal = std::array<long long, 2>;

/// Content of a checkpoint: distributed vectors, and data that are equal on all ranks.
struct Checkpoint {
  NamedVectors vectors;
  nlohmann::json content;
  std::vector<nlohmann::json> journal;  ///< write(): new entries since the last checkpoint; read(): all
};

/// Numbered checkpoints in PATH/NUMBER/. Each has a manifest.json and a piece_RANK.h5 for every rank that wrote it. A
/// checkpoint is written under the name NUMBER.part, flushed to disk, and renamed when it is complete. The last two are
/// retained.
///
/// PATH/journal and its copy PATH/journal_copy contain the journal of all checkpoints, one entry on each line. A
/// checkpoint stores the length of its journal. New entries are appended after this length. All members are collective
/// and throw the same Error on every rank.
class Checkpoints {
 public:
  /// Stores the path and does not access the disk. If checkpoints exist, call clear() or read() first.
  Checkpoints(RCP<const Comm> comm, std::string path);

  /// Removes all checkpoints, so that those of another run are not mistaken for those of this run.
  void clear();

  /// Adds a checkpoint. Then removes all others except the one last read or written before. Throws an Error with the
  /// path and the system's reason; earlier checkpoints are then unchanged.
  void write(const Checkpoint& checkpoint);

  /// Returns the last undamaged checkpoint, on any number of ranks. Each rank reads its share of the pieces, which
  /// determines the distribution of the vectors. Appends to `damage` one line for each later checkpoint and each
  /// journal file that is damaged, with the replacement. Throws an Error if there is no undamaged checkpoint.
  Checkpoint read(std::vector<std::string>& damage);

 private:
  std::string folder(long long number) const;
  std::vector<long long> numbers() const;  ///< complete checkpoints, ascending; same on all ranks
  Checkpoint read(long long number, Seal& journal) const;
  /// Returns the journal up to the seal from either file and repairs the other. Appends damaged files to `damage`.
  std::string read_journal(const Seal& seal, std::vector<std::string>& damage) const;

  RCP<const Comm> comm_;
  std::string path_;
  long long last_ = -1;  ///< number of the checkpoint last read or written
  Seal journal_{};       ///< seal of its journal
};

}  // namespace sprekk::io
