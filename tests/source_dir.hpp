// Location of scenes and meshes for tests.
#pragma once

#include <string>

namespace sprekk::tests {

/// Returns the top folder of the repository. Only main.cpp depends on the path, so that compiler caches can reuse all
/// other objects in another copy of the repository.
std::string source_dir();

}  // namespace sprekk::tests
