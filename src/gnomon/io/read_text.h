// A text file in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <gnomon/core/result.h>

namespace gnomon {

// The whole file, without a UTF-8 byte order mark. Errors: no such file, a folder, unreadable,
// empty, UTF-16 (says to save it as UTF-8).
Result<std::string> read_text(const std::filesystem::path& path);

// The first `bytes` of the file, or all of it. Errors: no such file, a folder, unreadable, no bytes
// at all.
Result<std::string> read_start(const std::filesystem::path& path, std::size_t bytes);

// Line (from 1) of the byte at `offset`; lines end with LF, CR LF or CR.
std::size_t line_of(std::string_view text, std::size_t offset);

// `text` cut to `most` bytes, with ? for each control character and each byte that is not UTF-8:
// fit for a message, where quotes would disturb.
std::string printable(std::string_view text, std::size_t most);

// `text` cut to `most` bytes, without control characters and broken UTF-8, in quotes: fit for a
// message.
std::string in_quotes(std::string_view text, std::size_t most = 60);

}  // namespace gnomon
