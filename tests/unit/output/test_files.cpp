#include "talus/output/files.h"

#include <doctest/doctest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "support/folder.h"
#include "talus/base/error.h"

namespace test_files {

namespace {

namespace fs = std::filesystem;
using namespace talus;
using namespace talus::test;

// A folder of its own that disappears with the test.

void put(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

auto count_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

// Text of the FileError that `action` must throw.
std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& e) {
    CHECK(e.code() == kExitFile);
    return e.what();
  }
  FAIL("no FileError");
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("write_file writes every byte, replaces, and leaves nothing beside") {
  const Folder folder;
  const std::string bytes("line\r\n\0\xff end", 12);
  write_file(folder / "a.txt", "an older and longer text than the new one");
  write_file(folder / "a.txt", bytes);
  CHECK(content(folder / "a.txt") == bytes);
  write_file(folder / "empty", "");
  CHECK(fs::file_size(folder / "empty") == 0);
  CHECK(count_in(folder.path()) == 2);
}

TEST_CASE("write_file reports path and cause, and keeps the old file") {
  const Folder folder;
  const fs::path missing = folder / "missing" / "a.txt";
  const std::string text = error_of([&] { write_file(missing, "x"); });
  CHECK(has(text, missing.string()));
  CHECK(has(text, "No such file or directory"));
  fs::create_directories(folder / "taken" / "x");
  CHECK(has(error_of([&] { write_file(folder / "taken", "x"); }), (folder / "taken").string()));
  CHECK(fs::exists(folder / "taken" / "x"));
}

TEST_CASE("a device without space is reported") {
  const fs::path full = "/dev/full";
  if (!fs::exists(full)) return;
  const auto fill = [&] {
    CsvWriter writer(full, {"t [s]"});
    for (int i = 0; i < 10000; ++i) writer.append({0.1 * i});
    writer.flush();
  };
  const std::string text = error_of(fill);
  CHECK(has(text, "/dev/full"));
  CHECK(has(text, "free some space"));
}

TEST_CASE("numbers come back from a CSV file to the last bit") {
  const Folder folder;
  using Limits = std::numeric_limits<double>;
  std::vector<double> numbers{0.0,
                              -0.0,
                              0.1,
                              1.0 / 3,
                              Limits::max(),
                              Limits::min(),
                              -5e-324,
                              2.3e-310,
                              Limits::epsilon(),
                              -1e22,
                              1e23,
                              123456789e-20,
                              9007199254740993.0};
  std::mt19937_64 random(1);
  while (numbers.size() < 1000) {
    const double mantissa = std::uniform_real_distribution<double>(-1, 1)(random);
    numbers.push_back(std::ldexp(mantissa, std::uniform_int_distribution<int>(-1070, 1020)(random)));
  }
  const fs::path path = folder / "a.csv";
  {
    CsvWriter writer(path, {"t [s]", "u [m]"});
    for (const double v : numbers) writer.append({v, -v});
    writer.flush();
  }
  const CsvTable table = read_csv(path);
  CHECK(table.columns == std::vector<std::string>{"t [s]", "u [m]"});
  REQUIRE(table.rows() == numbers.size());
  for (size_t i = 0; i < numbers.size(); ++i) {
    CAPTURE(numbers[i]);
    CHECK(table.values[0][i] == numbers[i]);
    CHECK(std::signbit(table.values[0][i]) == std::signbit(numbers[i]));
    CHECK(table.values[1][i] == -numbers[i]);
  }
}

TEST_CASE("numbers that are not finite come back as such") {
  const Folder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const fs::path path = folder / "a.csv";
  {
    CsvWriter writer(path, {"v"});
    for (const double v : {nan, -nan, inf, -inf}) writer.append({v});
    writer.flush();
  }
  const CsvTable table = read_csv(path);
  REQUIRE(table.rows() == 4);
  CHECK(std::isnan(table.values[0][0]));
  CHECK(std::isnan(table.values[0][1]));
  CHECK(table.values[0][2] == inf);
  CHECK(table.values[0][3] == -inf);
}

TEST_CASE("rows are in the file after flush") {
  const Folder folder;
  const fs::path path = folder / "a.csv";
  CsvWriter writer(path, {"a", "b"});
  CHECK(content(path) == "a,b\n");  // the header at once
  writer.append({1, 2.5});
  writer.flush();
  CHECK(content(path) == "a,b\n1,2.5\n");
}

TEST_CASE("read_csv accepts comments, empty lines and either line end") {
  const Folder folder;
  const fs::path path = folder / "a.csv";
  put(path, "# source\r\nt,v\r\n\r\n0,1\r\n# middle\n2,-3e2");
  const CsvTable table = read_csv(path);
  CHECK(table.columns == std::vector<std::string>{"t", "v"});
  CHECK(table.column("v") == std::vector<double>{1, -300});
}

TEST_CASE("read_csv names file and line of what it cannot read") {
  const Folder folder;
  const fs::path path = folder / "a.csv";
  const auto message = [&](const std::string& text) {
    put(path, text);
    return error_of([&] { read_csv(path); });
  };
  CHECK(has(message("a,b\n1,2\n# note\n3,x4\n"), path.string() + ":4: \"x4\" is not a number"));
  CHECK(has(message("a,b\n1,2\n3,4 m\n"), path.string() + ":3: \"4 m\" is not a number"));
  CHECK(has(message("a,b\n1,\n"), path.string() + ":2: \"\" is not a number"));
  CHECK(has(message("a,b\n1\n"), path.string() + ":2: has 1 cells, the header 2"));
  CHECK(has(message("a,b\n1,2,3\n"), path.string() + ":2: has 3 cells, the header 2"));
  CHECK(has(message("# nothing\n"), path.string() + ": is empty"));
  const std::string missing = error_of([&] { read_csv(folder / "none.csv"); });
  CHECK(has(missing, "none.csv"));
  CHECK(has(missing, "No such file or directory"));
}

TEST_CASE("a column is found by its name or by the only beginning") {
  CsvTable table;
  table.columns = {"t [s]", "tip u_x [m]", "tip", "tip u_y [m]"};
  table.values = {{1}, {2}, {3}, {4}};
  CHECK(table.column("t [s]") == std::vector<double>{1});
  CHECK(table.column("tip u_y") == std::vector<double>{4});
  CHECK(table.column("tip") == std::vector<double>{3});  // a whole name goes before beginnings
  const std::string two = error_of([&] { table.column("tip u"); });
  CHECK(has(two, "more than one column begins with \"tip u\""));
  CHECK(has(two, "tip u_x [m]"));
  const std::string none = error_of([&] { table.column("u_x"); });
  CHECK(has(none, "there is no column \"u_x\""));
  CHECK(has(none, "tip or tip u_y [m]"));
}

TEST_CASE("open_result_folder") {
  const Folder base;
  const fs::path folder = base / "deep" / "result";
  SUBCASE("a fresh folder is made, with its parents") {
    open_result_folder(folder, false);
    CHECK(fs::is_directory(folder));
    CHECK(count_in(folder) == 0);
    open_result_folder(folder, false);  // empty: nothing could be lost
  }
  SUBCASE("earlier results stay without force and go with it; other files stay always") {
    fs::create_directories(folder / "fields");
    fs::create_directories(folder / "plots");
    for (const char* name : {"summary.json", "model.toml", "histories.csv", "steps.csv", "run.log",
                             "fields/blocks.pvd", "plots/a.svg", "notes.txt"})
      put(folder / name, "old");
    CHECK(has(error_of([&] { open_result_folder(folder, false); }), folder.string() + ": exists already"));
    CHECK(count_in(folder) == 8);
    CHECK(content(folder / "summary.json") == "old");
    open_result_folder(folder, true);
    CHECK(count_in(folder) == 1);
    CHECK(content(folder / "notes.txt") == "old");
  }
  SUBCASE("a folder of something else is never touched") {
    fs::create_directories(folder / "fields");
    put(folder / "fields" / "thesis.tex", "precious");
    put(folder / "run.log", "precious");
    CHECK(has(error_of([&] { open_result_folder(folder, true); }), "holds no results of talus"));
    CHECK(content(folder / "fields" / "thesis.tex") == "precious");
    CHECK(content(folder / "run.log") == "precious");
  }
  SUBCASE("a file in its place") {
    put(base / "file", "text");
    CHECK(has(error_of([&] { open_result_folder(base / "file", true); }), "is a file, not a folder"));
    CHECK(has(error_of([&] { open_result_folder(base / "file" / "in", true); }), "cannot be created"));
    CHECK(content(base / "file") == "text");
  }
}

}  // namespace test_files
