#include <gnomon/volume/shadow_volume.h>

namespace gnomon {

VolumePolygons build_volume(const TriMesh& mesh, const std::vector<std::uint8_t>& casters,
                            const std::vector<std::int8_t>& sides, const Silhouette& silhouette,
                            const Light& light) {
  const bool directional = light.w == 0;
  // A*Lw - L*Aw: the point at infinity behind a, w = 0.
  const auto behind = [&](const Vec3& a) {
    return directional ? Vec4(-light.x, -light.y, -light.z, 0.0)
                       : Vec4(a.x * light.w - light.x, a.y * light.w - light.y,
                              a.z * light.w - light.z, 0.0);
  };
  VolumePolygons volume;
  volume.sides.reserve(silhouette.size());
  for (const SilhouetteEdge& e : silhouette) {
    const Vec3 &a = mesh.positions[e.a], &b = mesh.positions[e.b];
    // Interior of the prism of t = (A,B,C) is where |A; B; -L; x| has the sign of |A; B; C; L|; so
    // entering it through the side is crossing from the opposite sign, and the weight is minus the
    // multiplicity.
    if (directional) {
      volume.sides.push_back({{point(a), point(b), behind(a), Vec4(0.0)}, 3, -e.multiplicity});
    } else {
      volume.sides.push_back({{point(a), point(b), behind(b), behind(a)}, 4, -e.multiplicity});
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!casters.empty() && casters[t] == 0) continue;
    const Triangle& v = mesh.triangles[t];
    const Vec3 &a = mesh.positions[v[0]], &b = mesh.positions[v[1]], &c = mesh.positions[v[2]];
    volume.light_cap.push_back({{point(a), point(b), point(c), Vec4(0.0)}, 3, sides[t]});
    if (!directional) {
      volume.dark_cap.push_back({{behind(a), behind(b), behind(c), Vec4(0.0)}, 3, -sides[t]});
    }
  }
  return volume;
}

}  // namespace gnomon
