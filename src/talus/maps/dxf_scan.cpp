#include "talus/maps/dxf_scan.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "talus/base/text.h"

namespace talus::maps {

namespace {

// Lines of the text, LF or CRLF, numbered from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  bool next(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    line = trimmed(text_.substr(at_, end - at_));
    at_ = end + 1;
    ++number_;
    return true;
  }
  int number() const { return number_; }

 private:
  std::string_view text_;
  size_t at_ = 0;
  int number_ = 0;
};

bool to_int(std::string_view s, int& out) {
  const auto [end, status] = std::from_chars(s.data(), s.data() + s.size(), out);
  return status == std::errc{} && end == s.data() + s.size();
}

// Names that a message can show.
std::string readable(std::string_view s) {
  std::string out;
  for (const char c : s.substr(0, 80)) out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return out;
}

class Scanner {
 public:
  explicit Scanner(std::string_view text) : lines_(text) {}

  DxfScan scan() {
    std::string_view code_text, value;
    while (lines_.next(code_text)) {
      int code = 0;
      const int line = lines_.number();
      if (!to_int(code_text, code)) {
        // empty lines after the end do no harm; anything else means that pairs are out of step
        if (code_text.empty() && ended_) continue;
        return defect(fmt::format("line {}: expected a group code (a whole number), found \"{}\"", line,
                                  readable(code_text)));
      }
      if (ended_) return defect(fmt::format("line {}: the file goes on after its EOF", line));
      if (!lines_.next(value)) return defect(cut_short(line));
      pair(code, value);
    }
    close_entity();
    if (!ended_) return defect(cut_short(lines_.number()));
    return std::move(out_);
  }

 private:
  static std::string cut_short(int line) {
    return fmt::format("ends at line {} without its EOF: the file was cut short", line);
  }

  DxfScan defect(std::string text) {
    out_.defect = std::move(text);
    return std::move(out_);
  }

  void pair(int code, std::string_view value) {
    if (code == 0) {
      close_entity();
      if (value == "EOF") ended_ = true;
      if (value == "ENDSEC" || value == "SECTION") section_.clear();
      wants_section_ = value == "SECTION";
      const bool holds_entities = section_ == "ENTITIES" || section_ == "BLOCKS";
      // parts of others: corners and attributes of the entity before, ends of blocks
      if (holds_entities && value != "VERTEX" && value != "SEQEND" && value != "BLOCK" && value != "ENDBLK" &&
          value != "ATTRIB")
        kind_ = readable(value);
      return;
    }
    if (code == 2 && wants_section_) section_ = std::string(value), wants_section_ = false;
    if (section_ == "HEADER" && code == 9) variable_ = std::string(value);
    if (section_ == "HEADER" && code == 70 && variable_ == "$INSUNITS") to_int(value, out_.insunits);
    if (kind_.empty()) return;
    if (code == 8) layer_ = readable(value);
    if (code == 73) to_int(value, control_points_);
    if (code == 74) to_int(value, fit_points_);
  }

  void close_entity() {
    if (!kind_.empty()) {
      ++out_.entities[{layer_, kind_}];
      if (kind_ == "SPLINE" && control_points_ == 0 && fit_points_ > 0) ++out_.fit_splines[layer_];
    }
    kind_.clear(), layer_ = "0";
    control_points_ = fit_points_ = 0;
  }

  Lines lines_;
  DxfScan out_;
  std::string section_, variable_, kind_, layer_ = "0";
  int control_points_ = 0, fit_points_ = 0;
  bool wants_section_ = false, ended_ = false;
};

}  // namespace

DxfScan scan_dxf(std::string_view text) {
  DxfScan out;
  if (text.substr(0, 21) == "AutoCAD Binary DXF\r\n\x1a")
    out.defect = "is a binary DXF: save it as ASCII DXF";
  else if (text.substr(0, 6) == "AC1.50" || (text.substr(0, 4) == "AC10" && text.find('\n') > 6))
    out.defect = "is a DWG: save it as ASCII DXF";
  if (!out.defect.empty()) return out;
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  return Scanner(text).scan();
}

std::pair<double, std::string> insunits_unit(int code) {
  switch (code) {
    case 1:
      return {0.0254, "inch"};
    case 2:
      return {0.3048, "foot"};
    case 4:
      return {1e-3, "mm"};
    case 5:
      return {1e-2, "cm"};
    case 6:
      return {1, "m"};
    case 7:
      return {1e3, "km"};
    case 13:
      return {1e-6, "micrometre"};
    case 14:
      return {0.1, "dm"};
    case 21:
      return {1200.0 / 3937.0, "US survey foot"};
    default:
      return {std::nan(""), ""};
  }
}

}  // namespace talus::maps
