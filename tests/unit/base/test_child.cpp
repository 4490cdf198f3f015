#include "talus/base/child.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>
#include <vector>

#include "support/file_errors.h"

namespace test_child {

using namespace talus;
using namespace talus::test;

namespace {

std::string said(const std::function<std::string()>& work, const ChildLimits& limits = {}) {
  return error_of([&] { work_in_child("map.gpkg", work, limits); });
}

}  // namespace

TEST_CASE("work in a child: its bytes come back, whatever they are and how many") {
  CHECK(work_in_child("x", [] { return std::string(); }) == "");
  const std::string some("a\0b\n", 4);
  CHECK(work_in_child("x", [&] { return some; }) == some);
  const std::string many(5000000, 'q');
  CHECK(work_in_child("x", [&] { return many; }) == many);
}

TEST_CASE("work in a child: a hang-up that nohup has ignored stays so") {
  const auto hears = [] {
    struct sigaction now {};
    sigaction(SIGHUP, nullptr, &now);
    return std::string(now.sa_handler == SIG_IGN ? "ignored" : "heard");
  };
  const auto before = std::signal(SIGHUP, SIG_IGN);
  CHECK(work_in_child("x", hears) == "ignored");
  std::signal(SIGHUP, SIG_DFL);
  CHECK(work_in_child("x", hears) == "heard");
  std::signal(SIGHUP, before);
}

TEST_CASE("work in a child: its death is an error with the reason") {
  CHECK(holds(said([]() -> std::string {
                raise(SIGSEGV);
                return "";
              }),
              "map.gpkg: the library that reads it has crashed"));
  CHECK(holds(said([]() -> std::string {
                raise(SIGKILL);
                return "";
              }),
              "was killed, as the system does when memory is short"));
  CHECK(holds(said([]() -> std::string { _exit(3); }), "map.gpkg: reading it failed"));
  CHECK(holds(said([]() -> std::string { throw std::runtime_error("x"); }), "map.gpkg: reading it failed"));
  CHECK(holds(said([]() -> std::string { throw std::bad_alloc(); }), "MiB of memory"));
  const auto sleeps = []() -> std::string {
    std::this_thread::sleep_for(std::chrono::seconds(100));
    return "";
  };
  CHECK(holds(said(sleeps, {.seconds = 1}), "map.gpkg: reading it took more than 1 s"));
  const auto turns = []() -> std::string {
    for (volatile int i = 0;;) i = i + 1;
  };
  CHECK(holds(said(turns, {.seconds = 1}), "map.gpkg: reading it took more than 1 s"));
}

TEST_CASE("work in a child: it holds nothing of its parent open") {
  const int mine = dup(0);
  REQUIRE(mine > 2);
  const std::string bytes = work_in_child("x", [mine] {
    return std::string(fcntl(mine, F_GETFD) < 0 ? "closed" : "open") +
           (fcntl(2, F_GETFD) < 0 ? "" : " but streams");
  });
  CHECK(bytes == "closed but streams");
  close(mine);
}

#ifndef __SANITIZE_ADDRESS__
TEST_CASE("work in a child: no more memory than it may have") {
  const auto grows = []() -> std::string {
    std::vector<std::string> all;
    for (int i = 0; i < 100; ++i) all.emplace_back(size_t{64} << 20, 'x');
    return "";
  };
  CHECK(holds(said(grows, {.memory = size_t{1} << 30}),
              "map.gpkg: reading it took more than 1024 MiB of memory"));
  // what the parent has counts for nothing
  const std::string much(size_t{256} << 20, 'y');
  CHECK(work_in_child("x", [] { return std::string(1000000, 'z'); }, {.memory = size_t{64} << 20}).size() ==
        1000000);
  CHECK(much.back() == 'y');
}
#endif

}  // namespace test_child
