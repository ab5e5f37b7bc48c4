// Which scheme a scene's flows follow.
#pragma once

#include "laws/darcy.hpp"
#include "physics/hybrid_cell.hpp"
#include "physics/properties.hpp"

#include <string>

namespace sprekk::physics {

/// The entry "scheme" of a section of a scene, and the property of rock that flows depend on: "permeability".
struct SchemeEntry {
  std::string section, name, property;
};

struct ChosenScheme {
  FluxScheme scheme;
  std::string reason;
};

/// The scheme of that name. "auto": rt0 on simplices; on others tpfa where that is exact for constant gradients (all
/// (k/mu) A_i parallel to d_i, to 1e-10), else mimetic. Throws an Error for rt0 on other cells. Collective.
ChosenScheme flux_scheme(const SchemeEntry& entry, const mesh::Mesh& mesh, const Properties<laws::Mobility>& mobility);
/// What is wrong with tpfa that a scene asks for where it is not exact, empty: nothing. Collective.
std::string scheme_warning(const SchemeEntry& entry, const mesh::Mesh& mesh,
                           const Properties<laws::Mobility>& mobility);
std::string name_of(FluxScheme scheme);

}  // namespace sprekk::physics
