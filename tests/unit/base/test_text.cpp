#include "talus/base/text.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace test_text {

using namespace talus;

TEST_CASE("closest_name finds the name with the fewest edits") {
  const std::vector<std::string> keys{"density", "young", "poisson", "name"};
  CHECK(closest_name("densty", keys) == "density");   // one letter missing
  CHECK(closest_name("younng", keys) == "young");     // one letter too many
  CHECK(closest_name("poissen", keys) == "poisson");  // one letter wrong
  CHECK(closest_name("nmae", keys) == "name");        // two letters swapped
  CHECK(closest_name("density", keys) == "density");  // nothing wrong
  CHECK(closest_name("dens", keys) == "density");     // its beginning, although three letters are missing
  CHECK(closest_name("velocity", keys) == "");        // nothing near
  CHECK(closest_name("densty", {}) == "");            // nothing known
  CHECK(closest_name("bonde", {"bands", "bonded"}) == "bonded");  // one edit wins over two
  CHECK(closest_name("bonde", {"bonded", "bands"}) == "bonded");  // in either order
}

TEST_CASE("closest_name counts a swap of neighbours as one edit") {
  // "ab" -> "ba" is one swap or two replacements; the second entry is two replacements away
  CHECK(closest_name("abcdef", {"abxyef", "bacdef"}) == "bacdef");
  CHECK(closest_name("abcdef", {"badcxf", "bacdef"}) == "bacdef");
}

TEST_CASE("join_or") {
  CHECK(join_or({}) == "");
  CHECK(join_or({"a"}) == "a");
  CHECK(join_or({"a", "b"}) == "a or b");
  CHECK(join_or({"a", "b", "c"}) == "a, b or c");
}

TEST_CASE("readable_bytes takes the unit in which the number stays below a thousand") {
  CHECK(readable_bytes(0) == "0 B");
  CHECK(readable_bytes(950) == "950 B");
  CHECK(readable_bytes(999.4) == "999 B");
  CHECK(readable_bytes(999.6) == "1 kB");  // would be written 1000 B
  CHECK(readable_bytes(12345) == "12.3 kB");
  CHECK(readable_bytes(999499) == "999 kB");
  CHECK(readable_bytes(999501) == "1 MB");
  CHECK(readable_bytes(4.5e6) == "4.5 MB");
  CHECK(readable_bytes(7.25e9) == "7.25 GB");
  CHECK(readable_bytes(3e12) == "3 TB");
}

TEST_CASE("readable_seconds changes its form at a second, two minutes, two hours and three days") {
  CHECK(readable_seconds(0) == "0 ms");
  CHECK(readable_seconds(0.85) == "850 ms");
  CHECK(readable_seconds(0.9994) == "999 ms");
  CHECK(readable_seconds(0.9996) == "1 s");
  CHECK(readable_seconds(12.345) == "12.3 s");
  CHECK(readable_seconds(119.4) == "119 s");
  CHECK(readable_seconds(119.6) == "2 min 00 s");
  CHECK(readable_seconds(245) == "4 min 05 s");
  CHECK(readable_seconds(3599.7) == "60 min 00 s");
  CHECK(readable_seconds(7199) == "119 min 59 s");
  CHECK(readable_seconds(7199.6) == "2 h 00 min");
  CHECK(readable_seconds(7380) == "2 h 03 min");
  CHECK(readable_seconds(180000) == "50 h 00 min");
  CHECK(readable_seconds(360000) == "4 days");
}

TEST_CASE("text_hash is FNV-1a with 64 bits") {
  // published test vectors of the hash
  CHECK(text_hash("") == "cbf29ce484222325");
  CHECK(text_hash("a") == "af63dc4c8601ec8c");
  CHECK(text_hash("foobar") == "85944171f73967e8");
  CHECK(text_hash("\xff") == "af64724c8602eb6e");  // bytes above 127 count without sign
  CHECK(text_hash(std::string("a\0b", 3)) != text_hash("a"));
}

}  // namespace test_text
