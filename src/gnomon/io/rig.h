// What moves in an animated model, and where it is at a time: nodes, skins, morph targets, frames.
// Based on: Khronos Group, glTF 2.0 Specification, 2021, 3.7.3 and 3.11; appendix C
// (interpolation).
//
// Numbers of files are of single precision, all that is made of them here of double.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon {

using Mat4 = glm::dmat4;

struct RigNode {
  std::int32_t parent = -1;    // an earlier node; -1: none
  std::optional<Mat4> matrix;  // at rest; none: made of the next three
  // What an animation replaces: translation * rotation (x, y, z, w; of any length but 0) * scale.
  Vec3 translation{0, 0, 0};
  Vec4 rotation{0, 0, 0, 1};
  Vec3 scale{1, 1, 1};
};

// Changes of one thing at one node.
struct RigTrack {
  enum class Of { translation, rotation, scale, weights };
  enum class Between { step, linear, cubic };
  std::uint32_t node = 0;
  Of of = Of::translation;
  Between between = Between::linear;
  std::size_t width = 3;       // numbers of a key: 3; rotation 4; weights one per morph target
  std::vector<double> times;   // seconds, ascending, never empty
  std::vector<double> values;  // width per key; cubic: in-tangent, value, out-tangent
};

// One animation. Either tracks, or frames of the parts.
struct RigClip {
  double duration = 0;  // seconds
  std::vector<RigTrack> tracks;
  std::size_t frames = 0;        // 0: it has tracks
  double frames_per_second = 0;  // the last frame goes over into the first
};

struct RigShape {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  // as many, or none; of any length
};

struct RigBone {
  std::uint32_t node = 0;
  Mat4 inverse{1};  // from the mesh to the bone
};

struct RigInfluence {
  std::uint32_t vertex = 0, bone = 0;
  double weight = 0;
};

// A mesh under a node.
struct RigPart {
  std::uint32_t node = 0;
  RigShape shape;
  std::vector<RigShape> targets;  // what each morph target adds at weight 1; may be empty
  std::vector<double> weights;    // of the targets, at rest
  std::vector<RigBone> bones;
  std::vector<RigInfluence> influences;  // added up in this order, weights scaled to a sum of 1;
                                         // vertices without any stand as the node does
  std::vector<RigShape> frames;          // in place of `shape`, but at rest
};

struct RigPoint {
  std::uint32_t part = 0, vertex = 0;
};

struct Rig {
  std::vector<RigNode> nodes;  // parents before children
  std::vector<RigPart> parts;
  std::vector<std::string> clip_names;  // as the file has them; its number where it has no name
  std::optional<std::size_t> chosen;    // index of the clip below
  std::optional<RigClip> clip;
  std::array<Vec3, 3> axes{Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0, 1, 0)};  // x, y, z of the model,
                                                                           // as functions of ours
  std::vector<RigPoint> points;                                            // see ReadOptions::rig
};

// A rig at a time.
struct RigPose {
  std::vector<Mat4> world;                   // per node
  std::vector<std::vector<double>> weights;  // per node; empty: at rest
  bool framed = false;                       // parts have frames, and it is between two of them
  std::size_t frame = 0, next_frame = 0;
  double to_next = 0;  // 0: at `frame`, 1: at `next_frame`
};

// The node's own transform. `rotation` must not be of length 0.
Mat4 node_matrix(const Vec3& translation, const Vec4& rotation, const Vec3& scale);

RigPose pose_at_rest(const std::vector<RigNode>& nodes);

// Precondition: time >= 0; more than the clip's duration goes round (its end is still its end).
// Before the first and after the last key of a track its value stays. Rotations turn on the shorter
// way.
RigPose pose_at(const std::vector<RigNode>& nodes, const RigClip& clip, double time);

// Points and normals (where the part has them) as posed, before Rig::axes.
RigShape posed(const RigPart& part, const RigPose& pose);

// The same with the axes of the model.
Vec3 turned(const std::array<Vec3, 3>& axes, const Vec3& p);

}  // namespace gnomon
