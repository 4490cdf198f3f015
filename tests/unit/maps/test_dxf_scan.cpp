// What is read off a DXF before its geometry.

#include <doctest/doctest.h>

#include <string>

#include "talus/maps/dxf_scan.h"

namespace test_dxf_scan {

using namespace talus::maps;

namespace {

const std::string kWhole =
    "  0\nSECTION\n  2\nHEADER\n  9\n$ACADVER\n  1\nAC1015\n  9\n$INSUNITS\n 70\n     4\n  0\nENDSEC\n"
    "  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n  8\nJOINTS\n 10\n0.0\n 20\n0.0\n 11\n1.0\n 21\n1.0\n"
    "  0\nPOLYLINE\n  8\nA\n  0\nVERTEX\n  8\nA\n  0\nVERTEX\n  8\nA\n  0\nSEQEND\n"
    "  0\nSPLINE\n  8\nJOINTS\n 73\n0\n 74\n3\n  0\n3DSOLID\n  8\nBODY\n  0\nENDSEC\n  0\nEOF\n";

}  // namespace

TEST_CASE("dxf scan: units, entities by layer, splines by fit points") {
  const DxfScan s = scan_dxf(kWhole);
  CHECK(s.defect.empty());
  CHECK(s.insunits == 4);
  CHECK(s.entities.at({"JOINTS", "LINE"}) == 1);
  CHECK(s.entities.at({"A", "POLYLINE"}) == 1);
  CHECK(s.entities.at({"BODY", "3DSOLID"}) == 1);
  CHECK(s.entities.size() == 4);
  CHECK(s.fit_splines.at("JOINTS") == 1);
}

TEST_CASE("dxf scan: line ends of Windows, a mark of UTF-8, blanks around values") {
  std::string windows = "\xef\xbb\xbf";
  for (const char c : kWhole) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const DxfScan s = scan_dxf(windows + "\r\n\r\n");
  CHECK(s.defect.empty());
  CHECK(s.insunits == 4);
}

TEST_CASE("dxf scan: a text that ends anywhere is called cut short, with its line") {
  // every prefix that is shorter by a character of the last word or more
  for (size_t n = 0; n + 2 < kWhole.size(); ++n) {
    INFO(n);
    const std::string defect = scan_dxf(kWhole.substr(0, n)).defect;
    CHECK(defect.find("line") != std::string::npos);
  }
  CHECK(scan_dxf(kWhole.substr(0, 60)).defect.find("cut short") != std::string::npos);
}

TEST_CASE("dxf scan: binary files, drawings of another format, pairs out of step, text after the end") {
  using namespace std::string_literals;
  CHECK(scan_dxf("AutoCAD Binary DXF\r\n\x1a\0\0\0"s).defect.find("ASCII DXF") != std::string::npos);
  CHECK(scan_dxf("AC1015\0\0\0\0"s).defect.find("DWG") != std::string::npos);
  CHECK(scan_dxf("  0\nSECTION\nHEADER\n  9\n").defect.find("line 3: expected a group code") == 0);
  CHECK(scan_dxf(kWhole + "  0\nLINE\n").defect.find("goes on after its EOF") != std::string::npos);
}

}  // namespace test_dxf_scan
