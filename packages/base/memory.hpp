// How much memory there is.
#pragma once

#include <string>

namespace sprekk::base {

/// Bytes that this process could take at most: of the machine, of its control group, or of its own limit (ulimit -v).
/// Stored by the system. Not collective.
double memory_limit();

/// What to say where memory has ended: what this process has taken, what there is, and what helps.
std::string out_of_memory();

}  // namespace sprekk::base
