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

/// Fields of `width` characters with `digits` behind the point, nothing between them.
inline std::string fields(const std::vector<double>& values, int width, int digits, int per_line,
                          char form = 'f') {
  std::string out;
  for (size_t i = 0; i < values.size(); ++i) {
    out += form == 'e' ? fmt::format("{:{}.{}e}", values[i], width, digits)
                       : fmt::format("{:{}.{}f}", values[i], width, digits);
    if (i % static_cast<size_t>(per_line) == static_cast<size_t>(per_line) - 1 || i + 1 == values.size())
      out += "\n";
  }
  return out;
}

/// @param values  [cm/s2]
inline std::string esm_text(const std::vector<double>& values, double dt) {
  std::string out = fmt::format(
      "EVENT_NAME: NOWHERE\nNETWORK: XX\nSTATION_CODE: TST\nVS30_M/S: \nSAMPLING_INTERVAL_S: {:.6f}\nNDATA: {}\nSTREAM: HNE\n"
      "UNITS: cm/s^2\nBASELINE_CORRECTION: BASELINE REMOVED\nFILTER_TYPE: BUTTERWORTH\nFILTER_ORDER: 2\nLOW_CUT_FREQUENCY_HZ: 0.100\n"
      "HIGH_CUT_FREQUENCY_HZ: 30.000\nDATA_TYPE: ACCELERATION\nUSER5: \n",
      dt, values.size());
  return out + fields(values, 0, 6, 1);
}

/// Two components, the second with twice the values. @param values  [mm/s2]
inline std::string geonet_text(const std::vector<double>& values, double dt) {
  std::string out;
  for (const double factor : {1.0, 2.0}) {
    std::vector<double> v = values;
    for (double& x : v) x *= factor;
    out += fmt::format(
        "Corrected accelerogram 20200101_TST_20 GNS Science\nSite TST\nNowhere\nInstrument\nResolution\nAccelerogram\nnear\ndate\n"
        "Epicentre\nNumber of points  {}    Duration 1.0 sec\nInstrument corrected data at {:.3f} sec intervals\n"
        "Band-pass filter transition bands are .10-.25 Hz and 24.50-25.50 Hz\nComponent {}  Axis\n"
        "Acceleration:  peak\nVelocity:\nDisplacement:\n",
        values.size(), dt, factor == 1 ? "N28W" : "Up");
    for (int k = 0; k < 10; ++k) out += "     0.0     0.0\n";
    out += fields(v, 8, 1, 10) + fields(v, 8, 2, 10) + fields(v, 8, 3, 10);
  }
  return out;
}

/// Two channels, the second with twice the values. @param values  [cm/s2]
inline std::string csmip_text(const std::vector<double>& values, double dt) {
  std::string out;
  for (int channel = 1; channel <= 2; ++channel) {
    std::vector<double> v = values;
    for (double& x : v) x *= channel;
    out += fmt::format("Corrected accelerogram   99999-L1-1            Chan  {}: {} Deg     from\n", channel,
                       90 * channel);
    out += "Uncorrected Accelerogram Data\nRcrd of\nCSMIP\n99999\nStation No.\nNowhere - Test\n";
    out += "Accelerogram bandpass filtered with 3 dB pts at   .07 and 40.00 cyc/sec\n";
    for (const char* kind : {"accel", "veloc", "displ"})
      out += fmt::format("  {} points of {} data equally spaced at  {:.3f} sec, in {} (8f10.5)\n", v.size(),
                         kind, dt, kind[0] == 'a' ? "cm/sec2." : "cm/sec. ") +
             fields(v, 10, 5, 8);
    out += "/&  ----------  End of data for channel\n";
  }
  return out;
}

/// @param values  [cm/s2]
inline std::string cosmos_text(const std::vector<double>& values, double dt) {
  std::vector<double> real(100, -999);
  real[61] = 1e3 * dt;
  std::string out = "Corrected acceleration    (Format v01.20 with 13 text lines)\n";
  for (int k = 2; k <= 13; ++k)
    out += k == 9    ? "Sta Chan   1: 90 deg (Rcrdr Chan  1) Location:\n"
           : k == 12 ? "Record filtered below  0.03 Hz (periods over 33.33 secs), and above 20.0 Hz\n"
                     : fmt::format("text {}\n", k);
  out += " 100 Integer-header values follow on  10 lines, Format= (10I8)\n" +
         fields(std::vector<double>(100, -999), 8, 0, 10);
  out += " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n" + fields(real, 15, 6, 5);
  out += "   1 Comment line(s) follow, each starting with a \"|\":\n| none\n";
  out += fmt::format("   {} acceleration pts, approx   1 secs, units=cm/sec2(04),Format=(1E15.6)\n",
                     values.size());
  return out + fields(values, 15, 6, 1, 'e') + "End-of-data\n";
}

/// @param values  [cm/s2]
inline std::string smc_text(const std::vector<double>& values, double dt) {
  std::vector<double> whole(48, -32768), real(50, 1.7e38);
  whole[15] = 2, whole[16] = static_cast<double>(values.size()), real[1] = 1 / dt;
  std::string out =
      "2 CORRECTED ACCELEROGRAM\n*\nA020A\ndate\nmag\nstation = Test   component=    133\ndist\ninst\n*\n*\n*\n";
  out += fields(whole, 10, 0, 8) + fields(real, 15, 7, 5, 'e') + "|\n|a comment\n";
  return out + fields(values, 10, 3, 8, 'e');
}

}  // namespace talus::test
