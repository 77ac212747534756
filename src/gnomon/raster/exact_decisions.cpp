#include <gnomon/raster/exact_decisions.h>

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
