#pragma once
// Version of the program and of the model file format it reads.

namespace talus {

inline constexpr const char* kVersion = "0.1.0";
inline constexpr int kModelFormat = 1;

}  // namespace talus
