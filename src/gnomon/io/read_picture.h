// Pictures on surfaces: bytes of PNG, JPEG, BMP and GIF files -> Texture.
#pragma once

#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/scene/appearance.h>

namespace gnomon {

// Grey, palette and 16-bit pictures too. The error is why not, without a file: for a warning.
Result<Texture> read_picture(std::string_view bytes, const std::string& name);

}  // namespace gnomon
