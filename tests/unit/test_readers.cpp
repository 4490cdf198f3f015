// Every reader with the texts its fuzzer begins with, whole, cut off and with single bytes changed: what it
// does not take it refuses with an error of its own. (Crashes show in the sanitizer build.)

#include <doctest/doctest.h>

#include <filesystem>

#include "support/readers.h"
#include "talus/base/random.h"
#include "talus/base/text_file.h"

namespace test_readers {

using namespace talus;
using namespace talus::test;

TEST_CASE("readers: seeds of the fuzzers, whole and damaged") {
  for (const auto& [name, reader] : readers()) {
    int taken = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(TALUS_SOURCE_DIR "/tests/fuzz_seeds/" + name)) {
      INFO(entry.path().string());
      const std::string whole = read_text_file(entry.path());
      taken += takes(name, whole);
      Random random(stream_seed(1, entry.path().filename().string()));
      for (int k = 0; k < 40; ++k) {
        std::string text =
            whole.substr(0, static_cast<size_t>(random.uniform() * static_cast<double>(whole.size())));
        CHECK_NOTHROW(takes(name, text));
        text = whole;
        for (int n = 0; n < 3 && !text.empty(); ++n)
          text[static_cast<size_t>(random.uniform() * static_cast<double>(text.size()))] =
              static_cast<char>(random.next());
        CHECK_NOTHROW(takes(name, text));
      }
    }
    INFO(name);
    CHECK(taken > 0);  // at least one seed is a sound text
  }
}

}  // namespace test_readers
