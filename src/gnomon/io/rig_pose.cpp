// Tracks at a time, and the nodes they move.
#include <gnomon/io/rig.h>

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

using Numbers = std::vector<double>;

// Quaternions nearer than this to each other (cosine of half the angle between them) are
// interpolated linearly: the sine of the angle, by which the other way divides, is below 1e-5, and
// what the two ways differ by is its square times the angle, below double precision.
constexpr double kNearlyEqual = 1 - 1e-10;

// On the shorter way from a to b.
Numbers slerp(const Numbers& a, const Numbers& b, double s) {
  double cosine = 0, length_a = 0, length_b = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    cosine += a[k] * b[k], length_a += a[k] * a[k], length_b += b[k] * b[k];
  }
  // Quaternions of files have length 1 up to their precision, or less care.
  const double la = std::sqrt(length_a), lb = std::sqrt(length_b);
  if (!(la > 0) || !(lb > 0)) return s < 0.5 ? a : b;
  cosine /= la * lb;
  const double sign = cosine < 0 ? -1 : 1;
  cosine = std::min(1.0, sign * cosine);
  double wa = 1 - s, wb = s;
  if (cosine < kNearlyEqual) {
    const double angle = std::acos(cosine), sine = std::sin(angle);
    wa = std::sin((1 - s) * angle) / sine;
    wb = std::sin(s * angle) / sine;
  }
  Numbers out(4);
  for (std::size_t k = 0; k < 4; ++k) out[k] = wa * a[k] / la + sign * wb * b[k] / lb;
  return out;
}

Numbers key(const RigTrack& t, std::size_t k, std::size_t part = 1) {
  const bool cubic = t.between == RigTrack::Between::cubic;
  const std::size_t at = (cubic ? 3 * k + part : k) * t.width;
  const auto begin = t.values.begin() + static_cast<std::ptrdiff_t>(at);
  return Numbers(begin, begin + static_cast<std::ptrdiff_t>(t.width));
}

Numbers value_at(const RigTrack& t, double time) {
  const auto after = std::upper_bound(t.times.begin(), t.times.end(), time);
  if (after == t.times.begin()) return key(t, 0);
  const auto k = static_cast<std::size_t>(after - t.times.begin()) - 1;
  if (after == t.times.end() || t.between == RigTrack::Between::step) return key(t, k);
  const double step = t.times[k + 1] - t.times[k], s = (time - t.times[k]) / step;
  const Numbers a = key(t, k), b = key(t, k + 1);
  if (t.between == RigTrack::Between::linear && t.of == RigTrack::Of::rotation) {
    return slerp(a, b, s);
  }
  Numbers out(t.width);
  if (t.between == RigTrack::Between::linear) {
    for (std::size_t c = 0; c < t.width; ++c) out[c] = a[c] + s * (b[c] - a[c]);
    return out;
  }
  // Hermite's spline (glTF, C.4).
  const Numbers leaving = key(t, k, 2), arriving = key(t, k + 1, 0);
  const double s2 = s * s, s3 = s2 * s;
  for (std::size_t c = 0; c < t.width; ++c) {
    out[c] = (2 * s3 - 3 * s2 + 1) * a[c] + step * (s3 - 2 * s2 + s) * leaving[c] +
             (3 * s2 - 2 * s3) * b[c] + step * (s3 - s2) * arriving[c];
  }
  return out;
}

double in_clip(const RigClip& clip, double time) {
  if (time <= clip.duration) return time;
  return clip.duration > 0 ? std::fmod(time, clip.duration) : 0.0;
}

std::vector<Mat4> worlds(const std::vector<RigNode>& nodes, const std::vector<Mat4>& own) {
  std::vector<Mat4> world;
  world.reserve(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::int32_t parent = nodes[k].parent;
    world.push_back((parent < 0 ? Mat4(1) : world[static_cast<std::size_t>(parent)]) * own[k]);
  }
  return world;
}

Mat4 matrix_at_rest(const RigNode& n) {
  return n.matrix ? *n.matrix : node_matrix(n.translation, n.rotation, n.scale);
}

// The frame at a time and the one after it.
void find_frames(RigPose& pose, const RigClip& clip, double time) {
  const double at = time * clip.frames_per_second, whole = std::floor(at);
  const auto frame = static_cast<std::size_t>(whole);
  pose.framed = true;
  pose.frame = frame % clip.frames;
  pose.next_frame = (frame + 1) % clip.frames;
  pose.to_next = at - whole;
}

}  // namespace

Mat4 node_matrix(const Vec3& t, const Vec4& r, const Vec3& s) {
  // A quaternion of single precision is not quite of length 1; its direction is meant.
  const double length = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
  const double x = r.x / length, y = r.y / length, z = r.z / length, w = r.w / length;
  return Mat4(s.x * (1 - 2 * (y * y + z * z)), s.x * 2 * (x * y + z * w), s.x * 2 * (x * z - y * w),
              0, s.y * 2 * (x * y - z * w), s.y * (1 - 2 * (x * x + z * z)),
              s.y * 2 * (y * z + x * w), 0, s.z * 2 * (x * z + y * w), s.z * 2 * (y * z - x * w),
              s.z * (1 - 2 * (x * x + y * y)), 0, t.x, t.y, t.z, 1);
}

RigPose pose_at_rest(const std::vector<RigNode>& nodes) {
  std::vector<Mat4> own;
  for (const RigNode& n : nodes) own.push_back(matrix_at_rest(n));
  RigPose pose;
  pose.world = worlds(nodes, own);
  pose.weights.resize(nodes.size());
  return pose;
}

RigPose pose_at(const std::vector<RigNode>& nodes, const RigClip& clip, double time) {
  const double now = in_clip(clip, time);
  RigPose pose;
  pose.weights.resize(nodes.size());
  if (clip.frames > 0) find_frames(pose, clip, now);
  std::vector<RigNode> moved = nodes;
  std::vector<bool> by_tracks(nodes.size(), false);
  for (const RigTrack& track : clip.tracks) {
    const Numbers v = value_at(track, now);
    RigNode& n = moved[track.node];
    if (track.of == RigTrack::Of::weights) {
      pose.weights[track.node] = v;
      continue;
    }
    by_tracks[track.node] = true;
    if (track.of == RigTrack::Of::translation) n.translation = Vec3(v[0], v[1], v[2]);
    if (track.of == RigTrack::Of::scale) n.scale = Vec3(v[0], v[1], v[2]);
    const bool turns = track.of == RigTrack::Of::rotation &&
                       v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3] > 0;
    if (turns) n.rotation = Vec4(v[0], v[1], v[2], v[3]);
  }
  std::vector<Mat4> own;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const RigNode& n = moved[k];
    own.push_back(by_tracks[k] ? node_matrix(n.translation, n.rotation, n.scale)
                               : matrix_at_rest(n));
  }
  pose.world = worlds(nodes, own);
  return pose;
}

}  // namespace gnomon
