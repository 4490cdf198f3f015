// Saved states hold every field of a State; one that is not saved comes back with its default. (One that is
// not in blocks/state_fields.h does not compile.)

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <type_traits>

#include "talus/blocks/state_fields.h"
#include "talus/run/saved_state.h"

namespace test_saved_state {

using namespace talus;

namespace {

// Calls `number(x)` for every number in a value, down to those in lists and structs.
template <class Number>
struct EachNumber {
  Number number;

  template <class T>
  void operator()(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      number(value);
    } else if constexpr (requires { each_field(value, [](const char*, auto&) {}); }) {
      each_field(value, [this](const char*, auto& field) { (*this)(field); });
    } else if constexpr (requires { value.resize(2); }) {
      if (value.empty()) value.resize(2);
      for (auto& element : value) (*this)(element);
    } else if constexpr (std::is_array_v<T> || requires { value.fill(value[0]); }) {
      for (auto& element : value) (*this)(element);
    } else {
      static_assert(std::is_trivially_copyable_v<T> && alignof(T) == alignof(double));
      auto* first = reinterpret_cast<double*>(&value);
      for (size_t i = 0; i < sizeof(T) / sizeof(double); ++i) number(first[i]);
    }
  }
};

// Every number another one than its default.
State full_state() {
  int next = 100;
  EachNumber fill{[&next](auto& x) {
    using T = std::remove_reference_t<decltype(x)>;
    if constexpr (std::is_same_v<T, bool> || std::is_enum_v<T>)
      x = static_cast<T>(1);
    else
      x = static_cast<T>(next++);
  }};
  State s;
  fill(s);
  return s;
}

std::vector<double> numbers_of(State s) {
  std::vector<double> all;
  EachNumber list{[&all](auto& x) { all.push_back(static_cast<double>(x)); }};
  list(s);
  return all;
}

}  // namespace

TEST_CASE("saved state: every field comes back") {
  State s = full_state(), back;
  Archive archive;
  Saver saver(archive);
  Loader loader(archive);
  save_state(saver, s);
  load_state(loader, back);
  const std::vector<double> before = numbers_of(s), after = numbers_of(back);
  REQUIRE(before.size() == after.size());
  for (size_t i = 0; i < before.size(); ++i) {
    INFO("number ", i);
    CHECK(before[i] == after[i]);
  }
}

TEST_CASE("saved state: limits without end and anchors of sliding contacts pass through the file") {
  State s = full_state(), back;
  s.bolts[1].nodes[0].limit = std::numeric_limits<double>::infinity();
  s.contacts[1].anchor = std::numeric_limits<double>::quiet_NaN();
  s.bolts[0].crossings.clear();
  const auto path =
      std::filesystem::temp_directory_path() / ("talus_saved_state_" + std::to_string(getpid()) + ".h5");
  Archive archive;
  Saver saver(archive);
  save_state(saver, s);
  write_archive(path, archive);
  const Archive read = read_archive(path);
  std::filesystem::remove(path);
  Loader loader(read);
  load_state(loader, back);
  CHECK(std::isinf(back.bolts[1].nodes[0].limit));
  CHECK(std::isnan(back.contacts[1].anchor));
  CHECK(back.bolts[0].crossings.empty());
  CHECK(back.bolts[1].crossings.size() == s.bolts[1].crossings.size());
}

namespace {

// Bytes of a T that none of its fields in each_field() has, but for what alignment leaves.
template <class T>
size_t uncovered() {
  T value{};
  struct Part {
    size_t begin, end, alignment;
  };
  std::vector<Part> parts;
  const auto at = [&](const auto& field) {
    return static_cast<size_t>(reinterpret_cast<const char*>(&field) - reinterpret_cast<const char*>(&value));
  };
  each_field(value, [&](const char*, auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    parts.push_back({at(field), at(field) + sizeof field, alignof(Field)});
  });
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.begin < b.begin; });
  parts.push_back({sizeof(T), sizeof(T), alignof(T)});
  size_t end = 0, missing = 0;
  for (const Part& p : parts) {
    if (p.begin - end >= p.alignment) missing += p.begin - end;
    end = p.end;
  }
  return missing;
}

}  // namespace

TEST_CASE("saved state: no field of any struct is left out of the list") {
  CHECK(uncovered<State>() == 0);
  CHECK(uncovered<CandidateList>() == 0);
  CHECK(uncovered<Neighbours>() == 0);
  CHECK(uncovered<ContactPair>() == 0);
  CHECK(uncovered<FollowedPair>() == 0);
  CHECK(uncovered<Contact>() == 0);
  CHECK(uncovered<FaceState>() == 0);
  CHECK(uncovered<HeldPoint>() == 0);
  CHECK(uncovered<RestWatch>() == 0);
  CHECK(uncovered<Bolt>() == 0);
  CHECK(uncovered<BoltNode>() == 0);
  CHECK(uncovered<BoltSegment>() == 0);
  CHECK(uncovered<BoltCrossing>() == 0);
}

}  // namespace test_saved_state
