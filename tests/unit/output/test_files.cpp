#include "talus/output/files.h"

#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

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

namespace test_files {

namespace {

namespace fs = std::filesystem;
using namespace talus;
using namespace talus::test;

}  // namespace

TEST_CASE("write_file writes every byte, replaces, and leaves nothing beside") {
  const Folder folder;
  const std::string bytes("line\r\n\0\xff end", 12);
  write_file(folder / "a.txt", "an older and longer text than the new one");
  write_file(folder / "a.txt", bytes);
  CHECK(content(folder / "a.txt") == bytes);
  write_file(folder / "empty", "", Reach::kDisk);
  CHECK(fs::file_size(folder / "empty") == 0);
  CHECK(count_in(folder.path()) == 2);
}

TEST_CASE("write_file reports path and cause, and keeps the old file") {
  const Folder folder;
  const fs::path missing = folder / "missing" / "a.txt";
  const std::string text = error_of([&] { write_file(missing, "x"); });
  CHECK(holds(text, missing.string()));
  CHECK(holds(text, "No such file or directory"));
  fs::create_directories(folder / "taken" / "x");
  CHECK(holds(error_of([&] { write_file(folder / "taken", "x"); }), "taken: is a folder"));
  CHECK(fs::exists(folder / "taken" / "x"));
  CHECK(count_in(folder.path()) == 1);
}

TEST_CASE("write_file replaces regular files only, and follows no link") {
  const Folder folder;
  put(folder / "target", "precious");
  fs::create_symlink(folder / "target", folder / "link");
  CHECK(holds(error_of([&] { write_file(folder / "link", "x"); }), "link: is a link"));
  fs::create_symlink(folder / "nowhere", folder / "dangling");
  CHECK(holds(error_of([&] { write_file(folder / "dangling", "x"); }), "dangling: is a link"));
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK(holds(error_of([&] { write_file(folder / "pipe", "x"); }), "pipe: is a pipe"));
  CHECK(holds(error_of([&] { write_file("/dev/null", "x"); }), "/dev/null: is a device"));
  CHECK(content(folder / "target") == "precious");
  CHECK_FALSE(fs::exists(folder / "nowhere"));
  // nor has the name under which it writes ever been a link that someone laid there
  for (int i = 0; i < 1000; ++i)
    fs::create_symlink(folder / "target",
                       folder / (".talus-" + std::to_string(getpid()) + "-" + std::to_string(i) + ".part"));
  try {
    write_file(folder / "fresh", "x");
    CHECK(content(folder / "fresh") == "x");
  } catch (const FileError&) {
  }
  CHECK(content(folder / "target") == "precious");
}

TEST_CASE("a replaced file keeps its permissions") {
  const Folder folder;
  write_file(folder / "a", "1");
  REQUIRE(chmod((folder / "a").c_str(), 0640) == 0);
  write_file(folder / "a", "2");
  CHECK(content(folder / "a") == "2");
  CHECK((fs::status(folder / "a").permissions() & fs::perms::mask) == fs::perms(0640));
}

TEST_CASE("a file that was not finished is known by its name") {
  CHECK(is_unfinished_file("out/.talus-12-0.part"));
  CHECK_FALSE(is_unfinished_file("out/report.html"));
  CHECK_FALSE(is_unfinished_file("out/.talus-.part"));
}

}  // namespace test_files
