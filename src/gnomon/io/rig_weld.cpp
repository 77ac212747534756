#include <gnomon/io/rig_weld.h>

#include <string>
#include <unordered_map>
#include <utility>

namespace gnomon {
namespace {

// Bytes of all that moves a vertex.
class Key {
 public:
  void add(double d) {
    const double positive = d + 0.0;  // -0 is 0
    bytes_.append(reinterpret_cast<const char*>(&positive), sizeof positive);
  }
  void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(const Mat4& m) {
    for (int c = 0; c < 4; ++c) {
      for (const double d : {m[c].x, m[c].y, m[c].z, m[c].w}) add(d);
    }
  }
  void add(std::size_t n) { bytes_.append(reinterpret_cast<const char*>(&n), sizeof n); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Per vertex of a part.
std::vector<std::string> keys_of(const RigPart& part) {
  std::vector<Key> keys(part.shape.points.size());
  for (std::size_t v = 0; v < keys.size(); ++v) {
    Key& key = keys[v];
    key.add(std::size_t(part.node));  // stands by it, or has its morph targets' weights
    key.add(part.shape.points[v]);
    for (std::size_t t = 0; t < part.targets.size(); ++t) {
      key.add(part.weights[t]);
      const auto& moves = part.targets[t].points;
      key.add(moves.empty() ? Vec3(0) : moves[v]);
    }
    for (const RigShape& frame : part.frames) key.add(frame.points[v]);
  }
  for (const RigInfluence& by : part.influences) {
    const RigBone& bone = part.bones[by.bone];
    keys[by.vertex].add(std::size_t(bone.node));
    keys[by.vertex].add(bone.inverse);
    keys[by.vertex].add(by.weight);
  }
  std::vector<std::string> out;
  for (Key& key : keys) out.push_back(key.take());
  return out;
}

void keep(std::vector<Vec3>& list, const std::vector<std::uint32_t>& kept) {
  if (list.empty()) return;
  std::vector<Vec3> out;
  for (const std::uint32_t v : kept) out.push_back(list[v]);
  list = std::move(out);
}

}  // namespace

RigWeld weld_rig(const Rig& rig, const std::vector<Vec3>& positions) {
  RigWeld out;
  std::vector<std::vector<std::string>> keys;
  for (const RigPart& part : rig.parts) keys.push_back(keys_of(part));
  std::unordered_map<std::string, std::uint32_t> vertices;
  for (std::uint32_t k = 0; k < rig.points.size(); ++k) {
    const RigPoint& p = rig.points[k];
    Key key;
    key.add(positions[k]);
    const auto [at, added] = vertices.try_emplace(key.take() + keys[p.part][p.vertex],
                                                  static_cast<std::uint32_t>(vertices.size()));
    if (added) {
      out.positions.push_back(positions[k]);
      out.point_of.push_back(k);
    }
    out.vertex_of.push_back(at->second);
  }
  return out;
}

std::vector<std::uint32_t> keep_points(Rig& rig, const RigWeld& weld) {
  constexpr std::uint32_t kGone = 0xffffffffu;
  std::vector<std::vector<std::uint32_t>> kept(rig.parts.size()), renamed;
  for (const RigPart& part : rig.parts) renamed.emplace_back(part.shape.points.size(), kGone);
  std::vector<RigPoint> points;
  std::vector<std::uint32_t> vertex_of;
  for (std::uint32_t v = 0; v < weld.point_of.size(); ++v) {
    const RigPoint p = rig.points[weld.point_of[v]];
    const auto number = static_cast<std::uint32_t>(kept[p.part].size());
    renamed[p.part][p.vertex] = number;
    kept[p.part].push_back(p.vertex);
    points.push_back({p.part, number});
    vertex_of.push_back(v);
  }
  for (std::size_t k = 0; k < rig.parts.size(); ++k) {
    RigPart& part = rig.parts[k];
    const auto shrink = [&](RigShape& shape) {
      keep(shape.points, kept[k]);
      shape.normals.clear();
    };
    shrink(part.shape);
    for (RigShape& target : part.targets) shrink(target);
    for (RigShape& frame : part.frames) shrink(frame);
    std::vector<RigInfluence> left;
    for (RigInfluence by : part.influences) {
      by.vertex = renamed[k][by.vertex];
      if (by.vertex != kGone) left.push_back(by);
    }
    part.influences = std::move(left);
  }
  rig.points = std::move(points);
  return vertex_of;
}

}  // namespace gnomon
