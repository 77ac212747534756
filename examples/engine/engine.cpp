// Shadow volumes for a renderer of your own: what to put into its vertex buffer, and what to do
// with the weights. Any triangle soup will do; here a cube under a lamp.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <gnomon/gnomon.h>
#include <gnomon/mesh/weld.h>
#include <gnomon/silhouette/light_sides.h>

// A vertex as a shader takes it: homogeneous, w = 0 at infinity. Draw it with a projection whose
// far plane is at infinity (or with depth clamp), and nothing needs to be clipped.
struct Vertex {
  float x, y, z, w;
};

// Along a ray from the eye, a front face (counter-clockwise) subtracts its polygon's weight from
// the count, a back face adds it; a pixel whose count is above 0 is in shadow.
static void append(std::vector<Vertex>& buffer, const gnomon::VolumePolygon& polygon) {
  for (int k = 1; k + 1 < polygon.size; ++k)  // a fan
    for (const int corner : {0, k, k + 1}) {
      const gnomon::Vec4& v = polygon.vertices[static_cast<std::size_t>(corner)];
      buffer.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
                        static_cast<float>(v.w)});
    }
}

int main() {
  gnomon::TriMesh cube;
  for (int k = 0; k < 8; ++k)  // bit 0 chooses x, bit 1 y, bit 2 z
    cube.positions.push_back({k & 1, (k >> 1) & 1, (k >> 2) & 1});
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  std::vector<std::uint32_t> per_triangle(cube.triangles.size());
  gnomon::weld(cube, per_triangle);

  // Once per mesh: all edges with the triangles at them.
  const gnomon::EdgeTable edges = gnomon::build_edge_table(cube);

  // Once per light: a lamp sees three faces of the cube, so its silhouette is a hexagon.
  const gnomon::Light lamp = gnomon::point({3, 4, 5});
  const std::vector<std::int8_t> sides = gnomon::light_sides(cube, lamp);
  const gnomon::Silhouette silhouette = gnomon::find_silhouette(edges, sides);
  const gnomon::VolumePolygons volume =
      gnomon::build_volume(cube, {}, sides, silhouette, lamp);  // {}: all triangles cast

  std::vector<Vertex> buffer;
  for (const auto& polygon : volume.sides) append(buffer, polygon);
  const std::size_t of_sides = buffer.size();
  for (const auto& polygon : volume.light_cap) append(buffer, polygon);
  for (const auto& polygon : volume.dark_cap) append(buffer, polygon);

  // Weights are those of any soup: every triangle casts, lit or not, so a closed surface counts
  // twice. |weight| is 2 at its outline and 1 at a border of an open one.
  int heaviest = 0;
  for (const auto& polygon : volume.sides) heaviest = std::max(heaviest, std::abs(polygon.weight));

  std::printf("%zu edges, %zu of them silhouette\n", edges.vertices.size(), silhouette.size());
  std::printf("%zu sides of weight up to %d, caps: %zu triangles at the caster, %zu at infinity\n",
              volume.sides.size(), heaviest, volume.light_cap.size(), volume.dark_cap.size());
  std::printf("%zu vertices to draw: %zu for depth pass, with caps for depth fail\n", buffer.size(),
              of_sides);
  return silhouette.size() == 6 ? 0 : 1;
}
