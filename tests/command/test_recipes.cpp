// The recipes of the documentation (docs/recipes): their files and commands, one behind the other, as a reader would
// type them, and the lines that they say are printed.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "support/command.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"

namespace test_recipes {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

const fs::path kRecipes = fs::path(TALUS_SOURCE_DIR) / "docs/recipes";

struct Block {
  std::vector<std::string> info;  // words behind the fence
  std::string text;
};

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string w; in >> w;) words.push_back(w);
  return words;
}

// Fenced blocks of a page in Markdown.
std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> list;
  std::istringstream in(page);
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("```", 0) != 0) {
      if (inside) list.back().text += line + "\n";
      continue;
    }
    inside = !inside;
    if (inside) list.push_back({words_of(line.substr(3)), ""});
  }
  return list;
}

// White space counts as one blank.
std::string flat(const std::string& text) {
  std::string out;
  for (const std::string& w : words_of(text)) out += (out.empty() ? "" : " ") + w;
  return out;
}

void follow(const std::string& name) {
  const Folder f;
  int commands = 0, promised = 0;
  std::string said;
  for (const Block& b : blocks_of(read_text_file(kRecipes / (name + ".md")))) {
    if (b.info.size() == 2 && b.info[1].find('.') != std::string::npos) write_file(f / b.info[1], b.text);
    if (b.info.size() == 1 && b.info[0] == "sh") {
      const Outcome o =
          shell(f, fmt::format("talus() {{ \"$talus\" \"$@\"; }}; TALUS_EXAMPLES='{}/examples'; set -e\n{}",
                               TALUS_SOURCE_DIR, b.text));
      INFO(name, ":\n", b.text, "\n", o.text);
      REQUIRE(o.code == 0);
      said = flat(o.text), ++commands;
    }
    if (b.info.size() == 1 && b.info[0] == "text") {
      std::istringstream lines(b.text);
      for (std::string line; std::getline(lines, line);) {
        line = flat(line);
        if (line.empty() || line == "...") continue;
        INFO(name, " promises: ", line, "\nand this is printed: ", said);
        CHECK(said.find(line) != std::string::npos);
        ++promised;
      }
    }
  }
  CHECK(commands > 0);
  CHECK(promised > 0);
}

}  // namespace

TEST_SUITE_BEGIN("optimised");  // too long for the sanitizers; what they run is in other tests

TEST_CASE("recipe: slope_factor") { follow("slope_factor"); }
TEST_CASE("recipe: slope_earthquake_bolts") { follow("slope_earthquake_bolts"); }
TEST_CASE("recipe: facade") { follow("facade"); }
TEST_CASE("recipe: arch") { follow("arch"); }
TEST_CASE("recipe: staged_tunnel") { follow("staged_tunnel"); }
TEST_CASE("recipe: blast") { follow("blast"); }
TEST_CASE("recipe: many_runs") { follow("many_runs"); }
#ifdef TALUS_WITH_MAPS
TEST_CASE("recipe: from_map") { follow("from_map"); }
#endif
TEST_CASE("recipe: from_gmsh") { follow("from_gmsh"); }

TEST_CASE("recipe: there is none besides these, and the list names them all") {
  std::vector<std::string> pages;
  for (const auto& e : fs::directory_iterator(kRecipes))
    if (e.path().extension() == ".md" && e.path().stem() != "README")
      pages.push_back(e.path().stem().string());
  CHECK(pages.size() == 9);
  const std::string list = read_text_file(kRecipes / "README.md");
  for (const std::string& page : pages) has(list, "(" + page + ".md)");
}

TEST_SUITE_END();

}  // namespace test_recipes
