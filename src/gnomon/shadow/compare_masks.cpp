#include <gnomon/shadow/compare_masks.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <gnomon/shadow/cast_shadows.h>
#include <gnomon/silhouette/light_sides.h>

namespace gnomon {
namespace {

// Looked at more closely: this many samples a side of a pixel.
constexpr int kClose = 16;
// A close look costs as much as a small picture: a mask that is altogether wrong gets no more.
constexpr std::size_t kLooks = 64;
constexpr double kMostTimes = 65536;

View part_of(const View& v, double left, double top, int width, int height, int finer) {
  View out = v;
  out.origin += left * v.right + top * v.down;
  out.right /= finer;
  out.down /= finer;
  out.width = width * finer;
  out.height = height * finer;
  return out;
}

std::uint8_t bit_of(std::uint8_t state) {
  return state == ShadowMask::kLit ? 1 : state == ShadowMask::kShadow ? 2 : 4;
}

// States of the finer samples that lie at most `pixels` from the pixel's centre.
std::uint8_t states_near(const ExactAnswers& a, int column, int row, int pixels) {
  constexpr int k = ExactView::kFiner;
  const View& v = a.view->finer.view;
  const int x = (column + 1) * k + k / 2, y = (row + 1) * k + k / 2;
  std::uint8_t bits = 0;
  for (int j = std::max(0, y - pixels * k); j <= std::min(v.height - 1, y + pixels * k); ++j)
    for (int i = std::max(0, x - pixels * k); i <= std::min(v.width - 1, x + pixels * k); ++i)
      bits |= bit_of(a.finer[std::size_t(j) * v.width + i]);
  return bits;
}

// States of the samples of a view as they are, seen exactly.
std::uint8_t states_of(const ExactAnswers& a, const View& view) {
  const Receivers samples = visible_surfaces(*a.view->scene, view);
  std::uint8_t bits = 0;
  for (const std::uint8_t s : cast_shadows(*a.view->casters, samples, a.light).state)
    bits |= bit_of(s);
  return bits;
}

std::uint8_t states_close(const ExactAnswers& a, std::size_t pixel) {
  const auto found = a.looked_at.find(pixel);
  if (found != a.looked_at.end()) return found->second;
  if (a.looked_at.size() >= kLooks) return 0;
  const View& v = a.view->samples.view;
  const int column = static_cast<int>(pixel) % v.width, row = static_cast<int>(pixel) / v.width;
  const std::uint8_t bits = states_of(a, part_of(v, column - 0.5, row - 0.5, 2, 2, kClose));
  a.looked_at[pixel] = bits;
  return bits;
}

std::uint8_t states_at_edge(const ExactAnswers& a, std::size_t pixel) {
  const auto found = a.looked_at_edge.find(pixel);
  if (found != a.looked_at_edge.end()) return found->second;
  if (a.looked_at_edge.size() >= kEdgeLooks) return 0;
  const View& v = a.view->samples.view;
  const int column = static_cast<int>(pixel) % v.width, row = static_cast<int>(pixel) / v.width;
  // Three by three samples, kSubpixel apart, round the pixel's centre.
  const double from = 0.5 - 1.5 * kSubpixel;
  View close = v;
  close.origin += (column + from) * v.right + (row + from) * v.down;
  close.right *= kSubpixel;
  close.down *= kSubpixel;
  close.width = close.height = 3;
  return a.looked_at_edge[pixel] = states_of(a, close);
}

// The plane through three homogeneous points: plane . x = |a; b; c; x|.
Vec4 plane_through(const Vec4& a, const Vec4& b, const Vec4& c) {
  const auto minor = [&](int i, int j, int k) {
    return glm::determinant(
        glm::dmat3(Vec3(a[i], b[i], c[i]), Vec3(a[j], b[j], c[j]), Vec3(a[k], b[k], c[k])));
  };
  return {-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)};
}

struct Depths {
  const View& view;
  glm::dmat4 rows;  // of the matrix to clip space
  Vec4 z, w;
  double steps;  // per unit of z / w

  Depths(const View& v, const DepthBuffer& buffer)
      : view(v),
        rows(glm::transpose(buffer.clip)),
        z(rows[2]),
        w(rows[3]),
        steps(buffer.steps / 2) {}

  // Where the ray of the pixel point q meets the plane, in steps; NaN where it does not.
  double at(const Vec4& plane, const Vec4& q) const {
    const Vec4 x = view.eye * glm::dot(plane, q) - q * glm::dot(plane, view.eye);
    return glm::dot(z, x) / glm::dot(w, x) * steps;
  }
  // How much deeper a pixel to the side and one down, together.
  double slope(const Vec4& plane, const Vec4& q) const {
    const double here = at(plane, q);
    return std::fabs(at(plane, q + view.right) - here) + std::fabs(at(plane, q + view.down) - here);
  }
  // A triangle that passes within `pixels` of the pixel's centre, no deeper than `depth`. False for
  // those that reach behind the eye.
  bool passes(const std::array<Vec4, 3>& corners, int column, int row, double pixels,
              double depth) const {
    std::array<Vec2, 3> at;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec4 c = corners[k] * rows;  // row times matrix of rows: clip space
      if (!(c.w > 0)) return false;
      at[k] = Vec2((c.x / c.w + 1) / 2 * view.width - column - 0.5,
                   (1 - c.y / c.w) / 2 * view.height - row - 0.5);
      nearest = std::min(nearest, c.z / c.w * steps);
    }
    if (nearest > depth) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 a = at[k], d = at[(k + 1) % 3] - a;
      const double length2 = glm::dot(d, d);
      const double s = length2 > 0 ? std::clamp(-glm::dot(a, d) / length2, 0.0, 1.0) : 0.0;
      if (glm::length(a + s * d) <= pixels) return true;
    }
    return false;
  }
};

// The highest and lowest count that rounding of depths can make of n(p).
struct Reach {
  std::int32_t least, most;
  bool other_surface = false;  // is as near as the one that is seen
};

bool explains(const Reach& reach, std::uint8_t state) {
  return reach.other_surface || (state == ShadowMask::kShadow ? reach.most > 0 : reach.least <= 0);
}

Reach reach_of(const ExactAnswers& a, std::size_t pixel, const Depths& depths,
               const Rounding& rounding) {
  const Scene& scene = *a.view->scene;
  const View& v = a.view->samples.view;
  const Vec4 q =
      pixel_point(v, static_cast<int>(pixel) % v.width, static_cast<int>(pixel) / v.width);
  const auto vertex = [&](std::uint32_t k) { return point(scene.mesh.positions[k]); };
  const std::uint32_t seen = a.view->samples.triangle[pixel];
  const Triangle& r = scene.mesh.triangles[seen];
  const Vec4 surface = plane_through(vertex(r[0]), vertex(r[1]), vertex(r[2]));
  const double here = depths.at(surface, q);
  const double surface_slope = depths.slope(surface, q);
  enum class Covers { no, by_rounding, yes };
  // Whether the polygon covers the pixel's centre, by how much it is deeper there, and `no` where
  // rounding of depths cannot tell. Of a polygon seen edge-on no depth is wrong: it has all of
  // them.
  const auto close_by = [&](const Vec4& A, const Vec4& B, const Vec4& C, double& distance) {
    const Vec4 plane = plane_through(A, B, C);
    distance = depths.at(plane, q) - here;
    if (std::fabs(distance) >
        rounding.steps + rounding.pixels * (surface_slope + depths.slope(plane, q))) {
      return Covers::no;
    }
    // On which side of its edges the line from eye to pixel point runs, and how far rounding of
    // corners may move that.
    bool all_positive = true, all_negative = true, may_positive = true, may_negative = true;
    for (const auto& [from, to] : {std::pair(A, B), std::pair(B, C), std::pair(C, A)}) {
      const Vec4 plane_of_edge = plane_through(v.eye, from, to);
      const double side = glm::dot(plane_of_edge, q);
      const double moved = rounding.pixels * (std::fabs(glm::dot(plane_of_edge, v.right)) +
                                              std::fabs(glm::dot(plane_of_edge, v.down)));
      all_positive &= side >= 0;
      all_negative &= side <= 0;
      may_positive &= side >= -moved;
      may_negative &= side <= moved;
    }
    return all_positive || all_negative   ? Covers::yes
           : may_positive || may_negative ? Covers::by_rounding
                                          : Covers::no;
  };
  const Vec4 behind = -a.light;
  // Of a side seen edge-on, a line on the screen from its edge to where the point behind is:
  // whether the sample lies between, to `pixels`. The line of A + t behind runs in one direction
  // for all t.
  const auto beside = [&](const Vec4& A, const Vec4& B) {
    const Vec4 far_end = behind * depths.rows;
    const Vec2 half(v.width / 2.0, v.height / 2.0);
    const auto on_screen = [&](const Vec4& c) {
      return Vec2((c.x / c.w + 1) * half.x - static_cast<int>(pixel) % v.width - 0.5,
                  (1 - c.y / c.w) * half.y - static_cast<int>(pixel) / v.width - 0.5);
    };
    for (const Vec4& corner : {A, B}) {
      const Vec4 c = corner * depths.rows;
      if (!(c.w > 0)) return true;
      const Vec2 run =
          Vec2(far_end.x * c.w - c.x * far_end.w, c.y * far_end.w - far_end.y * c.w) * half;
      const double slack = rounding.pixels * glm::length(run);
      const bool begun = glm::dot(-on_screen(c), run) >= -slack;
      const bool ended = far_end.w > 0 && glm::dot(on_screen(far_end), run) < -slack;
      if (begun && !ended) return true;
    }
    return false;
  };
  Reach reach{a.counts[pixel], a.counts[pixel]};
  double distance = 0;
  for (const SilhouetteEdge& e : a.silhouette) {
    const Vec4 A = vertex(e.a), B = vertex(e.b);
    const Covers covers = close_by(A, B, behind, distance);
    if (covers == Covers::no) continue;
    if (covers == Covers::by_rounding || !std::isfinite(distance)) {
      if (!beside(A, B)) continue;
      // Counted or not, of either neighbour's edge.
      reach.least -= std::abs(e.multiplicity);
      reach.most += std::abs(e.multiplicity);
      continue;
    }
    const bool positive = glm::dot(plane_through(A, B, behind), v.eye) > 0;
    const std::int32_t change = positive ? -e.multiplicity : e.multiplicity;
    // In front of the sample it has been counted and may be missed; behind it the other way round.
    const std::int32_t flip = distance < 0 ? -change : change;
    (flip < 0 ? reach.least : reach.most) += flip;
  }
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size() && !reach.other_surface; ++t) {
    const Triangle& o = scene.mesh.triangles[t];
    if (t == seen || !receives(scene, t)) continue;
    const std::array<Vec4, 3> corners{vertex(o[0]), vertex(o[1]), vertex(o[2])};
    reach.other_surface =
        close_by(corners[0], corners[1], corners[2], distance) == Covers::yes ||
        depths.passes(corners, static_cast<int>(pixel) % v.width, static_cast<int>(pixel) / v.width,
                      rounding.pixels, here + rounding.steps);
  }
  return reach;
}

// A receiver's rim passes within `pixels` of the pixel's centre: rounding of corners decides
// whether the pixel has a sample.
bool at_rim(const ExactAnswers& a, std::size_t pixel, const Depths& depths, double pixels) {
  const Scene& scene = *a.view->scene;
  const int width = a.view->samples.view.width;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!receives(scene, t)) continue;
    std::array<Vec4, 3> corners;
    for (int k = 0; k < 3; ++k)
      corners[std::size_t(k)] = point(scene.mesh.positions[scene.mesh.triangles[t][k]]);
    if (depths.passes(corners, static_cast<int>(pixel) % width, static_cast<int>(pixel) / width,
                      pixels, std::numeric_limits<double>::infinity())) {
      return true;
    }
  }
  return false;
}

std::uint8_t is_edge_on(const TriMesh& mesh, std::uint32_t triangle, const Light& light) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  const Vec3 n = glm::cross(b - a, c - a);
  double longest = 0;
  for (const Vec3* p : {&a, &b, &c})
    longest = std::max(longest, glm::length(Vec3(light) - *p * light.w));
  const double height = glm::dot(n, Vec3(light) - a * light.w);
  return std::fabs(height) <= kEdgeOn * glm::length(n) * longest ? 1 : 0;
}

}  // namespace

ExactView exact_view(const Scene& scene, const Casters& casters, const View& view, int threads) {
  ExactView out;
  out.scene = &scene;
  out.casters = &casters;
  out.samples = visible_surfaces(scene, view, threads);
  out.finer = visible_surfaces(
      scene, part_of(view, -1, -1, view.width + 2, view.height + 2, ExactView::kFiner), threads);
  return out;
}

ExactAnswers exact_answers(const ExactView& view, const Light& light, int threads) {
  ExactAnswers out;
  out.view = &view;
  out.light = snapped(light);
  const int width = view.samples.view.width;
  out.counts.resize(view.samples.triangle.size());
  std::int32_t* const counts = out.counts.data();
  count_shadows(*view.casters, view.samples, std::span(&light, 1), std::span(&counts, 1), threads);
  std::vector<std::uint8_t> tied(view.scene->mesh.triangles.size(), 2);  // 2: not known yet
  for (const std::uint32_t t : view.samples.triangle) {
    if (t != kNoTriangle && tied[t] == 2) tied[t] = is_edge_on(view.scene->mesh, t, out.light);
    out.edge_on.push_back(t == kNoTriangle ? 0 : tied[t]);
  }
  out.mask = {width, view.samples.view.height, {}};
  for (std::size_t k = 0; k < out.counts.size(); ++k) {
    out.mask.state.push_back(view.samples.triangle[k] == kNoTriangle ? ShadowMask::kNoSample
                             : out.counts[k] > 0                     ? ShadowMask::kShadow
                                                                     : ShadowMask::kLit);
  }
  out.finer = cast_shadows(*view.casters, view.finer, light, {.threads = threads}).state;
  out.silhouette = find_silhouette(view.casters->edges, light_sides(view.scene->mesh, out.light));
  return out;
}

MaskDifference& MaskDifference::operator+=(const MaskDifference& o) {
  samples += o.samples;
  edge_on += o.edge_on;
  edge_on_differ += o.edge_on_differ;
  differ += o.differ;
  at_edge += o.at_edge;
  in_depth += o.in_depth;
  unexplained += o.unexplained;
  for (const Unexplained& u : o.first_unexplained)
    if (first_unexplained.size() < kShown) first_unexplained.push_back(u);
  return *this;
}

MaskDifference compare_masks(const ExactAnswers& exact, const ShadowMask& drawn,
                             const DepthBuffer& depth, const Rounding& rounding) {
  MaskDifference d;
  const View& v = exact.view->samples.view;
  const Depths depths(v, depth);
  for (std::size_t k = 0; k < exact.mask.state.size(); ++k) {
    ++d.samples;
    const std::uint8_t state = drawn.state[k];
    d.edge_on += exact.edge_on[k];
    if (state == exact.mask.state[k]) continue;
    if (exact.edge_on[k] != 0) {
      ++d.edge_on_differ;
      continue;
    }
    ++d.differ;
    const std::uint8_t bit = bit_of(state);
    const int column = static_cast<int>(k) % v.width, row = static_cast<int>(k) / v.width;
    if ((states_near(exact, column, row, rounding.edge) & bit) != 0) {
      ++d.at_edge;
      continue;
    }
    const bool no_sample =
        state == ShadowMask::kNoSample || exact.mask.state[k] == ShadowMask::kNoSample;
    if (no_sample && rounding.pixels > 0 && at_rim(exact, k, depths, rounding.pixels)) {
      ++d.at_edge;
      continue;
    }
    if (rounding.steps > 0 && !no_sample) {
      const Reach reach = reach_of(exact, k, depths, rounding);
      if (explains(reach, state)) {
        ++d.in_depth;
        continue;
      }
    }
    if (rounding.edge <= 1 && (states_close(exact, k) & bit) != 0) {
      ++d.at_edge;
      continue;
    }
    ++d.unexplained;
    if (d.first_unexplained.size() == MaskDifference::kShown) continue;
    MaskDifference::Unexplained u{k, exact.view->samples.triangle[k], exact.counts[k], 0};
    for (double times = 2; times <= kMostTimes && u.times == 0 && u.triangle != kNoTriangle;
         times *= 2) {
      const Reach reach =
          reach_of(exact, k, depths, {1, rounding.steps * times, rounding.pixels * times});
      if (explains(reach, state)) u.times = times;
    }
    d.first_unexplained.push_back(u);
  }
  return d;
}

std::uint64_t differing_on_edges(const ExactAnswers& exact, const ShadowMask& drawn) {
  std::uint64_t n = 0;
  for (std::size_t k = 0; k < drawn.state.size(); ++k) {
    if (drawn.state[k] == exact.mask.state[k] || exact.edge_on[k] != 0) continue;
    n += (states_at_edge(exact, k) & bit_of(drawn.state[k])) != 0 ? 1 : 0;
  }
  return n;
}

std::uint64_t samples_near_edges(const ExactAnswers& exact, int pixels) {
  const View& v = exact.view->samples.view;
  std::uint64_t n = 0;
  for (std::size_t k = 0; k < exact.mask.state.size(); ++k) {
    if (exact.edge_on[k] != 0) continue;
    const int column = static_cast<int>(k) % v.width, row = static_cast<int>(k) / v.width;
    const std::uint8_t bits = states_near(exact, column, row, pixels);
    n += (bits & (bits - 1)) != 0 ? 1 : 0;
  }
  return n;
}

std::uint64_t differing_pixels(const ExactAnswers& exact, const ShadowMask& a,
                               const ShadowMask& b) {
  std::uint64_t n = 0;
  for (std::size_t k = 0; k < a.state.size(); ++k)
    n += a.state[k] != b.state[k] && exact.edge_on[k] == 0 ? 1 : 0;
  return n;
}

}  // namespace gnomon
