// A mask drawn by a renderer against the exact one: which samples differ, and whether rounding
// explains it. A renderer rounds where edges lie on the screen (to parts of a pixel) and how deep
// surfaces lie (to steps of its depth buffer); everything else is a fault.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/silhouette/silhouette.h>
#include <gnomon/view/shadow_mask.h>

namespace gnomon {

// The samples of a view, and of the same view with finer pixels; shared by all lights.
struct ExactView {
  // Samples a side of a pixel of the finer view, odd, so that one lies in the pixel's centre; its
  // picture is one pixel wider on each side.
  static constexpr int kFiner = 3;
  const Scene* scene = nullptr;
  const Casters* casters = nullptr;
  Receivers samples, finer;
};
ExactView exact_view(const Scene& scene, const Casters& casters, const View& view, int threads = 0);

// The exact answers under one light.
struct ExactAnswers {
  const ExactView* view = nullptr;
  Light light{0, 0, 1, 0};
  ShadowMask mask;                    // of view->samples
  std::vector<std::int32_t> counts;   // n(p); 0 where there is no sample
  std::vector<std::uint8_t> edge_on;  // 1: see MaskDifference
  std::vector<std::uint8_t> finer;    // states of view->finer
  Silhouette silhouette;              // of all casters
  // Per pixel that was looked at more closely: which states occur within a pixel of its centre (bit
  // 0 lit, 1 shadow, 2 no sample). Not for several threads.
  mutable std::map<std::size_t, std::uint8_t> looked_at;
  // The same within kSubpixel of it.
  mutable std::map<std::size_t, std::uint8_t> looked_at_edge;
};
ExactAnswers exact_answers(const ExactView& view, const Light& light, int threads = 0);

// How deep a renderer says that things are: `clip` takes homogeneous scene coordinates to clip
// space (z from -w to w, x and y as the view's pixels); the depth buffer has `steps` values.
struct DepthBuffer {
  glm::dmat4 clip{1.0};
  double steps = 16777216;  // 24 bits
};

// Sine of the angle between a surface and the light below which it counts as edge-on: coordinates
// in floats have 24 bits, and a normal is a difference of products of them.
inline constexpr double kEdgeOn = 0x1p-20;

// What rounding may do.
struct Rounding {
  int edge = 1;       // pixels: how far from a sample an answer that is exact there may lie
  double steps = 0;   // of depth: between a sample and a side of the shadow volume
  double pixels = 0;  // and how far either of the two may be moved on the screen, in pixels, which
                      // makes it deeper or less deep by its slope; a side that passes so close by
                      // a sample may cover it or not
};

struct MaskDifference {
  std::uint64_t samples = 0;
  // The light lies in the receiver's plane, or so nearly that floats cannot tell (kEdgeOn), and so
  // do the sides of shadow volumes over its edges: only the exact sign says whether it is lit, no
  // depth buffer can, and nothing of the light falls on it either way. Not counted below.
  std::uint64_t edge_on = 0;
  std::uint64_t edge_on_differ = 0;
  std::uint64_t differ = 0;
  // Of these: the answer is exact somewhere within Rounding::edge pixels, or there is a sample in
  // one of the two only and a surface's rim within Rounding::pixels.
  std::uint64_t at_edge = 0;
  // Of the others: sides so close to the sample that counting them on the other side of it gives
  // the answer (those seen edge-on have every depth: they are slivers between corners that were
  // rounded, and drivers make their depth of what is left of their width), or another surface so
  // close, in depth or with its rim on the screen, that it may be the one that is seen.
  std::uint64_t in_depth = 0;
  std::uint64_t unexplained = 0;
  struct Unexplained {
    std::size_t pixel;
    std::uint32_t triangle;  // that receives
    std::int32_t count;      // exact
    double times;            // the rounding that would explain it, in multiples; 0: none does
  };
  std::vector<Unexplained> first_unexplained;  // at most kShown
  static constexpr std::size_t kShown = 5;

  MaskDifference& operator+=(const MaskDifference& o);
};

// Precondition: `drawn` has the view's size.
MaskDifference compare_masks(const ExactAnswers& exact, const ShadowMask& drawn,
                             const DepthBuffer& depth, const Rounding& rounding);

// To the side or up or down, in pixels: a sample as near to an edge as that lies on it for a
// renderer that rounds corners to eight bits of a pixel, as OpenGL's do: half a step of the sides'
// corners and half a step of the surface's.
inline constexpr double kSubpixel = 0x1p-8;

// Of the samples that MaskDifference::differ counts, those that lie on an edge to kSubpixel: the
// state as drawn is exact so near to them. Each costs as much as a small picture: of one
// ExactAnswers at most kEdgeLooks are looked at, the others not counted.
inline constexpr std::size_t kEdgeLooks = 1024;
std::uint64_t differing_on_edges(const ExactAnswers& exact, const ShadowMask& drawn);

// Samples, edge-on ones aside, that have another exact state within `pixels` of them.
std::uint64_t samples_near_edges(const ExactAnswers& exact, int pixels);

// Pixels whose states differ, but for those that are edge-on to the light. Precondition: the view's
// size.
std::uint64_t differing_pixels(const ExactAnswers& exact, const ShadowMask& a, const ShadowMask& b);

}  // namespace gnomon
