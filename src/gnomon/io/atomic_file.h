// Files that appear by rename when they are whole: nobody ever reads half a result, and a failed
// run leaves the results of the run before it as they were.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <gnomon/core/result.h>

namespace gnomon {

struct FileWritten {
  std::filesystem::path path;
  std::uint64_t bytes = 0;
};

// Owns a temporary file `<name>.tmp-<pid>` beside its target; removes it unless commit() succeeds.
// Whoever writes the content does so through temporary() and has closed it before commit().
class AtomicFile {
 public:
  // Creates the empty temporary. Errors: folder missing or not a folder, target is a folder, no
  // permission, disk full.
  static Result<AtomicFile> create(const std::filesystem::path& target);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  // Renames the temporary to the target, replacing an older file. Call once. Not synced to disk:
  // what is promised is that other processes see the whole file or none, not that it outlives a
  // power cut.
  Result<FileWritten> commit();

 private:
  AtomicFile(std::filesystem::path target, std::filesystem::path temporary);
  void discard() noexcept;
  std::filesystem::path target_;
  std::filesystem::path temporary_;  // empty: nothing to remove
};

// The name of the temporary that create() makes for a target.
std::filesystem::path temporary_of(const std::filesystem::path& target);

// Makes the folder and those above it where missing, and makes sure that files can be created in
// it. Returns the path as given. Errors: something in the way that is not a folder, no permission,
// read-only or full disk.
Result<std::filesystem::path> make_output_folder(const std::filesystem::path& folder);

// The whole content at once, atomically; an older file is replaced.
Result<FileWritten> write_text_file(const std::filesystem::path& path, std::string_view text);

// "Cannot <action> <path>: <reason>; <what to do>." for an errno value: one wording for all
// writers.
Error file_error(std::string_view action, const std::filesystem::path& path, int errno_value);

}  // namespace gnomon
