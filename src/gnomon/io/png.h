// PNG files, fast.
// Based on: W3C, Portable Network Graphics (PNG) Specification, second edition, 2003.
#pragma once

#include <filesystem>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/picture.h>

namespace gnomon {

// 8-bit RGB, sRGB chunk, one IDAT. `level`: DEFLATE level 1 (fast) .. 12 (small). Rows are filtered
// on `threads` threads (0: as many as the machine has); the bytes do not depend on their number.
// Precondition: width, height > 0. Errors: out of memory, or more than 2 GiB packed.
Result<std::string> encode_png(const Picture& picture, int level = 3, int threads = 0);

// Atomically. Errors: as encode_png and AtomicFile.
Result<FileWritten> write_png(const std::filesystem::path& path, const Picture& picture,
                              int threads = 0);

}  // namespace gnomon
