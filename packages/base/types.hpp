// Types used by all packages.
#pragma once

#include "base/view.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_RCP.hpp>

namespace sprekk {

using Comm = Teuchos::Comm<int>;
using Teuchos::RCP;
using Teuchos::rcp;

}  // namespace sprekk
