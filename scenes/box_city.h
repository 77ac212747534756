// 400 boxes on a level ground, in straight streets: simple enough for any renderer to read, so that
// other programs can be timed on the very same triangles (bench/peers).
#pragma once

#include <cstdint>

#include <gnomon/scene/scene.h>

namespace gnomon::scenes {

// Metres. The city is centred on the origin; the middles of its streets are at whole multiples of
// the pitch in x and y, so that the origin itself is a crossing.
inline constexpr int kBoxesAcross = 20;  // and as many deep
inline constexpr double kBoxPitch = 20;  // from one box's lot to the next one's
inline constexpr double kBoxStreet = 6;  // at least, between boxes
inline constexpr double kBoxLowest = 4;  // bounds of their heights
inline constexpr double kBoxTallest = 30;
inline constexpr double kBoxCityHalf = kBoxesAcross * kBoxPitch / 2;
inline constexpr double kBoxCityMargin = 20;  // of the ground around the city

// Surface 0 is the "ground", a square of two triangles at z = 0, group and material "ground"; the
// others are the boxes, each closed, wound outwards and an object and group of its own, "box_17",
// of material "box". Most are low, few are high. Corners are on whole millimetres. No vertex is
// shared between objects. Equal seeds give the equal city.
Scene box_city(std::uint64_t seed = 1);

}  // namespace gnomon::scenes
