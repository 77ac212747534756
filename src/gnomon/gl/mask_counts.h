// How volumes are counted into a mask, in the stencil or by blending.
#pragma once

#include <array>

#include <gnomon/gl/volume_batches.h>

namespace gnomon::gl {

// In groups, the eighth bit of a stencil says that a sample is in shadow.
inline constexpr GLuint kShadedBit = 0x80;

// Into the stencil of the bound framebuffer, which is cleared first; never overflows unseen.
LitTest count_in_stencil(const Frame& frame, const LightPlan& plan, Prepared& prepared);

// Into alpha or screen: their start, the counts, a look for counts that floats have lost (error),
// and three states to two (Roettger et al., 4.3 and 4.4).
void clear_colours(const Frame& frame, const Method& m);
void count_by_blending(const Frame& frame, const LightPlan& plan, const Prepared& prepared);
Result<bool> check_floats(const Frame& frame, const Method& m, const Target& target);
void normalise(const Frame& frame, const Method& m);

// What is there times 2 x brightness: volumes' faces double and halve at once.
inline constexpr GLenum kFaceSource = GL_DST_COLOR, kFaceDestination = GL_SRC_COLOR;
inline constexpr float kDoubles = 1.0f, kHalves = 0.25f;
std::array<bool, 4> mask_channels(const Method& m);

// Receivers that no volume of their own shades, or that may have come out before it.
void count_unlit_receivers(const Frame& frame, const LightPlan& plan, const Prepared& prepared);

}  // namespace gnomon::gl
