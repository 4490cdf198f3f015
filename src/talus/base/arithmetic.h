#pragma once
// The functions of the mathematics library, whose last digits are those of its version and of the processor.

#include <string>

namespace talus {

/// A digest of the last bits of sin, cos, tan, exp, pow ... at many places. Programs of one version whose digests are the same give
/// the same bits; where they differ, results may differ from the last digit on. 16 hexadecimal digits.
std::string arithmetic_digest();

}  // namespace talus
