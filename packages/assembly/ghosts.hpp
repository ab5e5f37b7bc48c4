// Unknowns with ghosts.
#pragma once

#include "assembly/structure.hpp"

#include <vector>

namespace sprekk::assembly {

/// Values of the unknowns on this rank and of the ghosts that modules read. Refers to the structure.
class Ghosts {
 public:
  explicit Ghosts(const Structure& structure);

  enum class Which { read, all };  ///< read: ghosts of blocks in Structure::exchanged
  /// Copies x and exchanges its ghosts. Collective.
  void exchange(const fields::BlockVector& x, Which which);
  void set_zero();

  const fields::BlockVector& vectors() const { return vectors_; }  ///< [block]
  std::vector<ConstView<Real*>> views() const;                     ///< [block](unknown)

 private:
  const Structure& structure_;
  fields::BlockVector vectors_;
};

}  // namespace sprekk::assembly
