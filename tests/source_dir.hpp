// Where tests find scenes and meshes.
#pragma once

#include <string>

namespace sprekk::tests {

/// The top of the repository. Only main.cpp is compiled with it, so that compilers' caches know all other sources again
/// in another copy of the repository.
std::string source_dir();

}  // namespace sprekk::tests
