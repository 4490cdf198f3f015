#pragma once
// Named arrays of numbers and texts in one HDF5 file, and one list of fields that serves both to save and to
// load an object.

#include <filesystem>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

namespace talus {

/// What a file holds. Numbers keep their bits; whole numbers are kept as doubles, exact up to 2^53.
struct Archive {
  std::map<std::string, std::vector<double>> numbers;
  std::map<std::string, std::string> texts;
};

/// Writes under a temporary name, makes sure the bytes are on the disk, and renames into place. Throws
/// FileError.
void write_archive(const std::filesystem::path& path, const Archive& archive);

/// Throws FileError when the file is no archive, cut short or damaged (a sum over the content tells).
Archive read_archive(const std::filesystem::path& path);

/// Saves fields into an archive, or loads them from it, by name. A missing one throws FileError.
class Exchange {
 public:
  Exchange(Archive& archive, bool saving) : archive_(archive), saving_(saving) {}
  bool saving() const { return saving_; }

  void operator()(const std::string& name, std::string& text);

  /// A number of any kind, or a plain struct of doubles.
  template <class T>
  void operator()(const std::string& name, T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      if (saving_)
        archive_.numbers[name] = {static_cast<double>(value)};
      else
        value = static_cast<T>(numbers(name, 1)[0]);
    } else {
      std::vector<T> one{value};
      (*this)(name, one);
      if (!saving_) value = one.at(0);
    }
  }

  /// A list of numbers or of plain structs of doubles.
  template <class T>
  void operator()(const std::string& name, std::vector<T>& list) {
    if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, double>) {
      if (saving_)
        archive_.numbers[name].assign(list.begin(), list.end());
      else {
        list.clear();
        for (const double v : numbers(name)) list.push_back(static_cast<T>(v));
      }
    } else {
      static_assert(
          std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0 && alignof(T) == alignof(double),
          "only structs of doubles; others go field by field with each()");
      constexpr size_t width = sizeof(T) / sizeof(double);
      if (saving_) {
        const auto* first = reinterpret_cast<const double*>(list.data());
        archive_.numbers[name].assign(first, first + list.size() * width);
      } else {
        const std::vector<double>& from = numbers(name);
        check_width(name, from.size(), width);
        list.resize(from.size() / width);
        auto* to = reinterpret_cast<double*>(list.data());
        for (size_t i = 0; i < from.size(); ++i) to[i] = from[i];
      }
    }
  }

  /// A list of structs, field by field: `use(field, element)` calls field(name, member) for each.
  template <class List, class Use>
  void each(const std::string& name, List& list, Use use) {
    double count = static_cast<double>(list.size());
    (*this)(name + ".length_of_list", count);
    if (!saving_) list.resize(static_cast<size_t>(count));
    Columns columns{*this, name, list.size(), {}, 0, 0};
    for (auto& element : list) {
      columns.next = 0;
      use(columns, element);
      ++columns.row;
    }
    if (saving_)
      for (auto& [title, values] : columns.values) archive_.numbers[name + "." + title] = std::move(values);
  }

 private:
  struct Columns {
    Exchange& owner;
    const std::string& name;
    size_t rows;
    std::vector<std::pair<std::string, std::vector<double>>> values;
    size_t next, row;

    template <class T>
    void operator()(const char* title, T& member) {
      if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
        if (next == values.size()) open(title);
        std::vector<double>& column = values[next++].second;
        if (owner.saving_)
          column.push_back(static_cast<double>(member));
        else
          member = static_cast<T>(column[row]);
      } else {
        static_assert(sizeof(T) % sizeof(double) == 0);
        auto* part = reinterpret_cast<double*>(&member);
        for (size_t k = 0; k < sizeof(T) / sizeof(double); ++k)
          (*this)((title + std::to_string(k)).c_str(), part[k]);
      }
    }
    void open(const char* title) {
      values.emplace_back(title, std::vector<double>());
      if (!owner.saving_) values.back().second = owner.numbers(name + "." + title, rows);
    }
  };

  const std::vector<double>& numbers(const std::string& name) const;
  const std::vector<double>& numbers(const std::string& name, size_t count) const;
  static void check_width(const std::string& name, size_t size, size_t width);

  Archive& archive_;
  const bool saving_;
};

}  // namespace talus
