// Silhouettes under a thousand lights, of a mesh that stands, that is moved as a whole and that is
// deformed, and the index lists of a shadow volume. docs/library.md says when to take what.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/weld.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/light_sides.h>
#include <gnomon/silhouette/silhouette.h>
#include <gnomon/volume/part_silhouettes.h>
#include <gnomon/volume/parts.h>
#include <gnomon/volume/volume_lists.h>

// A ring, closed, wound outwards.
static gnomon::TriMesh ring() {
  constexpr std::uint32_t kAround = 200, kAcross = 100;
  gnomon::TriMesh mesh;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const double u = 2 * std::numbers::pi * i / kAround, v = 2 * std::numbers::pi * j / kAcross;
      const double r = 2 + 0.7 * std::cos(v);
      mesh.positions.push_back({r * std::cos(u), r * std::sin(u), 0.7 * std::sin(v)});
      const auto at = [](std::uint32_t k, std::uint32_t l) {
        return (k % kAround) * kAcross + l % kAcross;
      };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// Are they the edges that brute force finds, which is the specification?
static bool right(gnomon::Silhouette found, const gnomon::TriMesh& mesh,
                  const gnomon::EdgeTable& edges, const gnomon::Light& light) {
  gnomon::Silhouette scratch;
  gnomon::sort_as_table(found, scratch);  // the tree finds them in another order
  const gnomon::Silhouette all = gnomon::find_silhouette(edges, gnomon::light_sides(mesh, light));
  bool same = found.size() == all.size();
  for (std::size_t k = 0; same && k < all.size(); ++k) {
    same = found[k].a == all[k].a && found[k].b == all[k].b &&
           found[k].multiplicity == all[k].multiplicity;
  }
  return same;
}

int main() {
  gnomon::TriMesh mesh = ring();
  std::vector<std::uint32_t> per_triangle(mesh.triangles.size());  // of yours: materials, say
  gnomon::weld(mesh, per_triangle);

  // Once: which triangles meet at which edge, and the tree.
  const gnomon::EdgeTable edges = gnomon::build_edge_table(mesh);
  gnomon::EdgeTree tree = gnomon::build_edge_tree(mesh, edges);

  // For each light: a lamp is a point, a sun the direction towards it. `silhouette` and `scratch`
  // keep their memory from call to call; each thread needs its own, the tree is only read.
  gnomon::Silhouette silhouette;
  gnomon::ExtractionScratch scratch;
  std::size_t found = 0;
  for (int k = 0; k < 1000; ++k) {
    const double turn = 2 * std::numbers::pi * k / 1000;
    const gnomon::Vec3 at(5 * std::cos(turn), 5 * std::sin(turn), 3);
    const gnomon::Light light = k % 2 == 0 ? gnomon::point(at) : gnomon::direction(at);
    gnomon::find_silhouette(silhouette, tree, mesh, gnomon::snapped(light), scratch);
    found += silhouette.size();
    if (k % 100 < 2 && !right(silhouette, mesh, edges, gnomon::snapped(light))) return 1;
  }
  std::printf("%zu triangles, 1000 lights: %zu silhouette edges each in the mean\n",
              mesh.triangles.size(), found / 1000);

  // The ring turned by 30 degrees about z and carried to (10, 20, 0): the light goes the other way,
  // and nothing is built anew. A sun has no place: it is only turned.
  const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  const gnomon::Vec3 lamp = gnomon::Vec3(13, 24, 4) - gnomon::Vec3(10, 20, 0);
  const gnomon::Light in_mesh =
      gnomon::snapped(gnomon::point({c * lamp.x + s * lamp.y, c * lamp.y - s * lamp.x, lamp.z}));
  gnomon::find_silhouette(silhouette, tree, mesh, in_mesh, scratch);
  std::printf("moved: %zu edges\n", silhouette.size());

  // Deformed: new positions, same triangles. Numbers below kSmallestCoordinate must be 0.
  for (gnomon::Vec3& p : mesh.positions) p.z = gnomon::snapped(p.z + 0.2 * std::sin(3 * p.x));
  gnomon::refresh_planes(tree, mesh);
  gnomon::find_silhouette(silhouette, tree, mesh, in_mesh, scratch);
  std::printf("deformed: %zu edges\n", silhouette.size());
  if (!right(silhouette, mesh, edges, in_mesh)) return 1;

  // The volume, part by part (here there is one). Of a closed part that has neither lamp nor eye
  // inside, one light side of its triangles is enough. Caps need the light sides of all triangles;
  // sides alone (z-pass) do not: pass {} for the triangles and for their light sides.
  const gnomon::Parts parts = gnomon::split_into_parts(mesh, edges);
  const gnomon::PartsOfEdges of_edges = gnomon::parts_of_edges(edges, parts, mesh.positions.size());
  std::vector<gnomon::CastingSides> casting;
  for (const gnomon::Part& part : parts.parts) {
    const bool outside = in_mesh.z > part.hi.z;  // of its box: here, above it
    casting.push_back(part.closed && outside ? gnomon::CastingSides::one
                                             : gnomon::CastingSides::both);
  }
  const gnomon::PartSilhouettes of_parts = gnomon::split_by_part(silhouette, of_edges, casting);
  const std::vector<std::int8_t> sides = gnomon::light_sides(mesh, in_mesh);
  gnomon::VolumeLists lists;
  gnomon::LoopScratch loops;
  for (std::uint32_t k = 0; k < parts.parts.size(); ++k) {
    gnomon::append_volume(lists, mesh, of_parts.of(k), parts.parts[k].triangles, sides,
                          in_mesh.w == 0,  // a sun: one point behind all vertices
                          casting[k] == gnomon::CastingSides::one ? gnomon::Casting::negative_sides
                                                                  : gnomon::Casting::all_triangles,
                          gnomon::SideForm::triangles, k, {}, loops);
  }
  std::size_t of_sides = 0, of_caps = 0;
  for (const gnomon::ListKind kind : {gnomon::kSides, gnomon::kSidesTurned})
    of_sides += lists.lists[kind].size() / 3;
  for (const gnomon::ListKind kind :
       {gnomon::kLightCap, gnomon::kLightCapTurned, gnomon::kDarkCap, gnomon::kDarkCapTurned})
    of_caps += lists.lists[kind].size() / 3;
  std::printf("%zu volume: %zu triangles of sides, %zu of caps\n", lists.volumes.size(), of_sides,
              of_caps);
  return of_sides == 2 * silhouette.size() ? 0 : 1;
}
