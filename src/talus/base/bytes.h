#pragma once
// Plain data as bytes, to be handed from one process to another on the same machine.

#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace talus {

// Structs take part by a function beside them: byte_fields(x, value) calls x(field) for each.

/// Puts values one behind the other: numbers, texts, lists, maps, structs.
class ByteWriter {
 public:
  void operator()(const std::string& text) {
    (*this)(static_cast<uint64_t>(text.size()));
    bytes_ += text;
  }
  template <class T>
  void operator()(const std::vector<T>& list) {
    (*this)(static_cast<uint64_t>(list.size()));
    if constexpr (std::is_arithmetic_v<T>)
      bytes_.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
    else
      for (const T& element : list) (*this)(element);
  }
  template <class T>
  void operator()(const std::map<std::string, T>& pairs) {
    (*this)(static_cast<uint64_t>(pairs.size()));
    for (const auto& [key, value] : pairs) (*this)(key), (*this)(value);
  }
  template <class T>
  void operator()(const T& value) {
    if constexpr (std::is_arithmetic_v<T>)
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    else
      byte_fields(*this, value);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Takes them out again, in the same order. Throws std::runtime_error where there are not enough bytes.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}

  void operator()(std::string& text) {
    const size_t n = count(1);
    text.assign(bytes_, at_, n);
    at_ += n;
  }
  template <class T>
  void operator()(std::vector<T>& list) {
    if constexpr (std::is_arithmetic_v<T>) {
      list.resize(count(sizeof(T)));
      take(list.data(), list.size() * sizeof(T));
    } else {
      list.resize(count(1));
      for (T& element : list) (*this)(element);
    }
  }
  template <class T>
  void operator()(std::map<std::string, T>& pairs) {
    for (size_t n = count(1); n > 0; --n) {
      std::string key;
      (*this)(key);
      (*this)(pairs[key]);
    }
  }
  template <class T>
  void operator()(T& value) {
    if constexpr (std::is_arithmetic_v<T>)
      take(&value, sizeof(T));
    else
      byte_fields(*this, value);
  }

  bool at_end() const { return at_ == bytes_.size(); }

 private:
  void take(void* to, size_t n) {
    if (bytes_.size() - at_ < n) throw std::runtime_error("there are too few bytes");
    if (n > 0) std::memcpy(to, bytes_.data() + at_, n);
    at_ += n;
  }
  // of elements that take at least so many bytes each
  size_t count(size_t least) {
    uint64_t n = 0;
    take(&n, sizeof n);
    if (n > (bytes_.size() - at_) / least) throw std::runtime_error("there are too few bytes");
    return n;
  }

  const std::string& bytes_;
  size_t at_ = 0;
};

}  // namespace talus
