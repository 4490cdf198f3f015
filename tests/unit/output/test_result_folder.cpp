#include "talus/output/result_folder.h"

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
#include "talus/output/folder_lock.h"

namespace test_result_folder {

namespace {

namespace fs = std::filesystem;
using namespace talus;
using namespace talus::test;

}  // namespace

TEST_CASE("a folder of results: made, refused, replaced") {
  const Folder base;
  const fs::path folder = base / "deep" / "result";
  SUBCASE("a fresh folder is made, with its parents, and free again when the results end") {
    { ResultFolder results(folder, false); }
    CHECK(fs::is_directory(folder));
    CHECK(count_in(folder) == 1);
    CHECK(content(folder / ResultFolder::kManifest) == "results of talus run\n");
    CHECK_NOTHROW(ResultFolder(folder, true));
  }
  SUBCASE("an empty folder is taken: nothing could be lost") {
    fs::create_directories(folder);
    CHECK_NOTHROW(ResultFolder(folder, false));
  }
  SUBCASE("force removes what the manifest names and nothing else") {
    {
      ResultFolder results(folder, false);
      results.make_folder("fields");
      results.make_folder("saved");
      for (const char* name : {"summary.json", "fields/blocks_000000.vtu", "saved/stage_01.h5"})
        results.write(name, "old");
    }
    for (const char* name : {"step_notes.txt", "run.log", "my_paraview_state.pvsm", "saved/states.tar",
                             "histories.csv", "fields/mine.pvd"})
      put(folder / name, "precious");
    CHECK(holds(error_of([&] { ResultFolder(folder, false); }), folder.string() + ": exists already"));
    CHECK(content(folder / "summary.json") == "old");
    { ResultFolder results(folder, true); }
    for (const char* name : {"summary.json", "fields/blocks_000000.vtu", "saved/stage_01.h5"})
      CHECK_FALSE(fs::exists(folder / name));
    for (const char* name : {"step_notes.txt", "run.log", "my_paraview_state.pvsm", "saved/states.tar",
                             "histories.csv", "fields/mine.pvd"})
      CHECK(content(folder / name) == "precious");
  }
  SUBCASE("an older folder without manifest: the names of the documents") {
    for (const char* inside : {"fields", "saved", "plots"}) fs::create_directories(folder / inside);
    const std::vector<std::string> ours{"summary.json",
                                        "model.toml",
                                        "histories.csv",
                                        "steps.csv",
                                        "step_12.json",
                                        "fields/blocks.pvd",
                                        "fields/view.py",
                                        "fields/blocks_000003.vtu",
                                        "fields/contacts_1234567.vtp",
                                        "saved/stage_01.h5",
                                        "saved/step_000000012.h5"};
    const std::vector<std::string> theirs{"run.log",           "step_notes.txt",   "step_12.json.bak",
                                          "step_.json",        "saved/states.tar", "saved/stage_old.h5",
                                          "fields/blocks.vtu", "plots/mine.svg",   "notes.txt"};
    for (const auto& name : ours) put(folder / name, "old");
    for (const auto& name : theirs) put(folder / name, "precious");
    { ResultFolder results(folder, true); }
    for (const auto& name : ours) CHECK_MESSAGE(!fs::exists(folder / name), name);
    for (const auto& name : theirs) CHECK_MESSAGE(content(folder / name) == "precious", name);
  }
  SUBCASE("a manifest leads to nothing outside, nor behind a link") {
    put(base / "outside", "precious");
    fs::create_directories(base / "elsewhere");
    put(base / "elsewhere" / "file", "precious");
    fs::create_directories(folder);
    put(folder / ResultFolder::kManifest, "results of talus run\n../../outside\n" +
                                              (base / "outside").string() + "\nfields/../../../outside\n");
    CHECK_NOTHROW(ResultFolder(folder, true));
    CHECK(content(base / "outside") == "precious");
    fs::create_directory_symlink(base / "elsewhere", folder / "fields");
    put(folder / ResultFolder::kManifest, "results of talus run\nfields/file\n");
    CHECK(holds(error_of([&] { ResultFolder(folder, true); }), "fields: is a link"));
    CHECK(content(base / "elsewhere" / "file") == "precious");
  }
  SUBCASE("a torn line of the manifest names nothing") {
    fs::create_directories(folder);
    put(folder / "summary", "precious");
    put(folder / ResultFolder::kManifest, "results of talus run\nsteps.csv\nsummary");
    { ResultFolder results(folder, true); }
    CHECK(content(folder / "summary") == "precious");
    put(folder / ResultFolder::kManifest, "results of talus run\nsteps.csv\nsumm");
    {
      ResultFolder results = ResultFolder::go_on(folder);
      results.note("bolts.csv");
    }
    CHECK(content(folder / ResultFolder::kManifest) == "results of talus run\nsteps.csv\nbolts.csv\n");
  }
  SUBCASE("lock and manifest are no results, whatever the manifest says") {
    fs::create_directories(folder);
    put(folder / ResultFolder::kManifest, "results of talus run\ntalus_lock.txt\ntalus_manifest.txt\n");
    ResultFolder results(folder, true);
    CHECK(fs::exists(folder / "talus_lock.txt"));
    CHECK(holds(error_of([&] { ResultFolder(folder, true); }), "is in use"));
  }
  SUBCASE("a summary of somebody else's is none of ours") {
    fs::create_directories(folder);
    put(folder / "summary.json", "{\"accuracy\": 0.9}");
    put(folder / "histories.csv", "precious");
    CHECK(holds(error_of([&] { ResultFolder(folder, true); }), "holds no results of talus"));
    CHECK(content(folder / "histories.csv") == "precious");
    put(folder / "summary.json", "{\n  \"program\": \"talus 0.1.0\"\n}");
    CHECK_NOTHROW(ResultFolder(folder, true));
  }
  SUBCASE("results of another kind are not replaced") {
    { ResultFolder results(folder, false, ResultKind::kCut); }
    CHECK(holds(error_of([&] { ResultFolder(folder, true); }),
                "holds results of talus cut, which --force of talus run does not replace"));
    CHECK_NOTHROW(ResultFolder(folder, true, ResultKind::kCut));
  }
  SUBCASE("a safety run that was killed can be replaced") {
    { ResultFolder(folder, false, ResultKind::kSafety).write("model.toml", "x"); }
    CHECK_NOTHROW(ResultFolder(folder, true, ResultKind::kSafety));
  }
  SUBCASE("a folder of something else is never touched") {
    fs::create_directories(folder / "fields");
    put(folder / "fields" / "thesis.tex", "precious");
    put(folder / "run.log", "precious");
    CHECK(holds(error_of([&] { ResultFolder(folder, true); }), "holds no results of talus"));
    CHECK(content(folder / "fields" / "thesis.tex") == "precious");
    CHECK(content(folder / "run.log") == "precious");
  }
  SUBCASE("a file in its place") {
    put(base / "file", "text");
    CHECK(holds(error_of([&] { ResultFolder(base / "file", true); }), "is a file, not a folder"));
    CHECK(holds(error_of([&] { ResultFolder(base / "file" / "in", true); }), "cannot be created"));
    CHECK(content(base / "file") == "text");
  }
}

TEST_CASE("what another verb adds is in the manifest, when it lies in the folder") {
  const Folder base;
  { ResultFolder results(base / "out", false); }
  note_result(base / "out", base / "out" / "plots" / "a.svg");
  note_result(base / "out", base / "out" / "plots" / "a.svg");
  note_result(base / "out", base / "elsewhere.svg");
  note_result(base / "none", base / "none" / "a.svg");
  CHECK(content(base / "out" / ResultFolder::kManifest) == "results of talus run\nplots/a.svg\n");
}

TEST_CASE("one writer per folder") {
  const Folder base;
  const fs::path folder = base / "out", lock = folder / FolderLock::kName;
  SUBCASE("a second one is refused by name, whatever it asks for") {
    ResultFolder results(folder, false);
    const std::string who = "process " + std::to_string(getpid()) + " on ";
    CHECK(holds(content(lock), "process " + std::to_string(getpid()) + "\n"));
    CHECK(holds(error_of([&] { ResultFolder(folder, false); }), "is in use: " + who));
    CHECK(holds(error_of([&] { ResultFolder(folder, true); }), "is in use: " + who));
    CHECK(holds(error_of([&] { ResultFolder::go_on(folder); }), "is in use: " + who));
    CHECK(holds(error_of([&] { check_result_folder(folder, true); }), "is in use: " + who));
  }
  SUBCASE("one that was killed leaves its lock, which is told and taken over") {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      ResultFolder results(folder, false);
      raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(fs::exists(lock));
    CHECK(user_of_folder(folder).empty());
    {
      const ResultFolder results = ResultFolder::go_on(folder);
      CHECK(holds(results.stale_lock(), "process " + std::to_string(child) + " on "));
    }
    CHECK_FALSE(fs::exists(lock));
    CHECK(ResultFolder::go_on(folder).stale_lock().empty());
  }
  SUBCASE("what another host has locked is not taken") {
    fs::create_directories(folder);
    put(lock, "process 1\nhost far.example\nbegun 5\n");
    const std::string said = error_of([&] { ResultFolder::go_on(folder); });
    CHECK(holds(said, "process 1 on far.example"));
    CHECK(holds(said, "remove the file"));
  }
  SUBCASE("the lock is no link, and no nonsense in it hurts") {
    fs::create_directories(folder);
    put(base / "target", "precious");
    fs::create_symlink(base / "target", lock);
    CHECK(holds(error_of([&] { ResultFolder::go_on(folder); }), "is a link"));
    CHECK(content(base / "target") == "precious");
    fs::remove(lock);
    put(lock, std::string(1000, '\0'));
    CHECK_NOTHROW(ResultFolder::go_on(folder));
  }
  SUBCASE("what killed writers did not finish is cleared away") {
    fs::create_directories(folder / "saved");
    put(folder / ".talus-1-7.part", "half");
    put(folder / ".talus-99999999-0.part", "x");
    put(folder / "saved" / ".talus-99999999-1.part", "x");
    put(folder / "mine.part", "x");
    { ResultFolder results = ResultFolder::go_on(folder); }
    CHECK_FALSE(fs::exists(folder / ".talus-99999999-0.part"));
    CHECK(fs::exists(folder / ".talus-1-7.part"));  // its process lives
    CHECK_FALSE(fs::exists(folder / "saved" / ".talus-99999999-1.part"));
    CHECK(fs::exists(folder / "mine.part"));
  }
}

}  // namespace test_result_folder
