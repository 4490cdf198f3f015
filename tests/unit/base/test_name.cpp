#include "talus/base/index.h"
#include "talus/base/name.h"

#include <doctest/doctest.h>

#include <set>
#include <string>

namespace test_name {

using namespace talus;

TEST_CASE("names: what may be one, and why not") {
  for (const char* name : {"a", "top of the wall", "Wand-1", "x_2", "Südwand", "a+b", "(rock)", "5", "a=b"})
    CHECK_MESSAGE(name_defect(name).empty(), name);
  const auto why = [](const std::string& name, const std::string& part) {
    INFO(name);
    CHECK(name_defect(name).find(part) != std::string::npos);
  };
  why("", "empty");
  why("/etc/passwd", "separator of paths");
  why("a/b", "separator of paths");
  why("a\\b", "separator of paths");
  why("..", "no dot");
  for (const char* name : {"a.b", "a,b", "a\"b", "a[1", "a]"}) why(name, "no dot, comma, quote or bracket");
  for (const char* name : {"=1+1", "+a", "-a", "@a"}) why(name, "spreadsheets");
  for (const char* name : {" a", "a ", " "}) why(name, "blank");
  for (const std::string& name : {std::string("a\0b", 3), std::string("a\rb"), std::string("a\nb"),
                                  std::string("\x1b[31m"), std::string("a\x7f"), std::string("a\xc2\x85")})
    why(name, "control character");
  why(std::string(101, 'x'), "longer than 100");
  CHECK(name_defect(std::string(100, 'x')).empty());
  CHECK(shown_name(std::string("a\r\0b", 4)) == "a\\x0d\\x00b");
}

TEST_CASE("file names made of any text stay in their folder and apart") {
  CHECK(file_name_of("top.velocity_x") == "top.velocity_x");
  CHECK(file_name_of("a b (c)") == "a b (c)");
  CHECK(file_name_of("../x") == "%2E.%2Fx");
  CHECK(file_name_of("/abs") == "%2Fabs");
  CHECK(file_name_of("..") == "%2E.");
  CHECK(file_name_of("-o") == "%2Do");
  CHECK(file_name_of("a\nb") == "a%0Ab");
  CHECK(file_name_of("Süd") == "Süd");
  std::set<std::string> made;
  int texts = 0;
  const std::string long_one(500, 'x');
  for (const std::string& text : {std::string(), std::string("%"), std::string("%25"), std::string("a/b"),
                                  std::string("a%2Fb"), std::string("."), std::string("a"),
                                  std::string("a\0", 2), long_one, long_one + "y", "y" + long_one}) {
    const std::string name = file_name_of(text);
    INFO(name);
    CHECK(!name.empty());
    CHECK(name.size() <= 200);
    CHECK(name.find('/') == std::string::npos);
    CHECK(name.front() != '.');
    made.insert(name), ++texts;
  }
  CHECK(count_of(made) == texts);
}

}  // namespace test_name
