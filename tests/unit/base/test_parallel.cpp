// Work in chunks on a team of threads.

#include "talus/base/parallel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "talus/base/clock.h"

namespace test_parallel {

using namespace talus;

namespace {

constexpr int kMostThreads = 4;

}  // namespace

TEST_CASE("the team has the threads asked for, or one for each processor") {
  CHECK(Workers().threads() == 1);
  for (int threads = 1; threads <= kMostThreads; ++threads) CHECK(Workers(threads).threads() == threads);
  CHECK(Workers(0).threads() >= 1);
  const Workers team(3), copy = team;
  CHECK(copy.threads() == 3);
}

TEST_CASE("run does each task once") {
  for (int threads = 1; threads <= kMostThreads; ++threads) {
    const Workers workers(threads);
    for (const size_t count : {0u, 1u, 2u, 7u, 1000u}) {
      std::vector<std::atomic<int>> done(count);
      workers.run(count, [&](size_t i) { ++done[i]; });
      CHECK(std::all_of(done.begin(), done.end(), [](const auto& d) { return d == 1; }));
    }
  }
}

TEST_CASE("for_chunks covers each index once, in chunks that do not depend on the threads") {
  for (int threads = 1; threads <= kMostThreads; ++threads) {
    const Workers workers(threads);
    for (const size_t n : {0u, 1u, 63u, 64u, 65u, 1000u})
      for (const size_t grain : {1u, 7u, 64u, 5000u}) {
        CAPTURE(threads);
        CAPTURE(n);
        CAPTURE(grain);
        std::vector<std::atomic<int>> seen(n);
        std::atomic<int> wrong{0}, chunks{0};
        workers.for_chunks(n, grain, [&](size_t begin, size_t end) {
          ++chunks;
          if (begin % grain != 0 || end != std::min(n, begin + grain) || begin >= end) ++wrong;
          for (size_t i = begin; i < end; ++i) ++seen[i];
        });
        CHECK(wrong == 0);
        CHECK(chunks == static_cast<int>((n + grain - 1) / grain));
        CHECK(std::all_of(seen.begin(), seen.end(), [](const auto& s) { return s == 1; }));
      }
  }
}

TEST_CASE("sum_chunks has the same bits for any number of threads") {
  // terms of every size: another order of additions would change the last bits
  constexpr size_t kTerms = 10007, kGrain = 100;
  std::vector<double> term;
  for (size_t i = 0; i < kTerms; ++i)
    term.push_back(std::sin(1.0 + static_cast<double>(i)) * std::pow(10.0, static_cast<double>(i % 13)));
  const auto sum = [&](int threads, size_t grain) {
    return Workers(threads).sum_chunks<double>(kTerms, grain, [&](size_t begin, size_t end, double& part) {
      for (size_t i = begin; i < end; ++i) part += term[i];
    });
  };
  const double once = sum(1, kGrain);
  for (int threads = 1; threads <= kMostThreads; ++threads)
    for (int again = 0; again < 20; ++again) {
      const double here = sum(threads, kGrain);
      CHECK(std::memcmp(&here, &once, sizeof once) == 0);
    }
  CHECK(sum(1, 101) != once);  // the terms do tell
  CHECK(Workers(2).sum_chunks<int>(0, 10, [](size_t, size_t, int& part) { part = 7; }) == 0);
}

TEST_CASE("sum_chunks adds in the order of chunks") {
  struct Text {
    std::string text;
    Text& operator+=(const Text& o) {
      text += o.text;
      return *this;
    }
  };
  for (int threads = 1; threads <= kMostThreads; ++threads) {
    const Text all = Workers(threads).sum_chunks<Text>(26, 3, [](size_t begin, size_t end, Text& part) {
      for (size_t i = begin; i < end; ++i) part.text += static_cast<char>('a' + static_cast<int>(i));
    });
    CHECK(all.text == "abcdefghijklmnopqrstuvwxyz");
  }
}

TEST_CASE("an exception of a task is passed on, and the team works on") {
  for (int threads = 1; threads <= kMostThreads; ++threads) {
    const Workers workers(threads);
    const auto task = [](size_t i) {
      if (i == 37) throw std::runtime_error("task 37");
    };
    CHECK_THROWS_WITH_AS(workers.run(100, task), "task 37", std::runtime_error);
    CHECK_THROWS_AS(workers.for_chunks(100, 5,
                                       [&](size_t begin, size_t end) {
                                         for (size_t i = begin; i < end; ++i) task(i);
                                       }),
                    std::runtime_error);
    std::atomic<int> done{0};
    workers.run(50, [&](size_t) { ++done; });
    CHECK(done == 50);
  }
}

TEST_CASE("time of work and time of standing by are told apart") {
  const auto work = [] {
    for (const double end = wall_now() + 0.02; wall_now() < end;) continue;
  };
  CHECK(Workers().shared_seconds() == 0);
  CHECK(Workers().idle_seconds() == 0);
  const double begin = wall_now();
  const Workers workers(2);
  workers.together([&] {
    workers.run(2, [&](size_t) { work(); });
    const double shared = workers.shared_seconds();
    CHECK(shared >= 0.02);
    work();  // the other one stands by
    CHECK(workers.shared_seconds() == shared);
  });
  workers.run(1, [&](size_t) { work(); });  // of one task there is nothing to share
  CHECK(workers.idle_seconds() >= 0);
  CHECK(workers.idle_seconds() <= 2 * (wall_now() - begin));  // of two threads
}

TEST_CASE("copies share the team, one call after the other") {
  const Workers workers(3), copy = workers;
  std::atomic<int> done{0};
  for (int again = 0; again < 50; ++again)
    (again % 2 == 0 ? workers : copy).for_chunks(100, 10, [&](size_t begin, size_t end) {
      done += static_cast<int>(end - begin);
    });
  CHECK(done == 5000);
}

}  // namespace test_parallel
