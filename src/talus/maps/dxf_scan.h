#pragma once
// A look over the text of a DXF before its geometry is read: is it whole, what are its units, what does it
// hold.

#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace talus::maps {

struct DxfScan {
  std::string defect;  // what makes the file unusable, with its line; empty: none
  int insunits = 0;    // $INSUNITS; 0: not given
  std::map<std::pair<std::string, std::string>, int> entities;  // (layer, kind) -> count, blocks included
  std::map<std::string, int> fit_splines;                       // layer -> splines given by fit points alone
};

/// Reads the pairs of group code and value of `text`. Geometry is not looked at.
DxfScan scan_dxf(std::string_view text);

/// Metres in a unit of $INSUNITS, and its name; NaN and "" when it is none or not known.
std::pair<double, std::string> insunits_unit(int code);

}  // namespace talus::maps
