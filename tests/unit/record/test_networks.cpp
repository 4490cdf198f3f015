// Files of strong-motion networks: values, step and unit come back, components are chosen, what is done already is told,
// and files that are cut short, unknown or of other formats are refused by name.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "support/record_text.h"
#include "support/relative.h"
#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/record/read_record.h"

namespace test_networks {

using namespace talus;
using namespace talus::record;
using namespace talus::test;

namespace {

// Fields without a blank between them where a value has five digits.
const std::vector<double> kValues{0, 0.5, -1.5, 100.25, -120.125, 3, 7, 250.5, -0.125, 12};

struct Network {
  const char* name;
  Format format;
  std::string text;
  double unit;      // [m/s2] of a value
  double rounding;  // half of the last digit of the text at 100.25 and 250.5, and a hair
  const char* component;
};

std::vector<Network> networks() {
  return {{"ESM", Format::kEsm, esm_text(kValues, 0.005), 1e-2, 5.1e-7, ""},
          {"GeoNet", Format::kGeonet, geonet_text(kValues, 0.02), 1e-3, 0.051, "N28W"},
          {"CSMIP", Format::kCsmip, csmip_text(kValues, 0.01), 1e-2, 5.1e-6, "90 Deg"},
          {"COSMOS", Format::kCosmos, cosmos_text(kValues, 0.005), 1e-2, 5.1e-5, ""},
          {"SMC", Format::kSmc, smc_text(kValues, 0.005), 1e-2, 0.051, ""}};
}

double peak_of(const Record& r) {
  double peak = 0;
  for (const double v : r.value) peak = std::abs(v) > std::abs(peak) ? v : peak;
  return peak;
}

}  // namespace

TEST_CASE("networks: values, step, unit and what was done to them") {
  for (const Network& n : networks()) {
    INFO(n.name);
    ReadOptions options;
    options.column = n.component;
    const Record r = read_record_text("file", n.text, options);
    CHECK(r.format == n.format);
    CHECK(name_of(r.format) == n.name);
    CHECK(r.quantity == Quantity::kAcceleration);
    CHECK(r.dt == approx(n.format == Format::kGeonet  ? 0.02
                         : n.format == Format::kCsmip ? 0.01
                                                      : 0.005)
                      .epsilon(1e-12));
    REQUIRE(r.value.size() == kValues.size());
    for (size_t i = 0; i < kValues.size(); ++i)
      CHECK(std::abs(r.value[i] - n.unit * kValues[i]) <= n.unit * n.rounding);
    CHECK(!r.processed.empty());
  }
}

TEST_CASE("networks: a file of several components asks which one") {
  for (const Network& n : networks()) {
    if (!*n.component) continue;
    INFO(n.name);
    CHECK_THROWS_WITH_AS(read_record_text("file", n.text), doctest::Contains("the file holds 2"), InputError);
    ReadOptions options;
    options.column = n.format == Format::kGeonet ? "up" : "180 deg";
    const Record r = read_record_text("file", n.text, options);
    CHECK(peak_of(r) == approx(2 * n.unit * 250.5).epsilon(1e-9));
    options.column = "west";
    CHECK_THROWS_WITH_AS(read_record_text("file", n.text, options), doctest::Contains("\"west\""),
                         InputError);
  }
}

TEST_CASE("networks: files cut short at any line, or with a letter for a digit, are refused with a line") {
  for (const Network& n : networks()) {
    INFO(n.name);
    ReadOptions options;
    options.column = n.component;
    options.format = n.format;
    size_t refused = 0, tried = 0;
    const size_t whole = n.format == Format::kGeonet || n.format == Format::kCsmip
                             ? n.text.find(n.format == Format::kGeonet ? "Up" : "Chan  2")
                             : n.text.size();
    for (size_t at = n.text.find('\n'); at < whole; at = n.text.find('\n', at + 1)) {
      ++tried;
      try {
        const Record r = read_record_text("file", n.text.substr(0, at), options);
        // only what comes behind the values may be missing
        CHECK(r.value.size() == kValues.size());
      } catch (const InputError& e) {
        ++refused;
        CHECK(std::string(e.what()).find("= ") != std::string::npos);
      }
    }
    CHECK(tried > 10);
    CHECK(refused > 5);
    const std::string value = n.format == Format::kSmc      ? "2.505e+02"
                              : n.format == Format::kCosmos ? "2.505000e+02"
                                                            : "250.5";
    std::string wrong = n.text;
    wrong.replace(wrong.find(value), 1, "x");
    CHECK_THROWS_AS(read_record_text("file", wrong, options), InputError);
  }
}

TEST_CASE("networks: what is no format that is read is called so, with its likely name") {
  const auto message = [](const std::string& text) {
    try {
      read_record_text("file", text);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("read");
  };
  for (const auto& [text, name] :
       {std::pair<std::string, std::string>("* VOL1DS FILE:  5520/01\nInst Type = SSA-2\n    0    0\n",
                                            "BHRC"),
        {"#Earthquake Information\n#Origin Time(GMT+08): 2018/02/06\n  0.0  1.0  2.0  3.0\n", "CWA"},
        {"STRONG GROUND MOTION RECORDS OF TURKIYE\nPLACE : X\n  1.0 2.0 3.0\n", "AFAD"},
        {"Uncorrected Accelerogram Data\nx\n", "CSMIP volume 1"}}) {
    INFO(name);
    CHECK(message(text).find("this looks like a file of " + name) != std::string::npos);
    CHECK(message(text).find("read are PEER") != std::string::npos);
  }
  const std::string letter =
      message("Dear all,\nplease find the record\nbelow, as agreed\nwith kind regards\n");
  CHECK(letter.find("the format of this file is not known") != std::string::npos);
  CHECK(letter.find("correct the row") == std::string::npos);
  // a table with one wrong row is a table
  CHECK(message("t [s],a [m/s2]\n0,1\n1,2\n2,3,4\n3,4\n").find("the row has 3 cells") != std::string::npos);
}

// Set TALUS_RECORD_FILES to a folder of real files; none lie in the repository.
TEST_CASE("networks: real files keep the peak that their headers tell") {
  const char* folder = std::getenv("TALUS_RECORD_FILES");
  if (!folder) {
    MESSAGE("skipped: TALUS_RECORD_FILES names no folder");
    return;
  }
  struct Told {
    Format format;
    std::regex peak;
    double unit;
  };
  const std::vector<Told> told{
      {Format::kEsm, std::regex(R"(PGA_CM/S\^2:\s*([-0-9.]+))"), 1e-2},
      {Format::kGeonet, std::regex(R"(Acceleration:\s+[Pp]eak\s+([-0-9.]+) mm)"), 1e-3},
      {Format::kCsmip, std::regex(R"(Peak acceleration\s*=\s*([-0-9.]+))", std::regex::icase), 1e-2},
      {Format::kCosmos, std::regex(R"(Max =\s*([-0-9.]+) +cm/s)"), 1e-2},
      {Format::kSmc, std::regex(R"(pk +=\s*([-0-9.]+))"), 1e-2}};
  int files = 0, silent = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string text = read_text_file(entry.path());
    if (text.find('\0') < text.find_last_not_of('\0')) continue;  // no text
    const Lines lines = split_lines(entry.path().string(), text);
    const auto format = recognised(lines);
    for (const Told& t : told) {
      if (t.format != format) continue;
      std::vector<std::string> components{""};
      if (format != Format::kEsm && format != Format::kSmc) {
        components.clear();
        static const std::regex kGeonet(R"((?:^|\n)Component (\S+))"),
            kCosmos(R"(\n(Sta Cha[^\n\r]*[^\n\r ]))"),
            kCsmip(R"((?:^|\n)corrected accelerogram[^\n]*(chan\w*\s+\d+:[^\n]*?)\s+from)",
                   std::regex::icase);
        const std::regex& pattern = format == Format::kGeonet  ? kGeonet
                                    : format == Format::kCsmip ? kCsmip
                                                               : kCosmos;
        for (std::sregex_iterator m(text.begin(), text.end(), pattern), end; m != end; ++m)
          components.push_back((*m)[1]);
      }
      std::vector<double> peaks;
      for (std::sregex_iterator m(text.begin(), text.end(), t.peak), end; m != end; ++m)
        peaks.push_back(t.unit * std::stod((*m)[1]));
      INFO(entry.path().string());
      if (peaks.size() < components.size()) {  // uncorrected files need not tell it
        ++silent;
        continue;
      }
      for (size_t k = 0; k < components.size(); ++k) {
        ReadOptions options;
        options.column = components[k];
        const Record r = read_record_text(entry.path().string(), text, options);
        const double stated = peaks[k];
        // headers round to a tenth or better of their unit, or to four digits
        CHECK(std::abs(std::abs(peak_of(r)) - std::abs(stated)) <=
              std::max(0.051 * t.unit, 2e-4 * std::abs(stated)));
        ++files;
      }
    }
  }
  MESSAGE(files << " components of real files, " << silent << " files whose header tells no peak");
  CHECK(files > 0);
}

}  // namespace test_networks
