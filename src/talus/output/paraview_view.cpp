#include "talus/output/paraview_view.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "talus/output/colours.h"
#include "talus/output/contact_points.h"

namespace talus {

namespace {

// What stands between two @ is put in by paraview_view().
constexpr const char* kViewScript =
    R"python(# The usual view of these results in ParaView: File > Load State, or, for a picture, pvpython view.py picture.png.
# It shows the frames that lie beside it, wherever the folder is. Keep a changed one under another name: a run
# that replaces these results replaces this file.
import os
import sys

import paraview

# a newer ParaView then takes what follows as 5.11 does
paraview.compatibility.major = 5
paraview.compatibility.minor = 11
from paraview import simple as pv

# colours from 0 to 255, as in all pictures of talus
one_sided = [@one_sided@]
bolt_colours, bolt_pressed = [@bolt_pale@, @bolt_dark@], @bolt_pressed@
force_colour = @force@
states = {-1: "no joint", @states@}
state_colours = [(216, 185, 212), (150, 150, 150), @slipped@, @open@, (217, 217, 217)]

pv._DisableFirstRenderCameraReset()  # the camera is set below
black, white = [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]
# only a shell into which this text is pasted does not say where the file lies
folder = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()


def share(colour):
    return [c / 255 for c in colour]


def series(name):
    """The frames NAME.pvd as a source, None where the run has none."""
    path = os.path.join(folder, name + ".pvd")
    return pv.PVDReader(registrationName=name, FileName=path) if os.path.isfile(path) else None


def largest(attributes, name, default):
    """The largest value (of vectors the length) of an array at the time shown; where that is 0 the default."""
    array = attributes.GetArray(name)
    if array is None:
        return default
    top = array.GetRange(-1 if array.GetNumberOfComponents() > 1 else 0)[1]
    return top if 0 < top < 1e300 else default


def range_in_time(source, name):
    """Least (0 or less) and largest value (0 or more) of an array of cells over time, in 200 frames at most."""
    low, high = 0.0, 0.0
    for time in reversed(times[:: -max(1, len(times) // 200)]):  # the last frame always, and shown in the end
        source.UpdatePipeline(time)
        array = source.CellData.GetArray(name)
        if array is not None and array.GetRange()[0] <= array.GetRange()[1]:  # else there are no bolts yet
            low, high = min(low, array.GetRange()[0]), max(high, array.GetRange()[1])
    return low, high


def ramp(name, colours, top, mode):
    """A map of colours for an array, even from 0 to `top`."""
    colour_map = pv.GetColorTransferFunction(name)
    step = top / (len(colours) - 1)
    colour_map.RGBPoints = [x for i, c in enumerate(colours) for x in [i * step] + share(c)]
    colour_map.ColorSpace = "RGB"
    colour_map.ScalarRangeInitialized = 1
    colour_map.AutomaticRescaleRangeMode = mode
    return colour_map


def colour_by(shown, attributes, name, colour_map):
    """As ColorBy of paraview.simple, which warns where a frame has no points."""
    shown.ColorArrayName, shown.LookupTable = [attributes, name], colour_map


def legend(colour_map, view, title, place):
    bar = pv.GetScalarBar(colour_map, view)
    bar.Title, bar.ComponentTitle, bar.HorizontalTitle = title, "", 1
    bar.TitleColor = bar.LabelColor = black
    bar.TitleFontSize, bar.LabelFontSize = 14, 14
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%.3g", "%.3g"
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", place, 0.22


blocks, contacts, bolts = series("blocks"), series("contacts"), series("bolts")
if blocks is None:
    raise RuntimeError(folder + ": has no blocks.pvd. This file belongs into the folder fields of a run")
times = list(blocks.TimestepValues) or [0.0]
end = times[-1]
for source in [blocks, contacts, bolts]:
    if source is not None:
        source.UpdatePipeline(end)

view = pv.CreateView("RenderView")
view.UseColorPaletteForBackground, view.Background = 0, white
view.OrientationAxesVisibility = 0
view.InteractionMode = "2D"
view.ViewTime = end
layout = pv.CreateLayout(name="talus")
layout.AssignView(0, view)
if __name__ == "__main__":  # there is no window that gives it a size
    layout.SetSize(1200, 750)
pv.SetActiveView(view)

left, right, bottom, top = blocks.GetDataInformation().GetBounds()[:4]
if left > right:  # no blocks are left
    left, right, bottom, top = 0.0, 1.0, 0.0, 1.0
width, height = right - left, top - bottom
size = max(width, height)

# blocks by displacement; the colours reach further where another frame has more
shown = pv.Show(blocks, view)
shown.Representation = "Surface With Edges"
shown.EdgeColor, shown.LineWidth = [0.2, 0.2, 0.2], 1.0
shown.Ambient, shown.Diffuse = 1.0, 0.0
shown.Triangulate = 1  # blocks with notches and holes would be filled wrongly
displacement = ramp("displacement [m]", one_sided, largest(blocks.PointData, "displacement [m]", 1e-3),
                    "Grow and update every timestep")
colour_by(shown, "POINTS", "displacement [m]", displacement)
legend(displacement, view, "displacement\nmagnitude [m]", [0.85, 0.68])
shown.SetScalarBarVisibility(view, True)

# bolts by tension, in front of the blocks; grey where they are pressed
if bolts is not None:
    shown = pv.Show(bolts, view)
    shown.RenderLinesAsTubes, shown.LineWidth = 1, 5.0
    shown.Position = [0.0, 0.0, 1e-3 * size]
    shown.Specular, shown.SpecularPower = 0.4, 5.0
    low, high = range_in_time(bolts, "axial force [N]")
    tension = ramp("axial force [N]", bolt_colours, high if high > 0 else 1.0, "Never")
    tension.UseBelowRangeColor, tension.BelowRangeColor = int(low < 0), share(bolt_pressed)
    colour_by(shown, "CELLS", "axial force [N]", tension)
    legend(tension, view, "axial force\nof bolts [N]", [0.85, 0.36])
    shown.SetScalarBarVisibility(view, True)

# contact points by the state of their joint, and their forces as arrows: hidden until the eyes in the pipeline
# browser show them
if contacts is not None:
    shown = pv.Show(contacts, view)
    shown.Representation, shown.PointSize, shown.RenderPointsAsSpheres = "Points", 6.0, 1
    shown.Position = [0.0, 0.0, 2e-3 * size]
    state = pv.GetColorTransferFunction("state")
    state.InterpretValuesAsCategories = 1
    state.Annotations = [text for number, name in states.items() for text in (str(number), name)]
    state.IndexedColors = [x for c in state_colours for x in share(c)]
    colour_by(shown, "POINTS", "state", state)
    legend(state, view, "state of joints", [0.85, 0.05])
    pv.GetScalarBar(state, view).TextPosition = "Ticks left/bottom, annotations right/top"
    shown.SetScalarBarVisibility(view, True)
    pv.Hide(contacts, view)

    forces = pv.Glyph(registrationName="forces on block a", Input=contacts, GlyphType="Arrow")
    forces.OrientationArray, forces.ScaleArray = ["POINTS", "force [N]"], ["POINTS", "force [N]"]
    forces.VectorScaleMode, forces.GlyphMode = "Scale by Magnitude", "All Points"
    forces.ScaleFactor = 0.1 * size / largest(contacts.PointData, "force [N]", 1.0)
    shown = pv.Show(forces, view)
    shown.Position = [0.0, 0.0, 3e-3 * size]
    shown.Ambient, shown.Diffuse = 1.0, 0.0
    shown.ColorArrayName = [None, ""]
    shown.AmbientColor = shown.DiffuseColor = share(force_colour)
    pv.Hide(forces, view)

clock = pv.AnnotateTimeFilter(registrationName="time", Input=blocks)
clock.Format = "t = {time:g} s" if "{" in clock.Format else "t = %g s"
shown = pv.Show(clock, view)
shown.Color, shown.FontSize = black, 16
scene = pv.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = end

view.AxesGrid.Visibility, view.AxesGrid.ShowEdges = 1, 0
view.AxesGrid.AxesToLabel, view.AxesGrid.GridColor = 3, black
view.AxesGrid.XTitle, view.AxesGrid.YTitle = "x [m]", "y [m]"
for part in ["XTitle", "YTitle", "XLabel", "YLabel"]:
    setattr(view.AxesGrid, part + "Color", black)
# the blocks fill most of the view left of the legends
aspect = view.ViewSize[0] / view.ViewSize[1]
reach = max(0.5 * height / 0.84, 0.5 * width / (0.7 * aspect))  # half the height of what is seen [m]
middle = [(left + right) / 2 + 0.14 * reach * aspect, (bottom + top) / 2]
view.CameraParallelProjection, view.CameraParallelScale = 1, reach
view.CameraFocalPoint, view.CameraPosition = middle + [0.0], middle + [4 * size]
view.CameraViewUp = [0.0, 1.0, 0.0]
pv.SetActiveSource(blocks)
pv.Render(view)

if __name__ == "__main__" and len(sys.argv) > 1:
    pv.SaveScreenshot(sys.argv[1], view)
)python";

std::string in_python(const Rgb& c) { return fmt::format("({}, {}, {})", c[0], c[1], c[2]); }

std::string ramp_in_python() {
  std::string out;
  for (const Rgb& c : kOneSided) out += (out.empty() ? "" : ", ") + in_python(c);
  return out;
}

std::string states_in_python() {
  std::string out;
  for (size_t i = 0; i < kJointStates.size(); ++i)
    out += fmt::format("{}{}: \"{}\"", out.empty() ? "" : ", ", i, kJointStates[i]);
  return out;
}

}  // namespace

std::string paraview_view() {
  const std::vector<std::pair<std::string, std::string>> filled{
      {"@one_sided@", ramp_in_python()},        {"@bolt_pale@", in_python(kBoltPale)},
      {"@bolt_dark@", in_python(kBoltDark)},    {"@bolt_pressed@", in_python(kBoltPressed)},
      {"@force@", in_python(kForceColour)},     {"@states@", states_in_python()},
      {"@slipped@", in_python(kSlippedColour)}, {"@open@", in_python(kOpenColour)}};
  std::string script = kViewScript;
  for (const auto& [mark, value] : filled) script.replace(script.find(mark), mark.size(), value);
  return script;
}

}  // namespace talus
