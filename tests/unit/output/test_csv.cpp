#include "talus/output/csv.h"

#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "support/file_errors.h"
#include "support/folder.h"
#include "talus/base/error.h"

namespace test_csv {

namespace {

namespace fs = std::filesystem;
using namespace talus;
using namespace talus::test;

}  // namespace

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
  CHECK(holds(message("a,b\n1,2\n# note\n3,x4\n"), path.string() + ":4: \"x4\" is not a number"));
  CHECK(holds(message("a,b\n1,2\n3,4 m\n"), path.string() + ":3: \"4 m\" is not a number"));
  CHECK(holds(message("a,b\n1,\n"), path.string() + ":2: \"\" is not a number"));
  CHECK(holds(message("a,b\n1\n"), path.string() + ":2: has 1 cells, the header 2"));
  CHECK(holds(message("a,b\n1,2,3\n"), path.string() + ":2: has 3 cells, the header 2"));
  CHECK(holds(message("# nothing\n"), path.string() + ": is empty"));
  const std::string missing = error_of([&] { read_csv(folder / "none.csv"); });
  CHECK(holds(missing, "none.csv"));
  CHECK(holds(missing, "No such file or directory"));
}

TEST_CASE("a column is found by its name or by the only beginning") {
  CsvTable table;
  table.columns = {"t [s]", "tip u_x [m]", "tip", "tip u_y [m]"};
  table.values = {{1}, {2}, {3}, {4}};
  CHECK(table.column("t [s]") == std::vector<double>{1});
  CHECK(table.column("tip u_y") == std::vector<double>{4});
  CHECK(table.column("tip") == std::vector<double>{3});  // a whole name goes before beginnings
  const std::string two = error_of([&] { table.column("tip u"); });
  CHECK(holds(two, "more than one column begins with \"tip u\""));
  CHECK(holds(two, "tip u_x [m]"));
  const std::string none = error_of([&] { table.column("u_x"); });
  CHECK(holds(none, "there is no column \"u_x\""));
  CHECK(holds(none, "tip or tip u_y [m]"));
}

TEST_CASE("a table that meets the end of the disk ends with a whole row, and tells") {
  // a limit on the size of files, in a process of its own, stands for the disk
  const Folder folder;
  const fs::path path = folder / "a.csv";
  for (const unsigned limit : {1000u, 70001u, 200003u}) {
    CAPTURE(limit);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit most{limit, limit};
      setrlimit(RLIMIT_FSIZE, &most);
      try {
        CsvWriter writer(path, {"t [s]", "v"});
        for (int i = 0; i < 100000; ++i) writer.append({i / 3.0, -i / 7.0});
        writer.flush();
        _exit(1);
      } catch (const FileError& e) {
        _exit(holds(e.what(), path.string() + ": cannot be written: File too large") ? 0 : 2);
      }
    }
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    const CsvTable table = read_csv(path, LastLine::kMustEnd);
    CHECK_FALSE(table.cut_short);
    REQUIRE(table.rows() > 0);
    CHECK(fs::file_size(path) > limit - 60);
    for (size_t i = 0; i < table.rows(); ++i) REQUIRE(table.values[0][i] == static_cast<double>(i) / 3.0);
  }
}

TEST_CASE("a table cut anywhere is read up to its last whole row, never with another number") {
  const Folder folder;
  const fs::path path = folder / "a.csv";
  {
    CsvWriter writer(path, {"t [s]", "v"});
    for (int i = 0; i < 5; ++i) writer.append({0.1 * i, 1e5 / (i + 3)});
    writer.flush();
  }
  const std::string all = content(path);
  const CsvTable whole = read_csv(path, LastLine::kMustEnd);
  REQUIRE(whole.rows() == 5);
  CHECK_FALSE(whole.cut_short);
  for (size_t size = 0; size < all.size(); ++size) {
    CAPTURE(size);
    const CsvTable part = parse_csv("a", all.substr(0, size), LastLine::kMustEnd);
    CHECK(part.cut_short == (size > 0 && all[size - 1] != '\n'));
    const auto lines = std::count(all.begin(), all.begin() + static_cast<long>(size), '\n');
    REQUIRE(part.rows() == static_cast<size_t>(std::max(lines - 1, 0L)));
    CHECK(part.columns.size() == (lines > 0 ? 2 : 0));
    for (size_t c = 0; c < part.columns.size(); ++c)
      for (size_t i = 0; i < part.rows(); ++i) REQUIRE(part.values[c][i] == whole.values[c][i]);
    // as a power cut leaves it: as long as it was, and zeros
    const CsvTable zeros =
        parse_csv("a", all.substr(0, size) + std::string(all.size() - size, '\0'), LastLine::kMustEnd);
    CHECK(zeros.rows() == part.rows());
    CHECK(zeros.cut_short);
  }
}

TEST_CASE("a table that goes on is cut back to where it was, and is no link to another") {
  const Folder folder;
  const fs::path path = folder / "a.csv";
  put(path, "a,b\n1,2\n3,4\n5,");
  {
    CsvWriter writer(path, int64_t{8});
    CHECK(writer.size() == 8);
    writer.append({7, 8});
    writer.flush();
  }
  CHECK(content(path) == "a,b\n1,2\n7,8\n");
  CHECK(holds(error_of([&] { CsvWriter(path, int64_t{100}); }), "it cannot be continued"));
  CHECK(holds(error_of([&] { CsvWriter(path, int64_t{-1}); }), "it cannot be continued"));
  fs::create_symlink(path, folder / "link.csv");
  CHECK(holds(error_of([&] { CsvWriter(folder / "link.csv", int64_t{4}); }), "is a link"));
  CHECK(holds(error_of([&] { CsvWriter(folder / "link.csv", {"a"}); }), "is a link"));
  fs::create_hard_link(path, folder / "twin.csv");
  CHECK(holds(error_of([&] { CsvWriter(folder / "twin.csv", int64_t{4}); }), "under 2 names"));
  CHECK(content(path) == "a,b\n1,2\n7,8\n");
}

}  // namespace test_csv
