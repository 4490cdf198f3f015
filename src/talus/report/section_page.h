#pragma once
// The section before any run, in the page of the report: blocks, joints, what holds and loads them, and the line of
// the model file that each comes from. The interactive form of the cut picture (plot/cut_picture.h).

#include <string>

#include "talus/cut/layout.h"

namespace talus::report {

/// The page with the section of a model.
/// @param page    report_page.html
/// @param report  what `talus cut` says, shown beneath; "": nothing
/// @pre  materials of all blocks are complete
/// Throws FileError when the page has no place for data.
std::string section_page(const std::string& page, const Model& model, const Cut& cut, const Layout& layout,
                         const std::string& report);

}  // namespace talus::report
