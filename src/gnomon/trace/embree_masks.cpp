#include <gnomon/trace/embree_masks.h>

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <glm/geometric.hpp>

#include <gnomon/core/exact.h>
#include <gnomon/core/parallel.h>

namespace gnomon {

struct EmbreeScene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

EmbreeScene::EmbreeScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;
EmbreeScene::~EmbreeScene() = default;

Result<EmbreeScene> EmbreeScene::build(const Scene& scene, const EmbreeOptions& options) {
  auto impl = std::make_unique<Impl>();
  const std::string config =
      options.threads > 0 ? "threads=" + std::to_string(options.threads) : std::string();
  impl->device = rtcNewDevice(config.c_str());
  if (!impl->device) {
    return Error{"Embree could not be started (error " +
                 std::to_string(rtcGetDeviceError(nullptr)) +
                 "); check that the embree package is installed for this processor"};
  }
  impl->scene = rtcNewScene(impl->device);
  rtcSetSceneBuildQuality(impl->scene, RTC_BUILD_QUALITY_HIGH);
  rtcSetSceneFlags(impl->scene, options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);

  const TriMesh& mesh = scene.mesh;
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) count += casts(scene, t) ? 1 : 0;
  if (count > 0) {
    RTCGeometry geometry = rtcNewGeometry(impl->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
    if (vertices && indices) {
      for (const Vec3& p : mesh.positions) {
        for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(p[k]);
      }
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!casts(scene, t)) continue;
        for (const std::uint32_t v : mesh.triangles[t]) *indices++ = v;
      }
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(impl->scene, geometry);
    }
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(impl->scene);
  if (const RTCError error = rtcGetDeviceError(impl->device); error != RTC_ERROR_NONE) {
    return Error{"Embree could not build its tree of " + std::to_string(count) +
                 " triangles (error " + std::to_string(error) +
                 (error == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory)" : ")")};
  }
  return EmbreeScene(std::move(impl));
}

RayOrigins ray_origins(const Scene& scene, const Receivers& receivers, double lift, int threads) {
  constexpr int kSide = 4;
  const View& view = receivers.view;
  const TriMesh& mesh = scene.mesh;
  RayOrigins out;
  out.width = view.width;
  out.height = view.height;
  out.columns = (view.width + kSide - 1) / kSide;
  out.rows = (view.height + kSide - 1) / kSide;
  out.blocks.resize(static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows));
  out.planes.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3& a = mesh.positions[mesh.triangles[t][0]];
    const Vec3 n = glm::cross(mesh.positions[mesh.triangles[t][1]] - a,
                              mesh.positions[mesh.triangles[t][2]] - a);
    const Vec3 e(view.eye);
    const double side = view.eye.w == 0 ? glm::dot(n, e) : glm::dot(n, e - a);
    const Vec3 towards = side < 0 ? -n : n;
    out.planes[t] = Vec4(towards, -glm::dot(towards, a));
  }
  const Vec3 parallel_step = is_parallel(view) ? glm::normalize(Vec3(view.eye)) * lift : Vec3(0.0);
  parallel_for(out.rows, threads, [&](int block_row) {
    for (int block_column = 0; block_column < out.columns; ++block_column) {
      RayOrigins::Block& b =
          out.blocks[static_cast<std::size_t>(block_row) * static_cast<std::size_t>(out.columns) +
                     static_cast<std::size_t>(block_column)];
      for (int lane = 0; lane < kRayBlock; ++lane) {
        const int column = block_column * kSide + lane % kSide,
                  row = block_row * kSide + lane / kSide;
        b.x[lane] = b.y[lane] = b.z[lane] = 0;
        b.triangle[lane] = kNoTriangle;
        if (column >= view.width || row >= view.height) continue;
        const std::uint32_t t =
            receivers
                .triangle[static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width) +
                          static_cast<std::size_t>(column)];
        if (t == kNoTriangle) continue;
        const Vec3 q(pixel_point(view, column, row)), e(view.eye), n(out.planes[t]);
        const Vec3& a = mesh.positions[mesh.triangles[t][0]];
        Vec3 p;
        if (is_parallel(view)) {
          p = q - e * (glm::dot(n, q - a) / glm::dot(n, e)) + parallel_step;
        } else {
          p = e + q * (glm::dot(n, a - e) / glm::dot(n, q));
          if (lift > 0) p -= q * (lift / glm::length(q));
        }
        b.x[lane] = static_cast<float>(p.x);
        b.y[lane] = static_cast<float>(p.y);
        b.z[lane] = static_cast<float>(p.z);
        b.triangle[lane] = t;
      }
    }
  });
  return out;
}

namespace {

// A packet of Lanes rays at once; Embree's names for the two widths that are used.
template <int Lanes>
struct Packet;
template <>
struct Packet<8> {
  using Ray = RTCRay8;
  static void trace(const int* valid, RTCScene scene, RTCIntersectContext* context, Ray* ray) {
    rtcOccluded8(valid, scene, context, ray);
  }
};
template <>
struct Packet<16> {
  using Ray = RTCRay16;
  static void trace(const int* valid, RTCScene scene, RTCIntersectContext* context, Ray* ray) {
    rtcOccluded16(valid, scene, context, ray);
  }
};

// Traces the lanes with `trace` set; sets dark[lane] where something is hit.
template <int Lanes>
void trace_block(RTCScene scene, const RayOrigins::Block& block, const Light& light,
                 const std::uint8_t* trace, std::uint8_t* dark) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const bool directional = light.w == 0;
  const float lx = static_cast<float>(light.x), ly = static_cast<float>(light.y),
              lz = static_cast<float>(light.z);
  const float end = directional ? std::numeric_limits<float>::infinity() : 1.0f;
  for (int first = 0; first < kRayBlock; first += Lanes) {
    typename Packet<Lanes>::Ray ray;
    alignas(64) int valid[Lanes];
    int any = 0;
    for (int k = 0; k < Lanes; ++k) {
      const int lane = first + k;
      valid[k] = trace[lane] ? -1 : 0;
      any |= valid[k];
      ray.org_x[k] = block.x[lane];
      ray.org_y[k] = block.y[lane];
      ray.org_z[k] = block.z[lane];
      ray.dir_x[k] = directional ? lx : lx - block.x[lane];
      ray.dir_y[k] = directional ? ly : ly - block.y[lane];
      ray.dir_z[k] = directional ? lz : lz - block.z[lane];
      ray.tnear[k] = 0.0f;
      ray.tfar[k] = end;
      ray.time[k] = 0.0f;
      ray.mask[k] = ~0u;
      ray.id[k] = 0;
      ray.flags[k] = 0;
    }
    if (any == 0) continue;
    Packet<Lanes>::trace(valid, scene, &context, &ray);
    for (int k = 0; k < Lanes; ++k) {
      if (valid[k] != 0 && ray.tfar[k] < 0)
        dark[first + k] = 1;  // Embree's sign of a hit: tfar = -infinity
    }
  }
}

}  // namespace

void embree_mask(const EmbreeScene& casters, const RayOrigins& origins, const Light& light,
                 int packet, int threads, std::uint8_t* mask) {
  constexpr int kSide = 4;
  const Light from = snapped(light);
  const RTCScene scene = casters.impl().scene;
  std::vector<std::uint8_t> faces(origins.planes.size());
  constexpr std::size_t kChunk = 16384;
  parallel_for(static_cast<int>((faces.size() + kChunk - 1) / kChunk), threads, [&](int c) {
    const std::size_t first = static_cast<std::size_t>(c) * kChunk;
    for (std::size_t t = first; t < std::min(faces.size(), first + kChunk); ++t) {
      faces[t] = glm::dot(origins.planes[t], from) > 0 ? 1 : 0;
    }
  });
  parallel_for(origins.rows, threads, [&](int block_row) {
    for (int block_column = 0; block_column < origins.columns; ++block_column) {
      const RayOrigins::Block& block =
          origins.blocks[static_cast<std::size_t>(block_row) *
                             static_cast<std::size_t>(origins.columns) +
                         static_cast<std::size_t>(block_column)];
      std::uint8_t dark[kRayBlock], trace[kRayBlock];
      for (int lane = 0; lane < kRayBlock; ++lane) {
        const std::uint32_t t = block.triangle[lane];
        const bool sample = t != kNoTriangle, lit = sample && faces[t] != 0;
        dark[lane] = sample && !lit ? 1 : 0;
        trace[lane] = lit ? 1 : 0;
      }
      if (packet == 16) {
        trace_block<16>(scene, block, from, trace, dark);
      } else {
        trace_block<8>(scene, block, from, trace, dark);
      }
      const int columns = std::min(kSide, origins.width - block_column * kSide);
      const int rows = std::min(kSide, origins.height - block_row * kSide);
      for (int r = 0; r < rows; ++r) {
        std::uint8_t* out = mask +
                            static_cast<std::size_t>(block_row * kSide + r) *
                                static_cast<std::size_t>(origins.width) +
                            static_cast<std::size_t>(block_column * kSide);
        std::memcpy(out, dark + r * kSide, static_cast<std::size_t>(columns));
      }
    }
  });
}

std::vector<std::uint8_t> embree_mask(const EmbreeScene& casters, const RayOrigins& origins,
                                      const Light& light, int packet, int threads) {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(origins.width) *
                                 static_cast<std::size_t>(origins.height));
  embree_mask(casters, origins, light, packet, threads, mask.data());
  return mask;
}

}  // namespace gnomon
