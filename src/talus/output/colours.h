#pragma once
// Colours of all pictures of results, those that `talus plot` and a run draw and those of the report, which gets
// them as data. Told apart by colour-blind readers; maps keep their order in grey print.

#include <array>
#include <cstdint>

namespace talus {

using Rgb = std::array<uint8_t, 3>;

/// Evenly spaced over the range. One-sided: cividis from light to dark, whose lightness falls evenly. Two-sided: blue,
/// nearly white in the middle, orange-red.
inline constexpr std::array<Rgb, 9> kOneSided{{{255, 240, 150},
                                               {236, 214, 92},
                                               {196, 182, 108},
                                               {166, 157, 117},
                                               {138, 134, 120},
                                               {112, 113, 115},
                                               {87, 93, 109},
                                               {57, 72, 107},
                                               {0, 32, 77}}};
inline constexpr std::array<Rgb, 9> kTwoSided{{{5, 48, 97},
                                               {33, 102, 172},
                                               {67, 147, 195},
                                               {146, 197, 222},
                                               {236, 236, 236},
                                               {253, 197, 130},
                                               {241, 130, 55},
                                               {200, 70, 10},
                                               {127, 39, 4}}};

/// Of kinds, materials and groups: pale enough for lines above.
inline constexpr std::array<Rgb, 8> kPalette{{{158, 202, 225},
                                              {240, 217, 168},
                                              {181, 216, 176},
                                              {216, 185, 212},
                                              {201, 201, 201},
                                              {242, 184, 160},
                                              {169, 214, 210},
                                              {217, 217, 139}}};

/// Of kinds of blocks, in the order of kBlockKinds.
inline constexpr std::array<Rgb, 4> kKindColours{
    {{158, 202, 225}, {240, 217, 168}, {140, 140, 140}, {184, 176, 200}}};

/// Principal stresses: pressed, pulled.
inline constexpr Rgb kPressedColour{33, 71, 140}, kPulledColour{178, 24, 43};

inline constexpr Rgb kSlippedColour{230, 85, 13}, kOpenColour{8, 48, 107}, kForceColour{122, 1, 119};

/// Bolts by the share of the largest tension, from pale to dark; in compression; ruptured.
inline constexpr Rgb kBoltPale{158, 198, 156}, kBoltDark{0, 76, 41}, kBoltPressed{107, 107, 107},
    kBoltRuptured{0, 0, 0};

/// Joints whose slip or opening is less than this share of the largest are not drawn.
inline constexpr double kLeastDrawn = 0.02;

}  // namespace talus
