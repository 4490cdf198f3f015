// Entry of libFuzzer: any bytes to the reader TALUS_READER.

#include <cstddef>
#include <cstdint>

#include "support/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  talus::test::takes(TALUS_READER, std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
