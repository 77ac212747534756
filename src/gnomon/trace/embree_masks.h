// Shadow masks by ray casting with Embree: the second oracle (single precision, so its differences
// are counted), and the peer of the benchmarks. Preparation (tree, ray origins) is apart from
// tracing, so that many lights over one view trace at full speed.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/receivers.h>

namespace gnomon {

struct EmbreeOptions {
  bool robust =
      true;  // Embree's robust scene flag: no ray slips between neighbouring triangles; slower
  int threads = 0;  // for the build; 0: all
};

// The casters of a scene as Embree sees them: float vertices, high-quality tree. Owns Embree's
// device and scene. The Scene need not outlive it.
class EmbreeScene {
 public:
  EmbreeScene(EmbreeScene&&) noexcept;
  EmbreeScene& operator=(EmbreeScene&&) noexcept;
  ~EmbreeScene();

  // Fails if Embree cannot be started or runs out of memory.
  static Result<EmbreeScene> build(const Scene& scene, const EmbreeOptions& options);

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  explicit EmbreeScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

inline constexpr int kRayBlock = 16;  // lanes of a block: 4x4 pixels, left to right, top to bottom

// Where the shadow rays of a view start: 4x4 pixels a block, coordinates in metres, scene
// coordinates.
struct RayOrigins {
  struct alignas(64) Block {
    float x[kRayBlock], y[kRayBlock], z[kRayBlock];
    std::uint32_t triangle[kRayBlock];  // kNoTriangle: no sample
  };
  int width = 0, height = 0;  // pixels
  int columns = 0, rows = 0;  // blocks
  std::vector<Block> blocks;  // row-major, columns * rows
  std::vector<Vec4> planes;   // per triangle of the scene: (n, d), n.x + d > 0 on the seen side
};

// Sample points computed in double from the plane of the triangle and the pixel's ray, moved `lift`
// metres along the ray towards the eye, then rounded to float.
RayOrigins ray_origins(const Scene& scene, const Receivers& receivers, double lift,
                       int threads = 0);

// One byte a pixel, row-major: 1 in shadow (the light is behind the receiver, or a caster is hit),
// else 0; pixels without a sample 0. Rays run from the origins (tnear 0) up to a point light,
// without end for a directional one. `packet`: rays per call, 8 or 16. `mask`: width * height
// bytes, overwritten. Precondition: light.w is 0 or 1.
void embree_mask(const EmbreeScene& casters, const RayOrigins& origins, const Light& light,
                 int packet, int threads, std::uint8_t* mask);
std::vector<std::uint8_t> embree_mask(const EmbreeScene& casters, const RayOrigins& origins,
                                      const Light& light, int packet = 8, int threads = 0);

}  // namespace gnomon
