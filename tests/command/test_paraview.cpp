// The state file for ParaView in a result folder: there and sound Python every day; in the suite "long: paraview",
// where pvpython is installed, opened by ParaView itself without a word on its streams, its picture looked at.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "support/command.h"
#include "talus/output/files.h"
#include "talus/output/paraview_view.h"

namespace test_paraview {

using namespace talus;
using namespace talus::test;

namespace {

std::string example(const std::string& name) {
  return fmt::format("{}/examples/{}/{}.toml", TALUS_SOURCE_DIR, name, name);
}

bool there(const Folder& f, const std::string& program) {
  return shell(f, "command -v " + program).code == 0;
}

// Opens the view as `pvpython view.py picture.png` does, then shows what is hidden and goes through all frames.
// Looks at the picture: a place of the model has the wanted colour, and in all there are many colours and white.
constexpr const char* kDriver = R"python(
import runpy
import sys

script, picture, bolts, x, y, filled = sys.argv[1:]
sys.argv = [script, picture]
seen = runpy.run_path(script, run_name="__main__")
pv, view, times = seen["pv"], seen["view"], seen["times"]
assert (seen["bolts"] is not None) == (bolts == "bolts")
assert len(times) > 2 and seen["scene"].AnimationTime == times[-1] == view.ViewTime, "not the last frame"
assert {name for name, _ in pv.GetSources()} == {"blocks", "contacts", "forces on block a", "time"} | ({"bolts"} if bolts == "bolts" else set())

from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.util.numpy_support import vtk_to_numpy

reader = vtkPNGReader()
reader.SetFileName(picture)
reader.Update()
width, height = reader.GetOutput().GetDimensions()[:2]
pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3].reshape(height, width, 3).astype(int)
white = (pixels == 255).all(axis=2).mean()
colours = len({tuple(p) for p in pixels[::5, ::5].reshape(-1, 3)})
assert 0.3 < white < 0.95, white
assert colours > 50, colours
metre = height / 2 / view.CameraParallelScale
column = round(width / 2 + (float(x) - view.CameraFocalPoint[0]) * metre)
row = round(height / 2 + (float(y) - view.CameraFocalPoint[1]) * metre)
place = pixels[row - 2:row + 3, column - 2:column + 3]
assert (place == 255).all() == (filled != "filled"), place

for source in [seen["contacts"], seen["forces"]]:
    pv.Show(source, view)
for time in times:
    seen["scene"].AnimationTime = time
    pv.Render(view)
)python";

// A display of its own, that no window manager or driver of the machine has a part in.
std::string on_display(const std::string& line) {
  return fmt::format(
      "rm -f display; Xvfb -displayfd 3 -noreset -screen 0 1280x1024x24 -nolisten tcp 3>display "
      ">/dev/null 2>&1 & server=$!; for i in $(seq 100); do [ -s display ] && break; sleep 0.1; done; "
      "DISPLAY=:$(cat display) HOME=$PWD {}; code=$?; kill $server; exit $code",
      line);
}

}  // namespace

TEST_CASE("paraview: the state file of a run is Python") {
  const Folder f;
  REQUIRE(shell(f, fmt::format("$talus run {} -o out -q", example("sliding_block"))).code == 0);
  CHECK(content(f / "out" / kParaviewView) == paraview_view());
  has(content(f / "out/talus_manifest.txt"), fmt::format("{}\n", kParaviewView));
  const Outcome o =
      shell(f, fmt::format("python3 -c 'import ast; ast.parse(open(\"out/{}\").read())'", kParaviewView));
  INFO(o.text);
  CHECK(o.code == 0);
}

TEST_SUITE("long: paraview") {
  TEST_CASE("paraview: the state file opens without a warning, and shows the blocks") {
    const Folder f;
    if (!there(f, "pvpython")) {
      MESSAGE("skipped: pvpython is not installed (Debian: python3-paraview)");
      return;
    }
    if (!there(f, "Xvfb")) {
      MESSAGE("skipped: Xvfb is not installed (Debian: xvfb)");
      return;
    }
    write_file(f / "driver.py", kDriver);
    struct Case {
      std::string name, settings, bolts, place;
    };
    // with bolts; a box, which is no convex block; one that touches nothing: its frames have no contact points
    for (const Case& c : {Case{"bolted_slope", "output.field_interval=0.1", "bolts", "8 -1.5 filled"},
                          Case{"pile", "output.field_interval=2", "none", "20 20 empty"},
                          Case{"spinning_block", "output.field_interval=0.1", "none", "0 0 filled"}}) {
      INFO(c.name);
      REQUIRE(shell(f, fmt::format("$talus run {} -o 'runs of {}' -q --set {}", example(c.name), c.name,
                                   c.settings))
                  .code == 0);
      // moved, and from another folder: the frames are found beside the script
      REQUIRE(shell(f, fmt::format("mkdir 'moved {0}' && mv 'runs of {0}' 'moved {0}/r'", c.name)).code == 0);
      const Outcome o =
          shell(f, on_display(fmt::format("pvpython driver.py 'moved {0}/r/{1}' '{0}.png' {2} {3}", c.name,
                                          kParaviewView, c.bolts, c.place)));
      CHECK(o.code == 0);
      CHECK(o.text == "");
    }
    // without frames it says so
    REQUIRE(shell(f, "rm 'moved pile/r/fields/blocks.pvd'").code == 0);
    const Outcome o = shell(f, on_display(fmt::format("pvpython 'moved pile/r/{}' none.png", kParaviewView)));
    CHECK(o.code == 1);
    has(o.text, "has no blocks.pvd");
  }
}

}  // namespace test_paraview
