// Silhouettes of parts, given out from that of the whole mesh.
#include <gtest/gtest.h>

#include <algorithm>

#include "soup.h"

#include <gnomon/silhouette/light_sides.h>
#include <gnomon/volume/part_silhouettes.h>

namespace gnomon {
namespace {

// Boxes that touch at corners and along edges' ends, and soup: vertices of several parts.
TEST(PartSilhouettes, AreThoseOfEachPartAloneAndHalfWhereOneSideCasts) {
  TriMesh m;
  for (int k = 0; k < 4; ++k) {
    const Vec3 lo(k, k, k % 2);
    test::add_box(m, lo, lo + Vec3(1, 1, 1));
  }
  test::add_box(m, {1, 0, 0}, {2, 1, 2});  // shares edges with two of them: one part
  test::add_soup(m, 60, 3, 1, 2);
  const Scene s = test::scene_of(m);
  const EdgeTable table = build_edge_table(s.mesh);
  const Parts parts = split_into_parts(s.mesh, table);
  const PartsOfEdges of = parts_of_edges(table, parts, s.mesh.positions.size());
  EXPECT_GT(parts.parts.size(), 3u);
  EXPECT_GT(std::count(of.of_vertex.begin(), of.of_vertex.end(), kManyParts), 0);
  for (const Light& light : {Light(1, 2, 3, 0), Light(0, 0, 1, 0), Light(0.5, 0.5, 4, 1)}) {
    const auto sides = light_sides(s.mesh, light);
    for (const bool one_side : {false, true}) {
      std::vector<CastingSides> casting;
      for (const Part& part : parts.parts) {
        casting.push_back(one_side && part.closed   ? CastingSides::one
                          : casting.size() % 5 == 4 ? CastingSides::none
                                                    : CastingSides::both);
      }
      const PartSilhouettes split = split_by_part(find_silhouette(table, sides), of, casting);
      for (std::size_t p = 0; p < parts.parts.size(); ++p) {
        std::vector<std::uint8_t> counts(sides.size(), 0);
        for (const std::uint32_t t : parts.parts[p].triangles) {
          counts[t] =
              casting[p] == CastingSides::both || (casting[p] == CastingSides::one && sides[t] < 0);
        }
        const Silhouette alone = find_silhouette(build_edge_table(s.mesh, counts), sides);
        const auto found = split.of(p);
        ASSERT_EQ(found.size(), alone.size()) << p;
        for (std::size_t k = 0; k < alone.size(); ++k) {
          EXPECT_EQ(found[k].a, alone[k].a);
          EXPECT_EQ(found[k].b, alone[k].b);
          EXPECT_EQ(found[k].multiplicity, alone[k].multiplicity);
        }
      }
    }
  }
}

}  // namespace
}  // namespace gnomon
