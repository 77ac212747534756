// Where the second paper's tree of vertices and the silhouette of the facets differ: one picture.
//   silhouette_picture MODEL.obj OUT.png
// Grey: edges of the mesh. Pink: silhouette of the facets that the contour between vertex normals
// finds too; red: that it misses; blue: that it adds. See docs/silhouettes.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include <glm/geometric.hpp>

#include <gnomon/io/load_scene.h>
#include <gnomon/io/png.h>
#include <gnomon/silhouette/hextree.h>
#include <gnomon/silhouette/light_sides.h>

namespace gnomon {
namespace {

constexpr int kWidth = 900, kHeight = 640, kFine = 3;  // samples a side of a pixel

struct Canvas {
  std::vector<glm::vec3> samples =
      std::vector<glm::vec3>(std::size_t(kWidth * kFine) * kHeight * kFine, glm::vec3(255));

  void line(Vec2 a, Vec2 b, double width, const glm::vec3& colour) {
    const double length = std::max(glm::distance(a, b), 1e-9);
    const int steps = static_cast<int>(length * kFine * 2) + 1;
    const int r = static_cast<int>(width * kFine / 2);
    for (int k = 0; k <= steps; ++k) {
      const Vec2 p = (a + (b - a) * (double(k) / steps)) * double(kFine);
      for (int y = -r; y <= r; ++y) {
        for (int x = -r; x <= r; ++x) {
          const int i = static_cast<int>(p.x) + x, j = static_cast<int>(p.y) + y;
          if (x * x + y * y > r * r || i < 0 || j < 0 || i >= kWidth * kFine ||
              j >= kHeight * kFine)
            continue;
          samples[std::size_t(j) * kWidth * kFine + std::size_t(i)] = colour;
        }
      }
    }
  }

  Picture picture() const {
    Picture out;
    out.width = kWidth;
    out.height = kHeight;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        glm::vec3 sum(0);
        for (int j = 0; j < kFine; ++j)
          for (int i = 0; i < kFine; ++i)
            sum +=
                samples[std::size_t(y * kFine + j) * kWidth * kFine + std::size_t(x * kFine + i)];
        sum /= float(kFine * kFine);
        out.pixels.push_back({std::uint8_t(sum.x), std::uint8_t(sum.y), std::uint8_t(sum.z)});
      }
    }
    return out;
  }
};

using Edges = std::set<std::pair<std::uint32_t, std::uint32_t>>;

Edges edges_of(const Silhouette& s) {
  Edges out;
  for (const SilhouetteEdge& e : s) out.insert({e.a, e.b});
  return out;
}

int run(const char* model, const char* to) {
  LoadOptions alone;
  alone.ground = "none";
  Result<LoadedScene> loaded = load_scene({std::filesystem::path(model)}, alone);
  if (!loaded) {
    std::fprintf(stderr, "silhouette_picture: %s\n", loaded.error().message.c_str());
    return 1;
  }
  const TriMesh& mesh = loaded.value().scene.mesh;
  const Light light(0.5, -0.3, 0.8, 0);
  const EdgeTable table = build_edge_table(mesh);
  Silhouette found;
  find_silhouette(found, build_hextree(mesh, table, DualForm::vertices), mesh, light);
  const Edges exact = edges_of(find_silhouette(table, light_sides(mesh, light))),
              smooth = edges_of(found);

  // Seen from the south-west, in parallel, all of it in the picture.
  const Vec3 right = glm::normalize(Vec3(1, -0.6, 0)), up = glm::normalize(Vec3(0.25, 0.42, 0.9));
  Vec2 lo(1e300), hi(-1e300);
  std::vector<Vec2> at;
  for (const Vec3& p : mesh.positions) {
    at.push_back({glm::dot(p, right), -glm::dot(p, up)});
    lo = glm::min(lo, at.back());
    hi = glm::max(hi, at.back());
  }
  const double scale = 0.92 * std::min(kWidth / (hi.x - lo.x), kHeight / (hi.y - lo.y));
  for (Vec2& p : at) p = (p - (lo + hi) * 0.5) * scale + Vec2(kWidth / 2.0, kHeight / 2.0);
  Canvas canvas;
  const auto draw = [&](const Edges& edges, const Edges& others, bool in_others, double width,
                        const glm::vec3& colour) {
    for (const auto& e : edges)
      if (others.contains(e) == in_others) canvas.line(at[e.first], at[e.second], width, colour);
  };
  for (const auto& [a, b] : table.vertices) canvas.line(at[a], at[b], 0.4, glm::vec3(205));
  draw(smooth, exact, false, 2.6, glm::vec3(40, 90, 230));
  draw(exact, smooth, false, 2.6, glm::vec3(220, 30, 20));
  draw(exact, smooth, true, 2.6, glm::vec3(255, 120, 190));
  const Result<FileWritten> written = write_png(to, canvas.picture());
  if (!written) {
    std::fprintf(stderr, "silhouette_picture: %s\n", written.error().message.c_str());
    return 1;
  }
  std::size_t both = 0;
  for (const auto& e : exact) both += smooth.contains(e);
  std::printf(
      "%s: silhouette of the facets %zu edges, of the vertices %zu; both %zu, missed %zu, added "
      "%zu\n",
      model, exact.size(), smooth.size(), both, exact.size() - both, smooth.size() - both);
  return 0;
}

}  // namespace
}  // namespace gnomon

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "silhouette_picture MODEL OUT.png\n");
    return 1;
  }
  return gnomon::run(argv[1], argv[2]);
}
