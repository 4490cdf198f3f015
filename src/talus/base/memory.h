#pragma once
// Memory of this machine.

namespace talus {

/// Memory that programs may still take [bytes], as the operating system says; infinite where it does not.
double available_memory();

}  // namespace talus
