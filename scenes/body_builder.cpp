#include <scenes/body_builder.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include <gnomon/core/place.h>
#include <gnomon/mesh/weld.h>

namespace gnomon::scenes {
namespace {

double snapped(double x) { return std::round(x * 1024) / 1024; }
Vec3 snapped(const Vec3& p) { return {snapped(p.x), snapped(p.y), snapped(p.z)}; }

std::uint32_t index(std::size_t k) { return static_cast<std::uint32_t>(k); }

double doubled_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Ear clipping. Precondition: simple, no three neighbours in a line that stays so.
std::vector<Triangle> triangulated(const std::vector<Vec2>& outline) {
  std::vector<std::uint32_t> left;
  double area = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    left.push_back(index(k));
    const Vec2 &a = outline[k], &b = outline[(k + 1) % outline.size()];
    area += a.x * b.y - a.y * b.x;
  }
  if (area < 0) std::reverse(left.begin(), left.end());
  std::vector<Triangle> out;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    // Of all ears the one with the most area: no slivers, and nothing in a line is left behind.
    std::size_t best = n;
    double most = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::array<std::uint32_t, 3> t = {left[(k + n - 1) % n], left[k], left[(k + 1) % n]};
      const Vec2 &a = outline[t[0]], &b = outline[t[1]], &c = outline[t[2]];
      const double ear = doubled_area(a, b, c);
      if (ear <= most) continue;
      const bool free = std::none_of(left.begin(), left.end(), [&](std::uint32_t v) {
        const Vec2& p = outline[v];
        return v != t[0] && v != t[1] && v != t[2] && doubled_area(a, b, p) >= 0 &&
               doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
      });
      if (!free) continue;
      best = k;
      most = ear;
    }
    assert(best < n);
    out.push_back({left[(best + n - 1) % n], left[best], left[(best + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  out.push_back({left[0], left[1], left[2]});
  return out;
}

// Sides between neighbouring rings.
std::vector<Triangle> sides_of(std::size_t rings, std::size_t n, bool closed) {
  std::vector<Triangle> faces;
  for (std::size_t r = 0; r + (closed ? 0 : 1) < rings; ++r) {
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = (r + 1) % rings, j = (k + 1) % n;
      faces.push_back({index(r * n + k), index(r * n + j), index(next * n + j)});
      faces.push_back({index(r * n + k), index(next * n + j), index(next * n + k)});
    }
  }
  return faces;
}

std::vector<Vec3> joined(const std::vector<std::vector<Vec3>>& rings) {
  std::vector<Vec3> points;
  for (const auto& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  return points;
}

}  // namespace

std::vector<Vec3> circle(const Vec3& middle, const Vec3& u, const Vec3& v, int n) {
  std::vector<Vec3> out;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * kPi * k / n;
    out.push_back(middle + u * std::cos(a) + v * std::sin(a));
  }
  return out;
}

void BodyBuilder::begin(const std::string& object, const std::string& material, const Vec3& colour,
                        bool casts) {
  for (std::size_t s = 0; s < scene_.surfaces.size(); ++s) {
    if (scene_.surfaces[s].object == object && scene_.surfaces[s].material == material) {
      surface_ = index(s);
      return;
    }
  }
  std::vector<Material>& materials = scene_.appearance.materials;
  const auto known = std::find_if(materials.begin(), materials.end(),
                                  [&](const Material& m) { return m.name == material; });
  material_of_.push_back(index(static_cast<std::size_t>(known - materials.begin())));
  if (known == materials.end()) {
    Material m;
    m.name = material;
    m.base_colour = colour;
    materials.push_back(std::move(m));
  }
  surface_ = index(scene_.surfaces.size());
  Surface s;
  s.object = s.group = object;
  s.material = material;
  s.casts = casts;
  scene_.surfaces.push_back(std::move(s));
}

std::uint32_t BodyBuilder::vertex(const Vec3& p) {
  scene_.mesh.positions.push_back(snapped(p));
  return index(scene_.mesh.positions.size() - 1);
}

void BodyBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  scene_.mesh.triangles.push_back({a, b, c});
  scene_.surface_of.push_back(surface_);
}

void BodyBuilder::plate(const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::uint32_t i = vertex(a), j = vertex(b), k = vertex(c);
  triangle(i, j, k);
}

void BodyBuilder::sheet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const std::uint32_t i = vertex(a), j = vertex(b), k = vertex(c), l = vertex(d);
  triangle(i, j, k);
  triangle(i, k, l);
}

void BodyBuilder::grid(const Vec3& corner, double cell_x, double cell_y, int across, int deep) {
  const std::uint32_t first = index(scene_.mesh.positions.size());
  for (int j = 0; j <= deep; ++j)
    for (int i = 0; i <= across; ++i) vertex(corner + Vec3(i * cell_x, j * cell_y, 0));
  const auto at = [&](int i, int j) {
    return first + static_cast<std::uint32_t>(j * (across + 1) + i);
  };
  for (int j = 0; j < deep; ++j) {
    for (int i = 0; i < across; ++i) {
      triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

void BodyBuilder::body(const std::vector<Vec3>& points, std::vector<Triangle> faces) {
  double volume = 0;
  for (const Triangle& f : faces) {
    volume += glm::dot(points[f[0]] - points[0],
                       glm::cross(points[f[1]] - points[0], points[f[2]] - points[0]));
  }
  const std::uint32_t first = index(scene_.mesh.positions.size());
  for (const Vec3& p : points) vertex(p);
  for (Triangle& f : faces) {
    if (volume < 0) std::swap(f[1], f[2]);
    triangle(first + f[0], first + f[1], first + f[2]);
  }
}

void BodyBuilder::loft(const std::vector<std::vector<Vec3>>& rings) {
  const std::size_t n = rings.front().size(), last = (rings.size() - 1) * n;
  std::vector<Triangle> faces = sides_of(rings.size(), n, false);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    faces.push_back({0, index(k + 1), index(k)});
    faces.push_back({index(last), index(last + k), index(last + k + 1)});
  }
  body(joined(rings), std::move(faces));
}

void BodyBuilder::concave_prism(const std::vector<Vec3>& outline, const Vec3& along, int axis) {
  std::vector<Vec2> flat;
  for (const Vec3& p : outline) flat.emplace_back(p[(axis + 1) % 3], p[(axis + 2) % 3]);
  const std::vector<Triangle> cap = triangulated(flat);
  double area = 0;
  for (std::size_t k = 0; k < flat.size(); ++k) {
    const Vec2 &a = flat[k], &b = flat[(k + 1) % flat.size()];
    area += a.x * b.y - a.y * b.x;
  }
  const std::size_t n = outline.size();
  std::vector<Vec3> points = outline;
  for (const Vec3& p : outline) points.push_back(p + along);
  std::vector<Triangle> faces = sides_of(2, n, false);
  for (Triangle t : cap) {  // counterclockwise; the sides follow the outline
    if (area < 0) std::swap(t[1], t[2]);
    faces.push_back({t[0], t[2], t[1]});
    faces.push_back({index(n + t[0]), index(n + t[1]), index(n + t[2])});
  }
  body(points, std::move(faces));
}

void BodyBuilder::closed_loft(const std::vector<std::vector<Vec3>>& rings) {
  body(joined(rings), sides_of(rings.size(), rings.front().size(), true));
}

void BodyBuilder::box(const Vec3& lo, const Vec3& hi) {
  parallelepiped(lo, {hi.x - lo.x, 0, 0}, {0, hi.y - lo.y, 0}, {0, 0, hi.z - lo.z});
}

void BodyBuilder::parallelepiped(const Vec3& at, const Vec3& u, const Vec3& v, const Vec3& w) {
  // Of rounded vectors: its faces are plane.
  const Vec3 o = snapped(at), a = snapped(u), b = snapped(v), c = snapped(w);
  loft({{o, o + a, o + a + b, o + b}, {o + c, o + a + c, o + a + b + c, o + b + c}});
}

void BodyBuilder::beam(const Vec3& a, const Vec3& b, double width, double depth, const Vec3& side) {
  const Vec3 along = glm::normalize(b - a);
  const Vec3 s = glm::normalize(side - along * glm::dot(side, along)), t = glm::cross(along, s);
  parallelepiped(a - s * (width / 2) - t * (depth / 2), s * width, t * depth, b - a);
}

void BodyBuilder::bar(const Vec3& a, const Vec3& b, double radius, int sides) {
  const Vec3 along = glm::normalize(b - a);
  const Vec3 side = std::fabs(along.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 s = glm::normalize(glm::cross(along, side)), t = glm::cross(along, s);
  loft({circle(a, s * radius, t * radius, sides), circle(b, s * radius, t * radius, sides)});
}

void BodyBuilder::angle_profile(const Vec3& a, const Vec3& b, double width, const Vec3& side) {
  const Vec3 along = glm::normalize(b - a);
  const Vec3 s = glm::normalize(side - along * glm::dot(side, along)), t = glm::cross(along, s);
  const double thin = width / 5;
  const std::vector<Vec2> outline{{0, 0},       {width, 0},    {width, thin},
                                  {thin, thin}, {thin, width}, {0, width}};
  std::vector<Vec3> points;
  for (const Vec3& end : {a, b})
    for (const Vec2& p : outline) points.push_back(end + s * p.x + t * p.y);
  std::vector<Triangle> faces = sides_of(2, 6, false);
  for (const Triangle& c : {Triangle{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    faces.push_back({c[0], c[2], c[1]});
    faces.push_back({c[0] + 6, c[1] + 6, c[2] + 6});
  }
  body(points, std::move(faces));
}

void BodyBuilder::turned(const Vec3& at, const std::vector<Vec2>& outline, int around) {
  const bool ring = outline.front().x != 0;
  const std::size_t n = outline.size(), segments = static_cast<std::size_t>(around);
  std::vector<Vec3> points;
  std::vector<std::uint32_t> first(n);
  for (std::size_t i = 0; i < n; ++i) {
    first[i] = index(points.size());
    const Vec3 middle = at + Vec3(0, 0, outline[i].y);
    if (outline[i].x == 0) {
      points.push_back(middle);
      continue;
    }
    for (const Vec3& p : circle(middle, {outline[i].x, 0, 0}, {0, outline[i].x, 0}, around))
      points.push_back(p);
  }
  const auto of = [&](std::size_t i, std::size_t k) {
    return outline[i].x == 0 ? first[i] : first[i] + index(k % segments);
  };
  std::vector<Triangle> faces;
  for (std::size_t i = 0; i + (ring ? 0 : 1) < n; ++i) {
    const std::size_t j = (i + 1) % n;
    for (std::size_t k = 0; k < segments; ++k) {
      if (outline[i].x != 0) faces.push_back({of(i, k), of(i, k + 1), of(j, k)});
      if (outline[j].x != 0) faces.push_back({of(i, k + 1), of(j, k + 1), of(j, k)});
    }
  }
  body(points, std::move(faces));
}

std::size_t BodyBuilder::casting() const {
  std::size_t n = 0;
  for (const std::uint32_t s : scene_.surface_of) n += scene_.surfaces[s].casts ? 1 : 0;
  return n;
}

std::size_t BodyBuilder::triangles_of(const std::string& object) const {
  std::size_t n = 0;
  for (const std::uint32_t s : scene_.surface_of) n += scene_.surfaces[s].object == object ? 1 : 0;
  return n;
}

Scene BodyBuilder::finished(double latitude, double longitude) {
  [[maybe_unused]] const WeldReport report = weld(scene_.mesh, scene_.surface_of);
  assert(report.zero_area_triangles == 0);
  for (const std::uint32_t s : scene_.surface_of)
    scene_.appearance.material_of.push_back(material_of_[s]);
  scene_.frame.place = Place{latitude * kDegree, longitude * kDegree, 0};
  return std::move(scene_);
}

}  // namespace gnomon::scenes
