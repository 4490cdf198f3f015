// [history.NAME] given by file, column and scale.

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/record_text.h"
#include "support/relative.h"
#include "talus/model/read_model.h"

namespace test_history_file {

using namespace talus;
using namespace talus::test;

namespace {

// A folder with a model and the files it names, removed at its end.
class Case {
 public:
  Case() : folder_(std::filesystem::temp_directory_path() / fmt::format("talus_history_{}", getpid())) {
    std::filesystem::create_directories(folder_);
  }
  ~Case() { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  // The model with one history of these keys, and a load that it drives.
  // @param use  by which that takes it; a force asks for no quantity
  Model read(const std::string& keys, const std::vector<std::string>& overrides = {},
             const std::string& use = "point = [0, 0]\nforce_x = \"h\"\n") {
    const std::string text = "talus = 1\n[history.h]\n" + keys + "\n[[load]]\nname = \"shake\"\n" + use;
    const std::string file = (folder_ / "model.toml").string();
    Findings findings(file, text);
    Model model = read_model(file, text, overrides, findings);
    message = findings.render();
    for (size_t at = message.find(folder_.string()); at != std::string::npos;
         at = message.find(folder_.string()))
      message.erase(at, folder_.string().size() + 1);
    return model;
  }

  std::string message;

 private:
  std::filesystem::path folder_;
};

const std::string kTable =
    "time [ms],acceleration [m/s2],v_cm_s,top.x [mm],turn [rad],bare,both_m [cm],far [mile]\n"
    "0,1,10,5,0.1,7,1,1\n10,2,20,6,0.2,8,1,1\n40,4,40,7,0.3,9,1,1\n";

}  // namespace

TEST_CASE("history file: columns by title, name and quantity become SI, steps may be uneven") {
  Case c;
  c.write("m.csv", kTable);
  const Model model = c.read("file = \"m.csv\"\ncolumn = \"acceleration\"\n");
  CHECK(c.message == "");
  const History& h = model.histories[0];
  CHECK(h.time == std::vector<double>{0, 0.01, 0.04});
  CHECK(h.value == std::vector<double>{1, 2, 4});
  CHECK(h.integral[2] == approx(0.015 + 0.09));
  CHECK(c.read("file = \"m.csv\"\ncolumn = \"velocity\"\n").histories[0].value ==
        std::vector<double>{0.1, 0.2, 0.4});
  CHECK(c.read("file = \"m.csv\"\ncolumn = \"v_cm_s\"\n").histories[0].value ==
        std::vector<double>{0.1, 0.2, 0.4});
  CHECK(c.read("file = \"m.csv\"\ncolumn = \"top.x\"\n").histories[0].value ==
        std::vector<double>{0.005, 0.006, 0.007});
  CHECK(c.read("file = \"m.csv\"\ncolumn = \"turn [rad]\"\n").histories[0].value ==
        std::vector<double>{0.1, 0.2, 0.3});
  CHECK(c.message == "");
}

TEST_CASE("history file: scale, and the only column") {
  Case c;
  c.write("m.csv", "t [s],x_g\n0,0\n1,0.5\n");
  CHECK(c.read("file = \"m.csv\"\nscale = -2\n").histories[0].value[1] == approx(-9.80665));
  CHECK(c.read("time = [0, 1]\nvalue = [1, 2]\nscale = 3\n").histories[0].value == std::vector<double>{3, 6});
  CHECK(c.message == "");
}

TEST_CASE("history file: bare values take their step and unit from the model") {
  Case c;
  c.write("bare.txt", "1\n2\n-3\n");
  const Model model = c.read("file = \"bare.txt\"\ndt = \"20 ms\"\nunit = \"gal\"\n");
  CHECK(c.message == "");
  CHECK(model.histories[0].time == std::vector<double>{0, 0.02, 0.04});
  CHECK(model.histories[0].value[2] == approx(-0.03));
  CHECK(c.read("file = \"bare.txt\"\ndt = \"1 s\"\nunit = \"N\"\n").histories[0].value ==
        std::vector<double>{1, 2, -3});
  c.write("table.csv", "t [s],ax\n0,1\n1,5\n");
  CHECK(c.read("file = \"table.csv\"\nunit = \"cm/s2\"\n").histories[0].value[1] == approx(0.05));
  CHECK(c.message == "");
  // without them, or against what the file says
  c.read("file = \"bare.txt\"\n");
  CHECK(c.message.find("or say dt = ") != std::string::npos);
  c.read("file = \"bare.txt\"\ndt = \"20 ms\"\n");
  CHECK(c.message.find("no unit of the values is named") != std::string::npos);
  c.read("file = \"table.csv\"\nunit = \"furlong\"\n");
  CHECK(c.message.find("the unit \"furlong\" is not known") != std::string::npos);
  c.write("named.csv", "t [s],ax [m/s2]\n0,1\n1,5\n");
  c.read("file = \"named.csv\"\nunit = \"gal\"\n");
  CHECK(c.message.find("the unit is named twice") != std::string::npos);
  c.read("time = [0, 1]\nvalue = [1, 2]\nunit = \"gal\"\n");
  CHECK(c.message.find("history.h.unit: belongs to a file") != std::string::npos);
}

TEST_CASE("history file: records are read as talus record reads them") {
  Case c;
  c.write("a.AT2",
          peer_text("ACCELERATION TIME SERIES IN UNITS OF G", "NPTS= 4, DT= .5 SEC", {0, 0.1, 0.2, 0}));
  const Model model = c.read("file = \"a.AT2\"\n");
  CHECK(c.message == "");
  CHECK(model.histories[0].time == std::vector<double>{0, 0.5, 1, 1.5});
  CHECK(model.histories[0].value[2] == approx(1.96133));
  c.read("file = \"a.AT2\"\ncolumn = \"velocity\"\n");
  CHECK(c.message.find("there is no column \"velocity\" in this PEER file") != std::string::npos);
  c.write("j.csv", jma_text({1, 2, 3}, 100));
  CHECK(c.read("file = \"j.csv\"\ncolumn = \"UD\"\n").histories[0].value ==
        std::vector<double>{0.02, 0.04, 0.06});
}

TEST_CASE("history file: the content belongs to the hash of the model") {
  Case c;
  const std::string keys = "file = \"m.csv\"\n";
  c.write("m.csv", "t [s],x_m\n0,0\n1,0.5\n");
  const std::string first = c.read(keys).hash;
  CHECK(c.read(keys).hash == first);
  c.write("m.csv", "t [s],x_m\n0,0\n1,0.6\n");
  CHECK(c.read(keys).hash != first);
}

TEST_CASE("history file: each kind of wrong input has its message") {
  Case c;
  c.write("m.csv", kTable);
  c.write("bare.csv", "0,1\n1,2\n");
  c.write("back.csv", "t [s],x_m\n0,1\n0,2\n");
  c.write("nan.csv", "t [s],x_m\n0,1\n1,nan\n");
  c.write("one.csv", "t [s],x_m\n0,1\n");
  c.write("empty.csv", "");
  struct Wrong {
    std::string keys, part;
  };
  const std::string titles =
      "\"time [ms]\", \"acceleration [m/s2]\", \"v_cm_s\", \"top.x [mm]\", \"turn [rad]\", \"bare\", "
      "\"both_m [cm]\", \"far [mile]\"";
  const Wrong cases[] = {
      {"file = \"no.csv\"\n",
       "model.toml:3:1: error: history.h.file: no.csv: cannot be read: No such file or directory\n"},
      {"file = \"no.csv\"\n", "= the path counts from the folder of the model file"},
      {"file = \"\"\n", "history.h.file: is empty"},
      {"file = 3\n", "history.h.file: is a number; expected text in quotes"},
      {"file = \"m.csv\"\n",
       "m.csv:1: error: it is open which column to read\n      = say it with column = \"...\"; there is " +
           titles},
      {"file = \"m.csv\"\ncolumn = \"x\"\n",
       "model.toml:4:1: error: history.h.column: cannot be read\nm.csv:1: error: there is no column \"x\"\n  "
       "    = there is " +
           titles},
      {"file = \"m.csv\"\ncolumn = \"time [ms]\"\n", "m.csv:1: error: \"time [ms]\" is the time itself"},
      {"file = \"m.csv\"\ncolumn = \"bare\"\n",
       "m.csv:1: error: \"bare\" names no unit\n      = write it as \"bare [m/s2]\"; units are "},
      {"file = \"m.csv\"\ncolumn = \"both\"\n", "m.csv:1: error: \"both_m [cm]\" names two units: m and cm"},
      {"file = \"m.csv\"\ncolumn = \"far\"\n", "m.csv:1: error: the unit \"mile\" is not known"},
      {"file = \"bare.csv\"\n",
       "bare.csv: error: there is no column of time\n      = begin the file with a line of titles"},
      {"file = \"back.csv\"\n", "back.csv:3: error: time does not rise: 0 s is followed by 0 s"},
      {"file = \"nan.csv\"\n", "nan.csv:3: error: column \"x_m\": \"nan\" is not a finite number"},
      {"file = \"one.csv\"\n", "one.csv:2: error: the table has one row"},
      {"file = \"empty.csv\"\n", "empty.csv: error: is empty"},
      {"column = \"x\"\ntime = [0, 1]\nvalue = [0, 1]\n", "history.h.column: belongs to a file"},
      {"file = \"m.csv\"\ntime = [0, 1]\nvalue = [0, 1]\n", "history.h: is given in more than one way"},
      {"file = \"m.csv\"\nexpression = \"t\"\nduration = 1\n", "history.h: is given in more than one way"},
      {"file = \"m.csv\"\ncolumn = \"v_cm_s\"\nduration = 1\n",
       "history.h.duration: belongs to an expression"},
      {"scale = 2\n", "history.h: is empty\n"},
      {"scale = \"big\"\ntime = [0, 1]\nvalue = [0, 1]\n", "history.h.scale: "},
  };
  for (const Wrong& w : cases) {
    c.read(w.keys);
    INFO("keys:\n", w.keys, "\nmessage:\n", c.message, "\nshould hold:\n", w.part);
    CHECK(c.message.find(w.part) != std::string::npos);
  }
}

TEST_CASE("history file: a column of another quantity than what it drives is refused") {
  Case c;
  c.write("m.csv", kTable);
  const auto of = [](const std::string& column) { return "file = \"m.csv\"\ncolumn = \"" + column + "\"\n"; };
  const std::string shake = "acceleration_x = \"h\"\n";
  c.read(of("acceleration"), {}, shake);
  CHECK(c.message == "");
  c.read(of("v_cm_s"), {}, shake);
  CHECK(
      c.message.find(
          "load.shake.acceleration_x: wants an acceleration; history \"h\" is a velocity, by the unit in its file") !=
      std::string::npos);
  const std::string table = "point = [0, 0]\nforce_x = 1\n[[support]]\nname = \"s\"\npoint = [0, 0]\n";
  c.read(of("acceleration"), {}, table + "x = { velocity = \"h\" }\n");
  CHECK(c.message.find("support.s.x: wants a velocity; history \"h\" is an acceleration") !=
        std::string::npos);
  c.read(of("v_cm_s"), {}, table + "x = { displacement = \"h\" }\n");
  CHECK(c.message.find("support.s.x: wants a displacement; history \"h\" is a velocity") !=
        std::string::npos);
  c.read(of("v_cm_s"), {}, table + "x = { velocity = \"h\" }\n");
  CHECK(c.message == "");
}

}  // namespace test_history_file
