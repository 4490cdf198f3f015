#pragma once
// Named arrays of numbers and texts in one file, and one list of fields that serves both to save and to load
// an object. The file is a header that is read and checked first, and HDF5.

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

namespace talus {

/// Number of the layout of saved states; another one is refused.
inline constexpr int kStateFormat = 21;

/// What a file holds. Numbers keep their bits; whole numbers are kept as doubles, exact up to 2^53.
struct Archive {
  std::map<std::string, std::vector<double>> numbers;
  std::map<std::string, std::string> texts;
};

/// Writes under a temporary name, makes sure the bytes are on the disk, and renames into place. The bytes are
/// made in memory: the library that makes them sees no file, so none can fail it. Throws FileError.
void write_archive(const std::filesystem::path& path, const Archive& archive);

/// Throws FileError when the file is no archive, one of another format, cut short or damaged (the header holds
/// size and digest of the rest), or holds anything but plain arrays. A crash of the library on a crafted one is told.
Archive read_archive(const std::filesystem::path& path);
/// The bytes of such a file, for parse_archive(). Throws FileError where its header says that it is none, or not whole.
std::string read_archive_bytes(const std::filesystem::path& path);

/// The bytes of an archive file, and an archive from them; `name` is for messages.
std::string archive_bytes(const Archive& archive);
Archive parse_archive(const std::string& name, const std::string& bytes);

namespace archive_detail {

[[noreturn]] void wrong_value(const std::string& name, double value, const char* wanted);
[[noreturn]] void wrong_width(const std::string& name, size_t size, size_t width);
const std::vector<double>& numbers(const Archive& archive, const std::string& name);
const std::vector<double>& numbers(const Archive& archive, const std::string& name, size_t count);

// Enumerators that a file may hold: 0 to last_of(E()), which is found beside the enumeration.
template <class T>
T checked(const std::string& name, double value) {
  if constexpr (std::is_floating_point_v<T>) {
    return value;
  } else if constexpr (std::is_enum_v<T>) {
    if (!(value >= 0) || value > static_cast<double>(last_of(T())) || value != std::floor(value))
      wrong_value(name, value, "one of its choices");
    return static_cast<T>(static_cast<int>(value));
  } else if constexpr (std::is_same_v<T, bool>) {
    if (value != 0 && value != 1) wrong_value(name, value, "0 or 1");
    return value != 0;
  } else {
    constexpr double kExact = 9007199254740992.0;  // 2^53
    const double least = std::max(-kExact, static_cast<double>(std::numeric_limits<T>::min()));
    const double most = std::min(kExact, static_cast<double>(std::numeric_limits<T>::max()));
    if (!(value >= least && value <= most) || value != std::floor(value))
      wrong_value(name, value, "a whole number in its range");
    return static_cast<T>(value);
  }
}

template <class T>
inline constexpr bool kPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// A struct of nothing but doubles.
template <class T>
inline constexpr bool kDoubles = std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0 &&
                                 alignof(T) == alignof(double);

}  // namespace archive_detail

/// Puts fields into an archive by name.
class Saver {
 public:
  static constexpr bool kSaving = true;
  explicit Saver(Archive& archive) : archive_(archive) {}

  void operator()(const std::string& name, const std::string& text) { archive_.texts[name] = text; }

  /// A number of any kind, or a plain struct of doubles.
  template <class T>
  void operator()(const std::string& name, const T& value) {
    if constexpr (archive_detail::kPlain<T>) {
      archive_.numbers[name] = {static_cast<double>(value)};
    } else {
      static_assert(archive_detail::kDoubles<T>);
      const auto* first = reinterpret_cast<const double*>(&value);
      archive_.numbers[name].assign(first, first + sizeof(T) / sizeof(double));
    }
  }

  /// A list of numbers or of plain structs of doubles.
  template <class T>
  void operator()(const std::string& name, const std::vector<T>& list) {
    if constexpr (archive_detail::kPlain<T>) {
      archive_.numbers[name].assign(list.begin(), list.end());
    } else {
      static_assert(archive_detail::kDoubles<T>, "others go field by field with each()");
      const auto* first = reinterpret_cast<const double*>(list.data());
      archive_.numbers[name].assign(first, first + list.size() * (sizeof(T) / sizeof(double)));
    }
  }

  /// A list of structs, field by field: `use(field, element)` calls field(title, member) for each.
  template <class List, class Use>
  void each(const std::string& name, const List& list, Use use) {
    archive_.numbers[name + ".length_of_list"] = {static_cast<double>(list.size())};
    Columns columns{{}, 0, list.size()};
    for (const auto& element : list) {
      columns.next = 0;
      use(columns, element);
    }
    for (auto& [title, values] : columns.values) archive_.numbers[name + "." + title] = std::move(values);
  }

 private:
  struct Columns {
    std::vector<std::pair<std::string, std::vector<double>>> values;
    size_t next, rows;

    template <class T>
    void operator()(const char* title, const T& member) {
      if constexpr (archive_detail::kPlain<T>) {
        if (next == values.size()) {
          values.emplace_back(title, std::vector<double>());
          values.back().second.reserve(rows);
        }
        values[next++].second.push_back(static_cast<double>(member));
      } else {
        const auto* part = reinterpret_cast<const double*>(&member);
        for (size_t k = 0; k < sizeof(T) / sizeof(double); ++k)
          (*this)((title + std::to_string(k)).c_str(), part[k]);
      }
    }
  };

  Archive& archive_;
};

/// Takes fields out of an archive by name. Throws FileError when one is missing, does not fit its type, or is
/// not as long as others of its list. What the numbers mean, and whether they are finite, is for others to judge.
class Loader {
 public:
  static constexpr bool kSaving = false;
  explicit Loader(const Archive& archive) : archive_(archive) {}

  void operator()(const std::string& name, std::string& text) const;

  template <class T>
  void operator()(const std::string& name, T& value) const {
    if constexpr (archive_detail::kPlain<T>) {
      value = archive_detail::checked<T>(name, archive_detail::numbers(archive_, name, 1)[0]);
    } else {
      static_assert(archive_detail::kDoubles<T>);
      const std::vector<double>& from = archive_detail::numbers(archive_, name, sizeof(T) / sizeof(double));
      auto* to = reinterpret_cast<double*>(&value);
      for (size_t i = 0; i < from.size(); ++i) to[i] = archive_detail::checked<double>(name, from[i]);
    }
  }

  template <class T>
  void operator()(const std::string& name, std::vector<T>& list) const {
    const std::vector<double>& from = archive_detail::numbers(archive_, name);
    list.clear();
    if constexpr (archive_detail::kPlain<T>) {
      list.reserve(from.size());
      for (const double v : from) list.push_back(archive_detail::checked<T>(name, v));
    } else {
      static_assert(archive_detail::kDoubles<T>, "others go field by field with each()");
      constexpr size_t width = sizeof(T) / sizeof(double);
      if (from.size() % width != 0) archive_detail::wrong_width(name, from.size(), width);
      list.resize(from.size() / width);
      auto* to = reinterpret_cast<double*>(list.data());
      for (size_t i = 0; i < from.size(); ++i) to[i] = archive_detail::checked<double>(name, from[i]);
    }
  }

  template <class List, class Use>
  void each(const std::string& name, List& list, Use use) const {
    const size_t count = archive_detail::checked<size_t>(
        name, archive_detail::numbers(archive_, name + ".length_of_list", 1)[0]);
    list.clear();
    if (count == 0) return;
    Columns columns{*this, name, count, {}, 0, 0};
    {  // the columns are there and as long as they say, before there is room for so many
      typename List::value_type first{};
      use(columns, first);
    }
    list.resize(count);
    for (auto& element : list) {
      columns.next = 0;
      use(columns, element);
      ++columns.row;
    }
  }

 private:
  struct Columns {
    const Loader& owner;
    const std::string& name;
    size_t rows;
    std::vector<const std::vector<double>*> values;
    size_t next, row;

    template <class T>
    void operator()(const char* title, T& member) {
      if constexpr (archive_detail::kPlain<T>) {
        if (next == values.size())
          values.push_back(&archive_detail::numbers(owner.archive_, name + "." + title, rows));
        member = archive_detail::checked<T>(name + "." + title, (*values[next++])[row]);
      } else {
        auto* part = reinterpret_cast<double*>(&member);
        for (size_t k = 0; k < sizeof(T) / sizeof(double); ++k)
          (*this)((title + std::to_string(k)).c_str(), part[k]);
      }
    }
  };

  const Archive& archive_;
};

}  // namespace talus
