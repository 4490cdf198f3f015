#pragma once
// Memory kept back for the moment when there is none left: what is under way then can come to an orderly end.

#include <cstddef>

namespace talus {

/// Keeps memory back from now on. The first allocation that fails gets it and goes on; the next ones that fail throw
/// std::bad_alloc as ever. Libraries that end the process where they find no memory are spared that.
void keep_memory_reserve(size_t bytes);

/// Whether the reserve has been used: whoever works in steps should stop before the next one.
bool memory_is_short() noexcept;

}  // namespace talus
