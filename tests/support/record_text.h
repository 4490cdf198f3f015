#pragma once
// Writes a motion in the formats that records come in, to read it back.

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace talus::test {

/// Fortran E15.7 without the leading zero: ".1416764E-03".
inline std::string fortran_number(double v) {
  if (v == 0) return ".0000000E+00";
  int exponent = static_cast<int>(std::floor(std::log10(std::abs(v)))) + 1;
  double digits = std::round(std::abs(v) / std::pow(10, exponent) * 1e7);
  if (digits >= 1e7) digits = 1e6, ++exponent;
  return fmt::format("{}.{:07.0f}E{}{:02}", v < 0 ? "-" : "", digits, exponent < 0 ? "-" : "+",
                     std::abs(exponent));
}

/// @param units    "ACCELERATION TIME SERIES IN UNITS OF G"
/// @param counts   the whole line of count and step
/// @param values   in the file's unit
inline std::string peer_text(const std::string& units, const std::string& counts,
                             const std::vector<double>& values, int per_line = 5) {
  std::string out = "PEER STRONG MOTION DATABASE RECORD\nNOWHERE 01/17/95 20:46, TEST, 000\n" + units + "\n" +
                    counts + "\n";
  for (size_t i = 0; i < values.size(); ++i) {
    out += fmt::format("{:>15}", fortran_number(values[i]));
    if (i % static_cast<size_t>(per_line) == static_cast<size_t>(per_line) - 1) out += "\n";
  }
  return out + "\n";
}

/// @param gal  values [cm/s2]; counts are rounded at 3920 / 6182761 gal, `offset` counts are added
inline std::string knet_text(const std::vector<double>& gal, double frequency, int offset) {
  std::string out = fmt::format(
      "Origin Time       1996/09/11 11:37:00\nLat.              35.6\nLong.             141.2\n"
      "Depth. (km)       52\nMag.              6.2\nStation Code      CHB002\nStation Lat.      35.7845\n"
      "Station Long.     140.0207\nStation Height(m) 20\nRecord Time       1996/09/11 11:37:43\n"
      "Sampling Freq(Hz) {:g}Hz\nDuration Time(s)  {:g}\nDir.              E-W\n"
      "Scale Factor      3920(gal)/6182761\nMax. Acc. (gal)   37.284\nLast Correction   1996/09/11 "
      "11:37:31\nMemo.\n",
      frequency, static_cast<double>(gal.size()) / frequency);
  for (size_t i = 0; i < gal.size(); ++i)
    out += fmt::format("{:>8} {}", std::llround(gal[i] * 6182761 / 3920) + offset, i % 8 == 7 ? "\n" : "");
  return out + "\n";
}

/// Three components: half, whole and twice the values [gal], three decimals.
inline std::string jma_text(const std::vector<double>& gal, double frequency) {
  std::string out = fmt::format(
      "SITE CODE= 47772OSAKA     ,\nLAT.=   34.6817,\nLON.=  135.5200,\nSAMPLING RATE= {:g}Hz,\nUNIT  = "
      "gal(cm/s/s),\n"
      "INITIAL TIME = 2000 10 06 13 30 18,\nNS,EW,UD,\n",
      frequency);
  for (const double v : gal) out += fmt::format("{:.4f},{:.4f},{:.4f},\n", 0.5 * v, v, 2 * v);
  return out;
}

/// @param titles  the first line
/// @param factor  SI value of the unit of the values
inline std::string csv_text(const std::string& titles, const std::vector<double>& si, double dt,
                            double factor) {
  std::string out = titles + "\n";
  for (size_t i = 0; i < si.size(); ++i)
    out += fmt::format("{:.10g},{}\n", static_cast<double>(i) * dt, si[i] / factor);
  return out;
}

}  // namespace talus::test
