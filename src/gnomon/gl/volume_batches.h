// The volumes of one light brought up to date, cut into what is drawn at once, and their draws.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <gnomon/gl/renderer_state.h>

namespace gnomon::gl {

// What of one instance casts.
struct InstanceVolumes {
  const InstanceSlot* instance;
  const GpuMesh* mesh;
  CasterVolumes* volumes;
  const LightPlan::OfInstance* plan;
  // Per volume, the vertices of its near caps in State::near_caps: first[k] .. first[k + 1].
  std::vector<std::uint32_t> near_caps;
  bool offset = false;  // sides are moved away: the light grazes something of the scene
  // Per part, where its volume matters; nothing: perhaps everywhere. Empty: no part is known.
  std::vector<std::optional<Rect>> rectangles{};
};

// Volumes drawn together.
struct Batch {
  const InstanceVolumes* of = nullptr;
  bool z_fail = false;
  std::array<IndexRange, kListKinds> ranges{};
  IndexRange near_caps{};
  std::optional<Rect> scissor{};  // the frame's, where there is none
};

struct Prepared {
  std::vector<InstanceVolumes> all;
  std::vector<bool> changed;  // of each, its sides
  long long layers = 0;       // no ray from the light crosses more casting triangles
  bool grouped = false;
  bool offset = false;  // sides are moved away
};

// All volumes of a light as its plan wants them.
Prepared prepare(const Frame& frame, const LightPlan& plan);

// The same with no volume of more than `most_layers` casting triangles over each other (not of a
// convex caster), for groups of so many layers.
void regroup(const Frame& frame, const LightPlan& plan, Prepared& prepared);
inline constexpr int kGroupLayers = 63;

// All volumes, each instance's z-fail and z-pass ones at once; or in groups of few layers. Volumes
// that matter in a part of the picture only are drawn alone, others left out (FrameStats).
std::vector<std::vector<Batch>> batches_of(const Frame& frame, const Prepared& prepared);
Batch batch_of(const InstanceVolumes& v, std::size_t first, std::size_t last, bool z_fail);
// Where one volume matters, in the frame's scissor.
std::optional<Rect> scissor_of(const Frame& frame, const InstanceVolumes& v, std::size_t volume);

bool starts_at_near_plane(const Method& m);
struct FaceColours {
  float front = 1, back = 1;
};
// Program, uniforms and vertices of one instance's volumes that are counted so; colours are left to
// be set where they matter.
GLuint use_volumes(const Frame& frame, const LightPlan& plan, const InstanceVolumes& v,
                   bool z_fail);
void set_colours(GLuint program, const FaceColours& colours);
// The same of a program for volumes that are looked at.
void use_volumes(const Frame& frame, const InstanceVolumes& v, GLuint program);
bool any(const std::array<IndexRange, kListKinds>& ranges, bool turned);
// What a way of counting draws of a batch, in a pass that is applied, after use_volumes() and
// set_colours(): z-fail the whole surface of the volumes, z-pass their sides, and light caps where
// they may be in front of the picture.
void draw_faces(const Frame& frame, const LightPlan& plan, const Batch& b, const Pass& pass,
                bool turned, const FaceColours& colours = {});
// Sides (`offset`: those that start in a grazed plane moved away), and caps: to be looked at.
void draw_sides(const Frame& frame, const Method& m,
                const std::array<IndexRange, kListKinds>& ranges, bool turned, bool offset);
void draw_caps(const Frame& frame, const std::array<IndexRange, kListKinds>& ranges, bool turned);
// What z-pass starts with: the count at the near plane. The pass says how it is counted.
void draw_near_start(const Frame& frame, const LightPlan& plan, const Batch& b, Pass pass,
                     float brightness);

}  // namespace gnomon::gl
