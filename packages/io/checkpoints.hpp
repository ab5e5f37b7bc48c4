// Checkpoints in a directory: complete or not there at all, whenever the program is killed.
#pragma once

#include "io/hdf5.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <vector>

namespace sprekk::io {

/// Size and checksum, by which bytes are known to be those that were written.
using Seal = std::array<long long, 2>;

/// What one checkpoint holds: values that are spread over the ranks, and what is the same on all of them.
struct Checkpoint {
  NamedVectors vectors;
  nlohmann::json content;
  std::vector<nlohmann::json> journal;  ///< written: what is new since the checkpoint before; read: all of it
};

/// Numbered checkpoints, PATH/NUMBER/, each a manifest.json and a piece_RANK.h5 for every rank that wrote it. One is
/// written under the name NUMBER.part, brought to the disk, and renamed when it is complete. The last two are kept.
/// PATH/journal and its copy PATH/journal_copy hold the journal of all, an entry a line; a checkpoint knows how much of
/// it is its own, and more is only ever added behind the end of the last. All members are collective, with the same
/// Error on every rank.
class Checkpoints {
 public:
  /// Changes nothing on the disk. Where there are checkpoints, clear() or read() comes next.
  Checkpoints(RCP<const Comm> comm, std::string path);

  /// Removes all checkpoints: those of another run must not pass for those of this one.
  void clear();

  /// Adds a checkpoint, and then removes all but it and the one that was last read or written. Error: the path and the
  /// system's reason; earlier checkpoints are as they were.
  void write(const Checkpoint& checkpoint);

  /// The last checkpoint that is undamaged, on any number of ranks: each rank reads its share of the pieces, so the
  /// vectors are spread as these are. Appends to `damage` what is wrong with those after it and with one of the two
  /// journals, and what is taken instead, a line each. Error: there is none.
  Checkpoint read(std::vector<std::string>& damage);

 private:
  std::string folder(long long number) const;
  std::vector<long long> numbers() const;  ///< complete ones, ascending; the same on all ranks
  Checkpoint read(long long number, Seal& journal) const;
  /// The journal up to the seal, of either file; afterwards both hold it. Appends to `damage` which one did not.
  std::string read_journal(const Seal& seal, std::vector<std::string>& damage) const;

  RCP<const Comm> comm_;
  std::string path_;
  long long last_ = -1;  ///< number of the one last read or written
  Seal journal_{};       ///< of its journal
};

}  // namespace sprekk::io
