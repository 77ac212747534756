#include <gnomon/raster/exact_decisions.h>

#include <algorithm>

namespace gnomon {

const Polygon& ExactDecisions::polygon(const Strip& s) {
  if (strip_ != &s) {
    strip_ = &s;
    last_face_ = nullptr;
    set_up(of_strip_, equations_of_side(light_, view_, s.id), light_.errors, view_.space,
           receivers_.view, corners_of_side(light_, casters_, s.id), light_.light, depths);
    of_strip_.id = s.id;
  }
  return of_strip_;
}

Corners ExactDecisions::corners(bool caster, std::uint32_t id) const {
  return caster ? corners_of(*casters_.scene, id) : corners_of_side(light_, casters_, id);
}

Span ExactDecisions::span(const Strip& s, int row) { return span(polygon(s), row); }

bool ExactDecisions::in_front(const Strip& s, int column, int row) {
  return in_front(polygon(s), column, row);
}

Span ExactDecisions::span(const Polygon& p, int row) {
  return exact_span(p, {receivers_.view, corners(p.caster, p.id), p.facing, light_.light}, row,
                    spans);
}

bool ExactDecisions::in_front(const Polygon& p, int column, int row) {
  return in_front(&p, corners(p.caster, p.id), p.facing, column, row);
}

bool ExactDecisions::covers(const Side& s, int column, int row) {
  return gnomon::covers(receivers_.view, column, row, corners(s.caster, s.id), s.facing,
                        light_.light, spans);
}

int ExactDecisions::covers_tile(const Side& s, int column, int row) {
  const int patch[2] = {column / kPatch, row / kPatch};
  if (last_side_ != &s || patch[0] != last_patch_[0] || patch[1] != last_patch_[1]) {
    last_side_ = &s;
    std::copy_n(patch, 2, last_patch_);
    last_covers_ = covers_all(s, patch[0] * kPatch, patch[1] * kPatch, kPatch, kPatch);
  }
  return last_covers_ != 0 ? last_covers_ : covers_all(s, column, row, kTile, kTile);
}

// Which side of an edge pixels lie on is the sign of a linear function, also where infinitesimals
// decide: what is true of a rectangle's corners is true in it.
int ExactDecisions::covers_all(const Side& s, int column, int row, int columns, int rows) {
  const Corners c = corners(s.caster, s.id);
  bool all = true;
  for (std::size_t k = 0; k < 3; ++k) {
    int inside = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const int x = column + (corner % 2) * (columns - 1), y = row + (corner / 2) * (rows - 1);
      if (edge_side(receivers_.view, x, y, c[k], c[(k + 1) % 3], light_.light, spans) == s.facing)
        ++inside;
    }
    if (inside == 0) return -1;
    all = all && inside == 4;
  }
  return all ? 1 : 0;
}

bool ExactDecisions::in_front(const Side& s, int column, int row) {
  return in_front(&s, corners(s.caster, s.id), s.facing, column, row);
}

bool ExactDecisions::in_front(const void* face, const Corners& c, int facing, int column, int row) {
  const std::uint32_t triangle =
      receivers_.triangle[static_cast<std::size_t>(row) *
                              static_cast<std::size_t>(receivers_.view.width) +
                          static_cast<std::size_t>(column)];
  if (triangle == kNoTriangle) return false;
  if (last_face_ != face) {
    last_face_ = face;
    in_plane_.clear();
  }
  for (const InPlane& known : in_plane_) {
    if (known.triangle != triangle) continue;
    ++close;
    ++depths.exact;
    ++depths.ties;
    return known.in_front;
  }
  const Corners r = corners_of(*casters_.scene, triangle);
  if (triangle != last_triangle_) {
    last_triangle_ = triangle;
    last_facing_ = gnomon::facing(receivers_.view, r, light_.light, depths);
  }
  ++close;
  const std::uint64_t ties = depths.ties;
  const bool front = gnomon::in_front(receivers_.view, column, row, c, facing, r, last_facing_,
                                      light_.light, depths);
  if (depths.ties > ties && in_one_plane(c, r, light_.light))
    in_plane_.push_back({triangle, front});
  return front;
}

}  // namespace gnomon
