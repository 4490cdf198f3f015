// Every kind of wrong record has its message: file, line, what was found, what to do next.

#include <doctest/doctest.h>

#include "support/record_text.h"
#include "talus/base/error.h"
#include "talus/record/read_record.h"

namespace test_wrong_record {

using namespace talus;
using namespace talus::record;
using namespace talus::test;

namespace {

std::string message(const std::string& text, const ReadOptions& options = {}) {
  try {
    read_record_text("r", text, options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "(accepted)";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

const std::string kPeer =
    "title\nevent\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 6, DT= .0100 SEC\n.1 .2 .3 .4 .5\n.6\n";
const std::string kCsv = "time [s],a_gal\n0,1\n0.01,2\n0.02,3\n0.03,4\n";
const std::string kJma = jma_text({1, 2, 3}, 100);
const std::string kKnet = knet_text(std::vector<double>(200, 1.0), 100, 5);
const std::string kUnits = "m/s2, cm/s2, mm/s2, gal, g, m/s, cm/s, mm/s, kine, m, cm, mm";

}  // namespace

TEST_CASE("wrong record: the sound ones are accepted") {
  CHECK(message(kPeer) == "(accepted)");
  CHECK(message(kCsv) == "(accepted)");
  CHECK(message(kKnet) == "(accepted)");
  CHECK(message(kJma, {{}, "NS", "", {}}) == "(accepted)");
}

TEST_CASE("record: what old media put behind the end of a file is no part of it") {
  for (const std::string& end : {std::string(500, '\0'), std::string("\x1a"), std::string("\x1a\0\0", 3)})
    CHECK(message(kPeer + end, {}) == "(accepted)");
  CHECK(message(std::string(500, '\0'), {}) == "r: error: is empty\n      = fetch or write the file again");
}

TEST_CASE("wrong record: each kind has its message") {
  struct Wrong {
    std::string text;
    ReadOptions options;
    std::string message;
  };
  const std::string correct = "correct the line, or cut what does not belong to the record";
  const Wrong cases[] = {
      // files
      {"", {}, "r: error: is empty\n      = fetch or write the file again"},
      {" \n\n", {}, "r: error: is empty\n      = fetch or write the file again"},
      {std::string("a\0b", 3),
       {},
       "r: error: is not a text file\n      = records are text: PEER, K-NET, JMA, ESM, GeoNet, CSMIP, COSMOS, SMC or a table; SAC and miniSEED are not read"},
      // PEER
      {replaced(kPeer, "\n.6", ""),
       {},
       "r:5: error: the file ends after 5 of 6 values (NPTS)\n      = it is cut short: fetch it again"},
      {kPeer + ".7\n",
       {},
       "r:7: error: there are 7 values, but NPTS is 6\n      = correct NPTS, or take away what does not "
       "belong to the record"},
      {replaced(kPeer, "DT= .0100 SEC", ""),
       {},
       "r:4: error: count and time step are not understood: \"NPTS= 6,\"\n      = write the line as NPTS= "
       "4000, DT= .0050 SEC"},
      {replaced(kPeer, "NPTS= 6, DT= .0100 SEC\n", ""),
       {},
       "r:4: error: there is no NPTS and DT in the header of this PEER file\n      = line 4 of an AT2 file "
       "says NPTS= 4000, DT= .0050 SEC; otherwise read the values as CSV: --format csv --dt"},
      {replaced(kPeer, ".0100", ".0000"),
       {},
       "r:4: error: the time step is 0 s\n      = it must be above 0 s; correct the header"},
      {replaced(kPeer, ".0100", "-.01"),
       {},
       "r:4: error: the time step is -0.01 s\n      = it must be above 0 s; correct the header"},
      {replaced(kPeer, "= 6,", "= 0,"),
       {},
       "r:4: error: NPTS is 0\n      = it must be the number of values, from 2 on"},
      {kPeer,
       {{}, "", "", 0.02},
       "r:4: error: the time step is 0.01 s here, 0.02 s by --dt\n      = leave --dt out, or correct the "
       "file"},
      {replaced(kPeer, ".3", "nan"),
       {},
       "r:5: error: value 3: \"nan\" is not a finite number\n      = " + correct},
      {replaced(kPeer, ".3", "inf"),
       {},
       "r:5: error: value 3: \"inf\" is not a finite number\n      = " + correct},
      {replaced(kPeer, ".3", "1e999"),
       {},
       "r:5: error: value 3: \"1e999\" is beyond the range of numbers\n      = " + correct},
      {replaced(kPeer, ".3", "x3"), {}, "r:5: error: value 3: \"x3\" is not a number\n      = " + correct},
      {replaced(kPeer, "OF G", "OF FURLONGS"),
       {},
       "r:3: error: the unit \"furlongs\" is not known\n      = units are " + kUnits},
      {replaced(kPeer, "OF G", "OF G, CM/S2"),
       {},
       "r:3: error: two units are named: g and cm/s2\n      = leave the right one only"},
      {replaced(kPeer, "OF G", "OF CM"),
       {},
       "r:3: error: the header speaks of acceleration in cm\n      = a unit of acceleration is m/s2"},
      {replaced(kPeer, "ACCELERATION TIME SERIES IN UNITS OF G", "-"),
       {},
       "r:4: error: no unit of the values is named\n      = say it with --unit, or in the title as "
       "\"acceleration [m/s2]\"; units are " +
           kUnits},
      {kPeer,
       {{}, "", "gal", {}},
       "r:3: error: the unit is named twice: g here, gal by --unit\n      = leave --unit out, or correct the "
       "file"},
      {kPeer,
       {{}, "", "stone", {}},
       "r: error: --unit stone: the unit is not known\n      = units are " + kUnits},
      {"t\ne\nACCELERATION IN UNITS OF G\nNPTS= 1, DT= .01 SEC\n.1\n",
       {},
       "r:5: error: the record has 1 value\n      = a motion needs at least two"},
      // K-NET
      {replaced(kKnet, "Scale Factor      3920(gal)/6182761\n", ""),
       {},
       "r:17: error: the header has no line \"scale factor\"\n      = a K-NET file has 17 header lines, from "
       "Origin Time to Memo.; fetch it again"},
      {replaced(kKnet, "3920(gal)/6182761", "0.5"),
       {},
       "r:14: error: the scale factor \"0.5\" is not understood\n      = it is written as in "
       "3920(gal)/6182761"},
      {replaced(kKnet, "(gal)/", "(ell)/"),
       {},
       "r:14: error: the unit \"ell\" is not known\n      = units are " + kUnits},
      {replaced(kKnet, "3920(gal)/6182761", "3920(gal)/0"),
       {},
       "r:14: error: the scale factor is \"3920(gal)/0\"\n      = both numbers must be above 0"},
      {replaced(kKnet, "100Hz", "fast"),
       {},
       "r:11: error: sampling frequency: \"fast\" is not understood\n      = it is written as in 100Hz"},
      {replaced(kKnet, "100Hz", "0Hz"),
       {},
       "r:11: error: the sampling frequency is 0\n      = correct the header; it is written as in 100Hz"},
      {kKnet.substr(0, kKnet.size() - 90),
       {},
       "r:41: error: there are 190 values, but duration and sampling frequency make 200\n      = the file is "
       "cut short: fetch it again"},
      {kKnet + "7 8\n",
       {},
       "r:12: error: there are 202 values, but duration and sampling frequency make 200\n      = correct the "
       "header"},
      {replaced(kKnet, " 1582 \n", " 1582.5 \n"),
       {},
       "r:18: error: 1582.5 is not a whole count of the logger\n      = K-NET data are integers; read other "
       "tables as CSV: --format csv"},
      // JMA
      {kJma,
       {},
       "r:7: error: it is open which component to read\n      = say it with --column; there is \"NS\", "
       "\"EW\", \"UD\""},
      {kJma,
       {{}, "XX", "", {}},
       "r:7: error: there is no column \"XX\"\n      = there is \"NS\", \"EW\", \"UD\""},
      {replaced(kJma, "100Hz", "?"),
       {{}, "NS", "", {}},
       "r:4: error: the sampling rate \"?\" is not understood\n      = it is written as in 100Hz"},
      {replaced(kJma, "SAMPLING RATE= 100Hz,\n", ""),
       {{}, "NS", "", {}},
       "r:6: error: the header has no SAMPLING RATE\n      = add it, as in SAMPLING RATE= 100Hz"},
      {replaced(kJma, "gal(cm/s/s)", "gal(m/s/s)"),
       {{}, "NS", "", {}},
       "r:5: error: two units are named: gal and m/s2\n      = leave the right one only"},
      {replaced(kJma, "UNIT  = gal(cm/s/s),\n", ""),
       {{}, "NS", "", {}},
       "r:6: error: no unit of the values is named\n      = say it with --unit, or in the title as "
       "\"acceleration [m/s2]\"; units are " +
           kUnits},
      {replaced(kJma, "NS,EW,UD,\n", ""),
       {{}, "NS", "", {}},
       "r:9: error: there is no line of components (NS,EW,UD)\n      = the file may be cut short: fetch it "
       "again, or read it as CSV: --format csv"},
      {replaced(kJma, "1.0000,2.0000,4.0000", "1.0000,2.0000"),
       {{}, "NS", "", {}},
       "r:9: error: the row has 2 cells, the table 3 columns\n      = correct the row, or the title line"},
      // CSV
      {replaced(kCsv, "a_gal", "a"),
       {},
       "r:1: error: no unit of the values is named\n      = say it with --unit, or in the title as "
       "\"acceleration [m/s2]\"; units are " +
           kUnits},
      {replaced(kCsv, "a_gal", "a []"),
       {},
       "r:1: error: no unit of the values is named\n      = say it with --unit, or in the title as "
       "\"acceleration [m/s2]\"; units are " +
           kUnits},
      {replaced(kCsv, "a_gal", "a [ell]"),
       {},
       "r:1: error: the unit \"ell\" is not known\n      = units are " + kUnits},
      {replaced(kCsv, "a_gal", "a_gal [m/s2]"),
       {},
       "r:1: error: \"a_gal [m/s2]\" names two units: gal and m/s2\n      = leave the right one only"},
      {kCsv,
       {{}, "", "g", {}},
       "r:1: error: the unit is named twice: gal here, g by --unit\n      = leave --unit out, or correct the "
       "file"},
      {replaced(kCsv, "a_gal", "velocity [m/s2]"),
       {},
       "r:1: error: \"velocity [m/s2]\": velocity has no unit m/s2\n      = a unit of velocity is m/s"},
      {replaced(kCsv, "[s]", "[min]"),
       {},
       "r:1: error: \"time [min]\": the unit of the time is not known\n      = it is s or ms"},
      {"t_s,time [s],a_gal\n0,0,1\n1,1,2\n",
       {},
       "r:1: error: there are two columns of time\n      = leave one: \"t_s\", \"time [s]\", \"a_gal\""},
      {"a_gal\n1\n2\n",
       {},
       "r:1: error: there is no column of time and no time step\n      = give --dt in s, or a column \"time "
       "[s]\""},
      {"time [s]\n0\n1\n",
       {},
       "r:1: error: there is no column beside the time\n      = say it with --column; there is \"time [s]\""},
      {replaced(kCsv, "0.02,", "0.025,"),
       {},
       "r:4: error: time steps are uneven: 0.025 s stands where equal steps of 0.01 s lead to 0.02 s\n      "
       "= resample the record to equal steps; where times are only rounded too far, give --dt"},
      {replaced(kCsv, "0.02,", "0.01,"),
       {},
       "r:4: error: time does not rise: 0.01 s is followed by 0.01 s\n      = sort the rows by time, each "
       "time once"},
      {kCsv,
       {{}, "", "", 0.03},
       "r:4: error: time steps are uneven: 0.02 s stands where equal steps of 0.03 s lead to 0.06 s\n      = "
       "resample the record to equal steps; where times are only rounded too far, give --dt"},
      {replaced(kCsv, "0.01,2", "0.01"),
       {},
       "r:3: error: the row has 1 cells, the table 2 columns\n      = correct the row, or the title line"},
      {replaced(kCsv, "0.03,4", "0.0"),
       {},
       "r:5: error: the row has 1 cells, the table 2 columns\n      = the file may be cut short: fetch or "
       "write it again"},
      {replaced(kCsv, "0.01,2", "0.01,two"),
       {},
       "r:3: error: column \"a_gal\": \"two\" is not a number\n      = " + correct},
      {replaced(kCsv, "0.01,2", "0.01,"),
       {},
       "r:3: error: the row has 1 cells, the table 2 columns\n      = correct the row, or the title line"},
      {"t [s],a_gal\n0,1\n20,2\n40,3\n",
       {},
       "r: error: the time step is 20 s\n      = steps of a motion are 1e-05 to 1 s; is the unit of the time "
       "the right one?"},
      {"time [s],a_gal\n",
       {},
       "r:1: error: there is no row of numbers\n      = the file may be cut short: fetch or write it again"},
      {"time [s],x_gal,y_gal\n0,1,2\n1,2,3\n",
       {},
       "r:1: error: it is open which column to read\n      = say it with --column; there is \"time [s]\", "
       "\"x_gal\", \"y_gal\""},
      {"time [s],x_gal,x_g\n0,1,2\n1,2,3\n",
       {{}, "x", "", {}},
       "r:1: error: 2 columns are called \"x\"\n      = name it by its whole title, and let no two titles be "
       "the same; there is \"time [s]\", \"x_gal\", \"x_g\""},
  };
  for (const Wrong& w : cases) CHECK(message(w.text, w.options) == w.message);
}

TEST_CASE("wrong record: a file that is not there") {
  try {
    read_record("no/such/file.AT2");
    FAIL("accepted");
  } catch (const FileError& e) {
    CHECK(std::string(e.what()) ==
          "no/such/file.AT2: cannot be read: No such file or directory\n      = check the path; it counts "
          "from the folder that talus runs in");
  }
}

}  // namespace test_wrong_record
