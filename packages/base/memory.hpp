// Available memory.
#pragma once

#include <string>

namespace sprekk::base {

/// Returns the memory in bytes that this process may use: the smallest of physical memory, limit of its control group
/// and address space limit (ulimit -v). Not collective.
double memory_limit();

/// Returns a message for an out-of-memory error: memory used by this process, memory limit, and remedies.
std::string out_of_memory();

}  // namespace sprekk::base
