#pragma once
// A moving PNG (APNG, W3C PNG specification 3, chunks acTL, fcTL and fdAT) of pictures of one size. Not for use outside
// plot/.

#include <string>
#include <vector>

namespace talus::plot {

/// @param frames   bytes of PNG files of the same size and kind
/// @param seconds  that each is shown; the last one four times as long
std::string animated_png(const std::vector<std::string>& frames, double seconds);

}  // namespace talus::plot
