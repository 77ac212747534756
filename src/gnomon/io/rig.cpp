#include <gnomon/io/rig.h>

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vec3 moved(const Mat4& m, const Vec3& p) {
  const Vec4 q = m * Vec4(p, 1.0);
  return {q.x, q.y, q.z};
}

// What turns normals as `m` turns surfaces: the transposed inverse, up to a positive factor.
struct NormalTurn {
  Vec3 x, y, z;  // columns
  explicit NormalTurn(const Mat4& m) {
    const Vec3 a(m[0].x, m[0].y, m[0].z), b(m[1].x, m[1].y, m[1].z), c(m[2].x, m[2].y, m[2].z);
    const double sign = dot(a, cross(b, c)) < 0 ? -1 : 1;
    x = sign * cross(b, c), y = sign * cross(c, a), z = sign * cross(a, b);
  }
  Vec3 operator()(const Vec3& n) const { return n.x * x + n.y * y + n.z * z; }
};

Vec3 unit(const Vec3& v) {
  const double length = std::sqrt(dot(v, v));
  return length > 0 ? v / length : Vec3(0);
}

// The shape before bones and nodes.
RigShape shaped(const RigPart& part, const RigPose& pose) {
  if (pose.framed && !part.frames.empty()) {
    const RigShape &a = part.frames[pose.frame], &b = part.frames[pose.next_frame];
    RigShape out = a;
    if (pose.to_next == 0) return out;
    for (std::size_t k = 0; k < out.points.size(); ++k) {
      out.points[k] += pose.to_next * (b.points[k] - a.points[k]);
    }
    for (std::size_t k = 0; k < out.normals.size(); ++k) {
      out.normals[k] += pose.to_next * (b.normals[k] - a.normals[k]);
    }
    return out;
  }
  RigShape out = part.shape;
  const std::vector<double>& animated = pose.weights[part.node];
  const std::vector<double>& weights = animated.empty() ? part.weights : animated;
  for (std::size_t t = 0; t < std::min(part.targets.size(), weights.size()); ++t) {
    const double w = weights[t];
    if (w == 0) continue;
    const RigShape& target = part.targets[t];
    for (std::size_t k = 0; k < target.points.size(); ++k) out.points[k] += w * target.points[k];
    if (out.normals.empty()) continue;
    for (std::size_t k = 0; k < target.normals.size(); ++k) out.normals[k] += w * target.normals[k];
  }
  return out;
}

}  // namespace

RigShape posed(const RigPart& part, const RigPose& pose) {
  const RigShape raw = shaped(part, pose);
  const std::size_t n = raw.points.size();
  const bool normals = !raw.normals.empty(), skinned = !part.bones.empty();
  std::vector<Vec3> bent(skinned ? n : 0, Vec3(0)), turned(skinned && normals ? n : 0, Vec3(0));
  std::vector<double> sum(skinned ? n : 0, 0.0);
  if (skinned) {
    std::vector<Mat4> bones;
    std::vector<NormalTurn> turns;
    for (const RigBone& bone : part.bones) {
      bones.push_back(pose.world[bone.node] * bone.inverse);
      if (normals) turns.emplace_back(bones.back());
    }
    for (const RigInfluence& by : part.influences) {
      bent[by.vertex] += by.weight * moved(bones[by.bone], raw.points[by.vertex]);
      sum[by.vertex] += by.weight;
      if (normals) {
        turned[by.vertex] += by.weight * unit(turns[by.bone](raw.normals[by.vertex]));
      }
    }
  }
  const Mat4& node = pose.world[part.node];
  const NormalTurn turn(node);
  RigShape out;
  out.points.reserve(n);
  for (std::size_t k = 0; k < n; ++k) {
    const bool by_bones = skinned && sum[k] != 0;
    out.points.push_back(by_bones ? bent[k] / sum[k] : moved(node, raw.points[k]));
    if (normals) out.normals.push_back(by_bones ? turned[k] : turn(raw.normals[k]));
  }
  return out;
}

Vec3 turned(const std::array<Vec3, 3>& axes, const Vec3& p) {
  return {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)};
}

}  // namespace gnomon
