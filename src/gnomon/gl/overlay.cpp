// What of the computation is drawn over a picture: volumes yellow, silhouette edges pink, counts as
// colours, wire frame, lights, the frustum of another camera ("Geometry of shadows in real time",
// Figures 5 to 7; Everitt and Kilgard 2002, Figures 2 to 5).
#include <array>

#include <glm/matrix.hpp>

#include <gnomon/gl/volume_batches.h>

namespace gnomon::gl {
namespace {

const glm::vec4 kVolumeColour(1.0f, 0.85f, 0.1f, 0.14f);
const glm::vec4 kSilhouetteColour(1.0f, 0.2f, 0.65f, 1.0f);
const glm::vec4 kEdgeColour(0.1f, 0.12f, 0.15f, 1.0f);
const glm::vec4 kFrustumColour(0.1f, 0.25f, 0.9f, 1.0f);
const glm::vec4 kLightColour(1.0f, 0.95f, 0.2f, 1.0f);
constexpr float kCross = 0.02f;  // half the length of a light's cross, in clip space

Pass line_pass(GLenum depth_func) {
  Pass p;
  p.depth_func = depth_func;
  p.depth_test = depth_func != GL_ALWAYS;
  p.colour = {true, true, true, false};
  return p;
}

// The picture's mask has made these volumes and counted them, unless there was none.
Prepared prepare_to_look(const Frame& frame, const LightPlan& plan) {
  const FrameStats before = *frame.stats;
  Prepared out = prepare(frame, plan);
  if (before.rebuilt + before.kept > 0) frame.stats->kept = before.kept;
  return out;
}

void draw_volume_faces(const Frame& frame, const LightPlan& plan, const Pass& pass,
                       const glm::vec4& colour) {
  Prepared prepared = prepare_to_look(frame, plan);
  for (InstanceVolumes& v : prepared.all) v.rectangles.clear();  // they are looked at as a whole
  apply(pass, frame);
  for (const std::vector<Batch>& batches : batches_of(frame, prepared)) {
    for (const Batch& b : batches) {
      GLuint program =
          frame.state->programs.volume[static_cast<std::size_t>(plan.method.extrusion)].id();
      use_volumes(frame, *b.of, program);
      if (const auto& inside = frame.camera->keep_inside) {
        program = frame.state->programs.volume_inside.id();
        glUseProgram(program);
        set(program, "u_clip", frame.clip_of(*b.of->instance));
        set(program, "u_project", b.of->plan->project);
        set(program, "u_inside", glm::mat4(*inside * b.of->instance->to_scene));
      }
      set(program, "u_front_colour", colour);
      set(program, "u_back_colour", colour);
      for (const bool turned : {false, true}) {
        draw_sides(frame, plan.method, b.ranges, turned, false);
        draw_caps(frame, b.ranges, turned);
      }
    }
  }
}

void draw_silhouettes(const Frame& frame, const LightPlan& plan, const Pass& pass,
                      const glm::vec4& colour) {
  const Prepared prepared = prepare_to_look(frame, plan);
  apply(pass, frame);
  const std::optional<glm::dmat4>& inside = frame.camera->keep_inside;
  const GLuint program =
      inside ? frame.state->programs.flat_inside.id() : frame.state->programs.flat.id();
  glUseProgram(program);
  set(program, "u_colour", colour);
  for (const InstanceVolumes& v : prepared.all) {
    std::vector<std::uint32_t> indices;
    for (const SilhouetteEdge& e : v.volumes->silhouettes.edges)
      indices.insert(indices.end(), {2 * e.a, 2 * e.b});
    set(program, "u_clip", frame.clip_of(*v.instance));
    if (inside) set(program, "u_inside", glm::mat4(*inside * v.instance->to_scene));
    draw_indexed(GL_LINES, v.mesh->doubled, indices);
  }
}

// Lines between vertices in clip space.
void draw_clip_lines(const Frame& frame, const std::vector<glm::vec4>& vertices,
                     const glm::vec4& colour, GLenum depth_func) {
  if (vertices.empty()) return;
  apply(line_pass(depth_func), frame);
  const GLuint program = frame.state->programs.plain.id();
  glUseProgram(program);
  set(program, "u_colour", colour);
  const VertexArray array = VertexArray::make();
  const Buffer buffer = Buffer::make();
  glBindVertexArray(array.id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(glm::vec4)),
               vertices.data(), GL_STREAM_DRAW);
  glEnableVertexAttribArray(kVertex);
  glVertexAttribPointer(kVertex, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glDrawArrays(GL_LINES, 0, static_cast<GLsizei>(vertices.size()));
  glBindVertexArray(0);
}

void draw_edges(const Frame& frame) {
  apply(line_pass(GL_ALWAYS), frame);
  const std::optional<glm::dmat4>& inside = frame.camera->keep_inside;
  const GLuint program =
      inside ? frame.state->programs.flat_inside.id() : frame.state->programs.flat.id();
  glUseProgram(program);
  set(program, "u_colour", kEdgeColour);
  for (const InstanceSlot& instance : frame.state->instances) {
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    const EdgeTable edges = build_edge_table(mesh.mesh);
    std::vector<std::uint32_t> indices;
    for (const auto& e : edges.vertices) indices.insert(indices.end(), {2 * e[0], 2 * e[1]});
    set(program, "u_clip", frame.clip_of(instance));
    if (inside) set(program, "u_inside", glm::mat4(*inside * instance.to_scene));
    draw_indexed(GL_LINES, mesh.doubled, indices);
  }
}

void draw_frustum(const Frame& frame, const Camera& other, GLenum depth_func) {
  // Corners of its clip space, the far ones perhaps at infinity (w = 0).
  const glm::dmat4 map = frame.camera->clip * glm::inverse(other.clip);
  std::array<glm::vec4, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[i] = glm::vec4(
        map * Vec4((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1, 1));
  }
  constexpr int kEdges[12][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}, {4, 5}, {5, 7},
                                 {7, 6}, {6, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  std::vector<glm::vec4> lines;
  for (const auto& e : kEdges) lines.insert(lines.end(), {corners[e[0]], corners[e[1]]});
  draw_clip_lines(frame, lines, kFrustumColour, depth_func);
}

void draw_light_marks(const Frame& frame, std::span<const LightSource> lights) {
  std::vector<glm::vec4> lines;
  const float aspect =
      static_cast<float>(frame.camera->height) / static_cast<float>(frame.camera->width);
  for (const LightSource& l : lights) {
    if (l.light.w == 0) continue;
    const glm::vec4 p(frame.camera->clip * (l.light / l.light.w));
    if (!(p.w > 0)) continue;
    for (const glm::vec2& d :
         {glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(0.7f, 0.7f), glm::vec2(0.7f, -0.7f)}) {
      const glm::vec4 arm(d.x * kCross * aspect * p.w, d.y * kCross * p.w, 0.0f, 0.0f);
      lines.insert(lines.end(), {p - arm, p + arm});
    }
  }
  draw_clip_lines(frame, lines, kLightColour, GL_ALWAYS);
}

// From blue over green and yellow to red.
glm::vec4 count_colour(int k, int most) {
  const float t = most <= 1 ? 0.0f : static_cast<float>(k - 1) / static_cast<float>(most - 1);
  const auto ramp = [](float x) { return glm::clamp(1.5f - glm::abs(x), 0.0f, 1.0f); };
  return {ramp(4 * t - 3), ramp(4 * t - 2), ramp(4 * t - 1), 1.0f};
}

Result<bool> draw_counts(const Frame& frame, const LightPlan& plan) {
  if (plan.method.mask != MaskIn::stencil)
    return Error{"Counts are in the stencil: take --method stencil to show them."};
  const Result<LitTest> lit = draw_light_mask(frame, plan, nullptr);
  if (!lit) return lit.error();
  constexpr int kMost = 8;         // the last colour is of so many and more
  Pass p = line_pass(GL_GREATER);  // from the far plane: where there is a surface
  p.stencil_test = true;
  p.stencil_func = GL_LEQUAL;  // the reference is at most the count
  for (int k = 1; k <= kMost; ++k) {
    p.stencil_ref = lit.value().ref + k;
    draw_rectangle(frame, p, count_colour(k, kMost), 1);
    ++frame.stats->other_rectangles;
  }
  return true;
}

}  // namespace

Result<bool> draw_overlay(const Frame& frame, std::span<const LightSource> lights,
                          std::span<const LightPlan> plans, const Overlay& o,
                          const Vec3& background) {
  if (o.edges) {
    Pass all = line_pass(GL_ALWAYS);
    draw_rectangle(frame, all, glm::vec4(glm::vec3(background), 1.0f));
    draw_edges(frame);
  }
  if (o.counts && !plans.empty()) {
    Result<bool> drawn = draw_counts(frame, plans.front());
    if (!drawn) return drawn.error();
  }
  if (o.volumes) {
    Pass p;
    p.depth_clamp = !plans.empty() && plans.front().method.far_plane == FarPlane::clamp;
    p.colour = {true, true, true, false};
    p.blend = true;
    p.source = GL_SRC_ALPHA;
    p.destination = GL_ONE_MINUS_SRC_ALPHA;
    if (o.edges) p.depth_test = false;
    for (const LightPlan& plan : plans) draw_volume_faces(frame, plan, p, kVolumeColour);
  }
  if (o.silhouettes) {
    for (const LightPlan& plan : plans)
      draw_silhouettes(frame, plan, line_pass(o.edges ? GL_ALWAYS : GL_LEQUAL), kSilhouetteColour);
  }
  if (o.frustum) draw_frustum(frame, *o.frustum, o.edges ? GL_ALWAYS : GL_LEQUAL);
  if (o.lights) draw_light_marks(frame, lights);
  return true;
}

}  // namespace gnomon::gl
