#include <fmt/format.h>
#include <gnomon/io/choose_animation.h>
#include <gnomon/io/key_frames.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

namespace gnomon {
namespace {

template <class T>
T at(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

// Offsets in the header, and sizes.
constexpr std::size_t kFrameSize = 16, kVertices = 24, kTriangles = 32, kFrames = 40,
                      kTrianglesAt = 52, kFramesAt = 56, kHeader = 68;
constexpr std::size_t kTriangle = 12, kFrameHead = 40, kVertex = 4;

std::string animation_of(std::string_view frame) {
  std::size_t digits = 0;
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  while (digits < frame.size() && digit(frame[frame.size() - 1 - digits])) ++digits;
  return std::string(frame.substr(0, frame.size() - std::min<std::size_t>(digits, 2)));
}

// As Assimp has them: in single precision.
std::vector<Vec3> read_points(std::string_view bytes, std::size_t frame, std::size_t vertices) {
  std::vector<Vec3> points;
  points.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    Vec3 p;
    for (std::size_t c = 0; c < 3; ++c) {
      const float scale = at<float>(bytes, frame + 4 * c),
                  move = at<float>(bytes, frame + 12 + 4 * c);
      const auto stored = at<std::uint8_t>(bytes, frame + kFrameHead + kVertex * v + c);
      float f = static_cast<float>(stored) * scale;
      f += move;
      p[static_cast<int>(c)] = double(f);
    }
    points.push_back(p);
  }
  return points;
}

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace

Result<KeyFrames> read_md2_frames(std::string_view bytes, const std::string& path) {
  const Error cut{fmt::format("{}: its frames cannot be read; it is cut off.", path)};
  if (bytes.size() < kHeader) return cut;
  const auto number = [&](std::size_t offset) {
    return std::size_t(at<std::uint32_t>(bytes, offset));
  };
  const std::size_t size = number(kFrameSize), vertices = number(kVertices),
                    triangles = number(kTriangles), frames = number(kFrames),
                    triangles_at = number(kTrianglesAt), frames_at = number(kFramesAt);
  if (frames == 0 || size < kFrameHead + kVertex * vertices || frames_at > bytes.size() ||
      frames > (bytes.size() - frames_at) / size || triangles_at > bytes.size() ||
      triangles > (bytes.size() - triangles_at) / kTriangle) {
    return cut;
  }
  KeyFrames out;
  for (std::size_t t = 0; t < triangles; ++t) {
    std::array<std::size_t, 3>& of = out.triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      of[c] = at<std::uint16_t>(bytes, triangles_at + kTriangle * t + 2 * c);
      if (of[c] >= vertices) return cut;
    }
  }
  std::string last;
  for (std::size_t f = 0; f < frames; ++f) {
    const std::size_t frame = frames_at + size * f;
    const std::string_view field = bytes.substr(frame + 24, 16);
    const std::string name = animation_of(field.substr(0, field.find('\0')));
    if (f == 0 || name != last) {
      out.names.push_back(name);
      out.first.push_back(f);
      out.clips.emplace_back().frames_per_second = kFramesPerSecond;
      last = name;
    }
    ++out.clips.back().frames;
    out.clips.back().duration = double(out.clips.back().frames) / kFramesPerSecond;
    out.points.push_back(read_points(bytes, frame, vertices));
  }
  out.names = animation_names(std::move(out.names));
  return out;
}

std::vector<RigShape> KeyFrames::shapes(std::size_t animation, bool normals) const {
  std::vector<RigShape> out;
  for (std::size_t f = 0; f < clips[animation].frames; ++f) {
    const std::vector<Vec3>& p = points[first[animation] + f];
    std::vector<Vec3> sum(p.size(), Vec3(0));
    for (const auto& t : triangles) {  // wound the other way than the format's
      const Vec3 n = cross(p[t[1]] - p[t[2]], p[t[0]] - p[t[2]]);
      for (const std::size_t v : t) sum[v] += n;
    }
    RigShape& shape = out.emplace_back();
    for (const auto& t : triangles) {
      for (const std::size_t v : t) {
        shape.points.push_back(p[v]);
        if (normals) shape.normals.push_back(sum[v]);
      }
    }
  }
  return out;
}

}  // namespace gnomon
