#pragma once
// Frames as texts of the page; web/src/run.js reads the arrays in the same order.

#include "talus/output/read_frames.h"

namespace talus::report {

std::string packed(const Shapes& shapes);
std::string packed(const BlockFrame& frame);
/// Columns that the page has and the frame has, in their order; then places and directions of the forces.
/// @param origin  that points count from [m], so that single precision is enough
std::string packed(const ContactPoints& points, Vec2 origin);
std::string packed(const GroundMotion& ground);
std::string packed(const BoltPieces& bolts, Vec2 origin);

/// How the page takes a column off: a method of Unpacker in web/src/decode.js.
const char* unpacked_by(InPage kind);

}  // namespace talus::report
