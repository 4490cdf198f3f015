#pragma once
// How a step is dealt out to threads. Not for use outside step/.

#include <cstddef>

namespace talus {

/// Blocks and rows to a chunk. Sums are taken chunk by chunk: these numbers are part of the result's last
/// bits.
inline constexpr size_t kChunkOfBlocks = 512, kChunkOfRows = 1024;

}  // namespace talus
