// A side of a shadow volume in a parallel view under a sun, in one line of memory. All strips of
// one sun run the same way, so that two of their three edges have one slope; the third matters only
// in the rows of the silhouette edge itself.
//
// Notation: A, B the silhouette edge's ends and l = minus the light in screen space
// (screen_space.h, w = 1 and 0); u = B - A; f = u x l; k = l.x / l.y. The strip is { A + s u + t l
// : 0 <= s <= 1, t >= 0 }. What float cannot decide is decided by the polygon that the strip stands
// for (polygon.h). Bounds: docs/counting.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gnomon/raster/least_cells.h>
#include <gnomon/raster/screen_space.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

struct alignas(64) Strip {
  enum Kinds : std::uint8_t {
    kEdgeLower = 1,  // the strip lies to the right of the silhouette edge's line
    kEdgeUpper = 2,  // to the left
    kCutLower = 4,   // what matters lies to the right of the cut by nearness
    kCutUpper = 8,
    kFromLast = 16  // the reference row is the last one, else the first
  };
  // Crossings with the reference row's middle, pixels to the right of the middle of `column`; the
  // slope of left and right is the sun's. cut: where nearness is surely below that of all samples.
  float left = 0, right = 0, edge = 0, edge_step = 0, cut = 0, cut_step = 0;
  float slack = 0;  // of left, right and edge, in all rows
  // Nearness at the middle of the reference pixel, to the right, down; all that may be wrong with
  // it in float in any sample of the strip, and with the sample's own.
  float g = 0, ga = 0, gb = 0, error = 0;
  std::int32_t column = 0;
  std::int16_t begin = 0, end = 0;  // columns that it can matter in, from `column`
  std::uint16_t first_row = 0, rows = 0;
  std::int16_t add = 0;  // what a sample behind it adds to its count
  std::uint8_t kinds = 0;
  std::uint32_t id = 0;  // of the silhouette edge
};
static_assert(sizeof(Strip) == 64);

inline int reference_row(const Strip& s) {
  return s.first_row + ((s.kinds & Strip::kFromLast) != 0 ? s.rows - 1 : 0);
}

// Ends of a strip in the picture are widened by this many pixels; points and lights are known far
// better.
inline constexpr double kStripMargin = 1e-4;

// Rounding of a crossing in float: those of start, slope, product, sum, and of adding 1/2 and the
// slack, each at most 2^-24 of |start| + |slope| rows + 1; rounded up.
inline constexpr double kCrossingInFloat = 0x1p-21;
// Rounding of nearness in float: three coefficients, two products and a sum for the lane, two
// products and sums for the vector, product and sum for the column, the receiver's own (2^-23) and
// the difference: fewer than 16 times 2^-24 of |g| + |ga| columns + |gb| rows.
inline constexpr double kNearnessInFloat = 0x1p-20;

// What all strips of a sun share.
struct StripLight {
  bool usable = false;  // false: no strip can be made under this light
  ScreenPoint<double> l{};
  double k = 0, inverse_y = 0;
  double sinks = 0, inverse_sinks = 0;  // by how much nearness falls per l, at least
  // Bounds: of f; of the numerators of ga and gb; of left and right, pixels.
  double f_error = 0, ga_error = 0, gb_error = 0, sweep_error = 0;
  ScreenPoint<Bound> point, light;
  double nearness_floor = 0;
  int width = 0, height = 0;
};
StripLight strip_light(const ScreenPoint<double>& minus_light, const ScreenPoint<Bound>& point,
                       const ScreenPoint<Bound>& light, double nearness_floor, int width,
                       int height);

// A silhouette edge whose strip float cannot be trusted with: its polygon has to be taken, in these
// rows.
struct UnsureStrip {
  std::uint32_t id = 0;
  std::int32_t first_row = 0, end_row = 0;
};

// Makes the strips of edges[ids[0 .. n)], in their order and without those that no sample can lie
// behind, and says what is unsure. Returns how many strips were made; out holds n. `orientation`:
// of the screen space. Precondition: light.usable.
std::size_t make_strips(const SilhouetteEdge* edges, const std::uint32_t* ids, std::size_t n,
                        const ScreenPoint<double>* points, const StripLight& light,
                        const LeastCells& cells, int orientation, Strip* out,
                        std::vector<UnsureStrip>& unsure);

}  // namespace gnomon
