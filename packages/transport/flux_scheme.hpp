// Selection of the flux scheme of a scene.
#pragma once

#include "fields/properties.hpp"
#include "laws/darcy.hpp"
#include "transport/hybrid_cell.hpp"

#include <string>

namespace sprekk::transport {

/// Entry "scheme" of a scene section, and the rock property that determines the flows, e.g. "permeability".
struct SchemeEntry {
  std::string section, name, property;
};

struct ChosenScheme {
  FluxScheme scheme;
  std::string reason;
};

/// Scheme of the given name. "auto" selects rt0 on simplices. On other cells it selects tpfa if tpfa is exact for
/// constant gradients, i.e. if all (k/mu) A_i are parallel to d_i to 1e-10. Otherwise it selects mimetic. Throws an
/// Error for rt0 on other cells. Collective.
ChosenScheme flux_scheme(const SchemeEntry& entry, const mesh::Mesh& mesh,
                         const fields::Properties<laws::Mobility>& mobility);
/// Warning about tpfa where it is not exact; empty: none. Collective.
std::string scheme_warning(const SchemeEntry& entry, const mesh::Mesh& mesh,
                           const fields::Properties<laws::Mobility>& mobility);
std::string name_of(FluxScheme scheme);

}  // namespace sprekk::transport
