#include <gnomon/gl/method_pairs.h>

#include <algorithm>

namespace gnomon::gl {
namespace {

// Mask and arithmetic are one kind: the stencil has other arithmetic than the others.
struct Keeping {
  MaskIn mask;
  StencilPasses passes;
  StencilOps ops;
  Arithmetic arithmetic;
};
constexpr Keeping kKeepings[] = {
    {MaskIn::stencil, StencilPasses::two_sided, StencilOps::wrap, Arithmetic::doubling},
    {MaskIn::stencil, StencilPasses::culled, StencilOps::wrap, Arithmetic::doubling},
    {MaskIn::stencil, StencilPasses::culled, StencilOps::saturate, Arithmetic::doubling},
    {MaskIn::alpha, StencilPasses::two_sided, StencilOps::wrap, Arithmetic::doubling},
    {MaskIn::alpha, StencilPasses::two_sided, StencilOps::wrap, Arithmetic::maximum},
    {MaskIn::screen, StencilPasses::two_sided, StencilOps::wrap, Arithmetic::doubling},
    {MaskIn::screen, StencilPasses::two_sided, StencilOps::wrap, Arithmetic::maximum}};
constexpr Count kCounts[] = {Count::automatic, Count::z_pass,  Count::z_fail,
                             Count::near_cap,  Count::zp_plus, Count::mixed};
constexpr VolumesOf kVolumes[] = {VolumesOf::caster, VolumesOf::polygon};
constexpr Extrusion kExtrusions[] = {Extrusion::shader, Extrusion::cpu, Extrusion::blend,
                                     Extrusion::blend_large};
constexpr Reach kReaches[] = {Reach::infinite, Reach::bounded};
constexpr Primitives kPrimitives[] = {Primitives::quads, Primitives::strips, Primitives::fans};
constexpr FarPlane kFarPlanes[] = {FarPlane::infinite, FarPlane::clamp};
constexpr Shadows kShadows[] = {Shadows::lights, Shadows::black, Shadows::attenuated};
constexpr double kScales[] = {1, 0.5, 0.25};

}  // namespace

MethodPairs::MethodPairs(const Situation& known, const Capabilities& capabilities, bool all)
    : capabilities_(capabilities), all_(all) {
  for (const bool along : {false, true}) {
    if (along && !(known.parallel_view && known.directional_light)) continue;
    for (const bool convex : {true, false}) {
      for (const bool near : {false, true}) {
        for (const int more : {0, 1, 2, 3}) {
          Situation s = known;
          s.light_along_view = along;
          s.all_convex = convex;
          s.near_shaded = near;
          s.can_bound = (more & 1) != 0;
          s.light_in_near_plane = (more & 2) != 0;
          situations_.push_back(s);
        }
      }
    }
  }
  const std::array<std::size_t, kKinds> sizes{
      std::size(kKeepings),   std::size(kCounts),     std::size(kVolumes),
      std::size(kExtrusions), std::size(kPrimitives), std::size(kFarPlanes),
      std::size(kShadows),    std::size(kScales),     std::size(kReaches)};
  Levels at{};
  for (;;) {
    Method m;
    const Keeping& keep = kKeepings[at[0]];
    m.mask = keep.mask;
    m.passes = keep.passes;
    m.ops = keep.ops;
    m.arithmetic = keep.arithmetic;
    m.count = kCounts[at[1]];
    m.volumes = kVolumes[at[2]];
    m.extrusion = kExtrusions[at[3]];
    m.primitives = kPrimitives[at[4]];
    m.far_plane = kFarPlanes[at[5]];
    m.shadows = kShadows[at[6]];
    m.mask_scale = kScales[at[7]];
    m.reach = kReaches[at[8]];
    left_.push_back({at, m});
    std::size_t k = 0;
    while (k < kKinds && ++at[k] == sizes[k]) at[k++] = 0;
    if (k == kKinds) break;
  }
  keep_supported();
}

bool MethodPairs::supported(const Method& method) const {
  return std::any_of(situations_.begin(), situations_.end(), [&](const Situation& s) {
    Situation each = s;
    // The camera goes with the method.
    each.infinite_view = s.infinite_view && method.far_plane == FarPlane::infinite;
    return bool(decide(method, each, capabilities_));
  });
}

int MethodPairs::new_pairs(const Levels& levels) const {
  int n = 0;
  for (std::size_t i = 0; i < kKinds; ++i)
    for (std::size_t j = i + 1; j < kKinds; ++j)
      n += covered_[((i * kLevels + levels[i]) * kKinds + j) * kLevels + levels[j]] ? 0 : 1;
  return n;
}

void MethodPairs::cover(const Levels& levels) {
  for (std::size_t i = 0; i < kKinds; ++i)
    for (std::size_t j = i + 1; j < kKinds; ++j)
      covered_[((i * kLevels + levels[i]) * kKinds + j) * kLevels + levels[j]] = true;
}

void MethodPairs::keep_supported() {
  std::erase_if(left_, [&](const Candidate& c) { return !supported(c.method); });
}

std::optional<Method> MethodPairs::next() {
  last_ = 0;
  if (!all_) {
    int most = 0;
    std::vector<Candidate> left;
    for (const Candidate& c : left_) {
      const int n = new_pairs(c.levels);
      if (n == 0) continue;
      if (n > most) last_ = left.size();
      most = std::max(most, n);
      left.push_back(c);
    }
    left_ = std::move(left);
  }
  if (left_.empty()) return {};
  return left_[last_].method;
}

void MethodPairs::drawn() {
  const Method& m = left_[last_].method;
  std::vector<Situation> fit;
  for (const Situation& s : situations_) {
    Situation each = s;
    each.infinite_view = s.infinite_view && m.far_plane == FarPlane::infinite;
    if (decide(m, each, capabilities_)) fit.push_back(s);
  }
  skipped();
  if (fit.empty() || fit.size() == situations_.size()) return;
  situations_ = std::move(fit);
  keep_supported();
}

bool MethodPairs::refused(const std::string& why) {
  const Method& m = left_[last_].method;
  std::vector<Situation> fit;
  for (const Situation& s : situations_) {
    Situation each = s;
    each.infinite_view = s.infinite_view && m.far_plane == FarPlane::infinite;
    const Result<Method> decided = decide(m, each, capabilities_);
    if (!decided && decided.error().message == why) fit.push_back(s);
  }
  const bool foreseen = !fit.empty();
  if (foreseen) {
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(last_));
    situations_ = std::move(fit);
    keep_supported();
  } else {
    skipped();
  }
  return foreseen;
}

void MethodPairs::skipped() {
  cover(left_[last_].levels);
  left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(last_));
}

}  // namespace gnomon::gl
