#include "talus/maps/drawing_bytes.h"

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace talus::maps {

namespace {

class Writer {
 public:
  template <class T>
  void operator()(const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, Vec2>) {
      const auto* first = reinterpret_cast<const char*>(&value);
      bytes.append(first, sizeof(T));
    } else {
      (*this)(static_cast<uint64_t>(value.size()));
      for (const auto& element : value) part(element);
    }
  }

  std::string bytes;

 private:
  void part(char c) { bytes += c; }
  void part(const std::pair<const std::string, std::string>& p) { (*this)(p.first), (*this)(p.second); }
  void part(const auto& element) { exchange(*this, element); }

  static void exchange(Writer& w, const std::string& s) { w(s); }
  static void exchange(Writer& w, const Vec2& v) { w(v); }
  static void exchange(Writer& w, const Feature& f);
  static void exchange(Writer& w, const LeftOut& l);
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}

  void operator()(std::string& text) {
    const size_t n = count(1);
    text.assign(bytes_, at_, n);
    at_ += n;
  }
  void operator()(std::map<std::string, std::string>& pairs) {
    for (size_t n = count(16); n > 0; --n) {
      std::string key, value;
      (*this)(key), (*this)(value);
      pairs[key] = value;
    }
  }
  template <class T>
  void operator()(std::vector<T>& list) {
    list.resize(count(8));
    for (T& element : list) exchange(*this, element);
  }
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_same_v<T, Vec2>) void operator()(T& value) {
    if (bytes_.size() - at_ < sizeof(T)) throw std::runtime_error("a drawing ends too soon");
    std::memcpy(static_cast<void*>(&value), bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  // of elements that take at least so many bytes each
  size_t count(size_t least) {
    uint64_t n = 0;
    (*this)(n);
    if (n > (bytes_.size() - at_) / least) throw std::runtime_error("a drawing ends too soon");
    return static_cast<size_t>(n);
  }
  static void exchange(Reader& r, std::string& s) { r(s); }
  static void exchange(Reader& r, Vec2& v) { r(v); }
  static void exchange(Reader& r, Feature& f);
  static void exchange(Reader& r, LeftOut& l);

  const std::string& bytes_;
  size_t at_ = 0;
};

void fields_of(auto& x, auto& f) requires requires { f.is_hole; }
{ x(f.layer), x(f.id), x(f.attributes), x(f.is_point), x(f.is_area), x(f.is_hole), x(f.points); }

void fields_of(auto& x, auto& l) requires requires { l.reason; }
{ x(l.layer), x(l.what), x(l.reason), x(l.count); }

void fields_of(auto& x, auto& d) requires requires { d.geographic; }
{
  x(d.format), x(d.unit), x(d.unit_source), x(d.geographic), x(d.features), x(d.left_out), x(d.notes);
  x(d.unreadable), x(d.first_failure);
}

void Writer::exchange(Writer& w, const Feature& f) { fields_of(w, f); }
void Writer::exchange(Writer& w, const LeftOut& l) { fields_of(w, l); }
void Reader::exchange(Reader& r, Feature& f) { fields_of(r, f); }
void Reader::exchange(Reader& r, LeftOut& l) { fields_of(r, l); }

}  // namespace

std::string bytes_of(const Drawing& drawing) {
  Writer writer;
  fields_of(writer, drawing);
  return writer.bytes;
}

Drawing drawing_of(const std::string& bytes) {
  Drawing drawing;
  Reader reader(bytes);
  fields_of(reader, drawing);
  if (!reader.at_end()) throw std::runtime_error("a drawing has more bytes than fields");
  return drawing;
}

}  // namespace talus::maps
