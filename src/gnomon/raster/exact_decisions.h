// What the filling loops ask where float cannot tell: the predicates of view/predicates.h, for the
// strips, polygons and sides of one light. Remembers the last answers; one object a thread.
#pragma once

#include <vector>

#include <gnomon/raster/fill_polygons.h>
#include <gnomon/raster/fill_strips.h>
#include <gnomon/raster/fill_tiles.h>
#include <gnomon/raster/light_setup.h>

namespace gnomon {

class ExactDecisions final : public ExactStripDecisions,
                             public ExactPolygonDecisions,
                             public ExactSideDecisions {
 public:
  // All of them must outlive it.
  ExactDecisions(const Casters& casters, const ViewSetup& view, const Receivers& receivers,
                 const LightSetup& light)
      : casters_(casters), view_(view), receivers_(receivers), light_(light) {}

  Span span(const Strip& s, int row) override;
  bool in_front(const Strip& s, int column, int row) override;
  Span span(const Polygon& p, int row) override;
  bool in_front(const Polygon& p, int column, int row) override;
  bool covers(const Side& s, int column, int row) override;
  int covers_tile(const Side& s, int column, int row) override;
  bool in_front(const Side& s, int column, int row) override;

  ExactStats spans, depths;
  std::uint64_t close = 0;  // samples that left the float filter

 private:
  const Polygon& polygon(const Strip& s);
  Corners corners(bool caster, std::uint32_t id) const;
  // `face`: whose corners these are.
  bool in_front(const void* face, const Corners& c, int facing, int column, int row);

  // covers_tile(), of any rectangle.
  int covers_all(const Side& s, int column, int row, int columns, int rows);

  // A receiver in the face's plane: the answer is one for all pixels (docs/exactness.md).
  struct InPlane {
    std::uint32_t triangle;
    bool in_front;
  };

  const Casters& casters_;
  const ViewSetup& view_;
  const Receivers& receivers_;
  const LightSetup& light_;
  const Side* last_side_ = nullptr;
  int last_patch_[2] = {0, 0}, last_covers_ = 0;  // covers_all() of the patch
  const Strip* strip_ = nullptr;
  Polygon of_strip_;  // what it stands for
  std::uint32_t last_triangle_ = kNoTriangle;
  int last_facing_ = 0;
  const void* last_face_ = nullptr;
  std::vector<InPlane> in_plane_;  // of last_face_
};

}  // namespace gnomon
