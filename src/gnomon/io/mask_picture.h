// mask.png: the shadow of one light as a map, with legend, scale, north arrow and where and when.
#pragma once

#include <filesystem>

#include <gnomon/core/result.h>
#include <gnomon/io/plan_picture.h>
#include <gnomon/view/shadow_mask.h>

namespace gnomon {

// The map alone: kLitColour to kShadowColour, kNoDataColour (picture_map.h) where there is no
// sample; as large as a map of hours (map_size()). Where many samples share a pixel, their mean.
inline constexpr Rgb kLitColour{252, 245, 228};
inline constexpr Rgb kShadowColour{82, 80, 116};
Picture draw_mask(const ShadowMask& mask, const PlanRelief& relief = {}, int threads = 0);

// The page around it, as plan.png has it. Preconditions: mask and view have the same size > 0;
// relief's vectors are empty or width * height long. Errors: as write_png.
Result<FileWritten> write_mask_picture(const std::filesystem::path& path, const ShadowMask& mask,
                                       const View& view, const Frame& frame,
                                       const PlanCaption& caption, const PlanRelief& relief = {},
                                       int threads = 0);

}  // namespace gnomon
