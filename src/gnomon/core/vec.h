// Points, vectors and lights. World coordinates are double, right-handed, z up, metres.
#pragma once

#define GLM_FORCE_XYZW_ONLY
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace gnomon {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;

// A homogeneous point (x,y,z,w): w=1 a point, w=0 a direction.
using Vec4 = glm::dvec4;

// A light as one homogeneous point: w=1 a point light, w=0 the direction *towards* a distant one.
using Light = Vec4;

// The library was compiled with packed vectors; others would be read at the wrong places.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && alignof(Vec4) == alignof(double),
              "Gnomon needs GLM's packed types: do not define GLM_FORCE_DEFAULT_ALIGNED_GENTYPES");

inline Vec4 point(const Vec3& p) { return {p.x, p.y, p.z, 1.0}; }
inline Vec4 direction(const Vec3& d) { return {d.x, d.y, d.z, 0.0}; }

}  // namespace gnomon
