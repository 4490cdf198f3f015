#pragma once
// The lines that divide the regions, from everything the model names: outlines, openings, faults, masonry,
// tessellations and joint sets. Theory: docs/theory.md section 10.

#include <string>
#include <vector>

#include "talus/cut/joint_set.h"
#include "talus/cut/regions.h"

namespace talus {

enum class OriginKind {
  kOpening,
  kSide,
  kFault,
  kSurveyed,  // [[traces]]
  kMasonry,
  kArch,
  kTessellation,
  kJointSet,
  kConstruction
};

/// What a block edge comes from.
struct Origin {
  std::string name;
  OriginKind kind = OriginKind::kSide;
  int joint = -1;  // -1: that of the region
  Where where = {};
};

struct Trace {
  std::vector<Vec2> line;  // [m]
  int origin = 0;
};

/// What came of one [[traces]].
struct SurveyNote {
  std::string name;
  int lines = 0;      // of the file
  int inside = 0;     // of them with a part in the regions
  double length = 0;  // in the regions [m]
};

struct TraceSet {
  std::vector<Origin> origins;
  std::vector<Trace> traces;  // most important first: where two coincide the first names the edge
  std::vector<JointSetNote> joint_sets;
  std::vector<SurveyNote> surveys;
};

/// Everything that block edges of the model may come from, in the order of their importance.
std::vector<Origin> all_origins(const Model& model, const RegionMap& regions);

/// All traces of the model, clipped to the regions. Sets that make no sense (parallel to the section,
/// millions of traces) are findings.
TraceSet make_traces(const Model& model, const RegionMap& regions, Findings& findings);

}  // namespace talus
