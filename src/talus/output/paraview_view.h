#pragma once
// The usual view of a result folder in ParaView: a state file in Python, which lies with the frames and finds them
// beside itself. One in XML (.pvsm) would hold the path of the folder and the defaults of one version of ParaView.

#include <string>

namespace talus {

/// Its name in the result folder.
inline constexpr const char* kParaviewView = "fields/view.py";

/// Its text, the same for every run: it looks itself which series of frames there are. For ParaView 5.11; by
/// pvpython, with a name behind its own, it writes a picture.
std::string paraview_view();

}  // namespace talus
