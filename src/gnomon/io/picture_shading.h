// What a picture needs to know of the model behind the hours: relief, outlines and the colours of
// surface classes.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/io/picture.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/receivers.h>

namespace gnomon {

// Of the surface's class, as camera pictures have it: clay tones; water, plants and traffic areas
// tinted. Surfaces of no class have the tone of upright ones.
Rgb surface_colour(const Surface& surface);

// Relief of level surfaces: the picture stays as it is.
inline constexpr std::uint8_t kLevelShade = 180;
// Where there is no sample.
inline constexpr std::uint32_t kNoObject = 0xffffffffu;

// Per sample of a plan, row-major.
struct PlanRelief {
  // 0 dark .. kLevelShade level .. 255 bright; light from the north-west, as maps have it.
  std::vector<std::uint8_t> shade;
  // Number of the city object (parts count with their parent) or kNoObject.
  std::vector<std::uint32_t> object;
};
PlanRelief plan_relief(const Scene& scene, const Receivers& receivers, int threads = 0);

// Per sample of a camera view, row-major.
struct ViewShading {
  // 0..1, soft sky and a soft directional light; 0 where there is no sample.
  std::vector<float> shade;
  // Of the surface's class: clay tones; water, plants and traffic areas tinted.
  std::vector<Rgb> colour;
  // 1 on creases, outlines and where one surface hides another.
  std::vector<std::uint8_t> edge;
};
ViewShading view_shading(const Scene& scene, const Receivers& receivers, int threads = 0);

}  // namespace gnomon
