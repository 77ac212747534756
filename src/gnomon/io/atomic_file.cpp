#include <gnomon/io/atomic_file.h>

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

namespace gnomon {
namespace fs = std::filesystem;

namespace {

std::string_view what_to_do(int errno_value) {
  switch (errno_value) {
    case EACCES:
    case EPERM:
      return "choose another folder, or allow writing to this one";
    case EROFS:
      return "choose a folder on a disk that can be written";
    case ENOSPC:
    case EDQUOT:
      return "free some space, or choose a folder on another disk";
    case EFBIG:
      return "raise the limit on file sizes (ulimit -f), or choose larger pixels";
    case ENOENT:
      return "make the folder first";
    case ENOTDIR:
      return "a part of the path is a file; choose another folder";
    case EISDIR:
      return "a folder of that name is in the way; choose another name";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "choose another folder";
  }
}

// 0, or the errno of the failure. Closing is part of writing: a full disk may be reported only
// then.
int write_all(const fs::path& path, std::string_view content) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return errno;
  int failure = 0;
  if (!content.empty() && std::fwrite(content.data(), 1, content.size(), file) != content.size()) {
    failure = errno != 0 ? errno : EIO;
  }
  if (std::fclose(file) != 0 && failure == 0) failure = errno;
  return failure;
}

}  // namespace

Error file_error(std::string_view action, const fs::path& path, int errno_value) {
  return {fmt::format("Cannot {} {}: {}; {}.", action, path.string(),
                      std::generic_category().message(errno_value), what_to_do(errno_value))};
}

fs::path temporary_of(const fs::path& target) {
  fs::path temporary = target;
  temporary += fmt::format(".tmp-{}", ::getpid());
  return temporary;
}

AtomicFile::AtomicFile(fs::path target, fs::path temporary)
    : target_(std::move(target)), temporary_(std::move(temporary)) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)), temporary_(std::exchange(other.temporary_, {})) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this != &other) {
    discard();
    target_ = std::move(other.target_);
    temporary_ = std::exchange(other.temporary_, {});
  }
  return *this;
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() noexcept {
  if (temporary_.empty()) return;
  std::error_code ignored;  // nothing can be done about a temporary that cannot be removed
  fs::remove(temporary_, ignored);
  temporary_.clear();
}

Result<AtomicFile> AtomicFile::create(const fs::path& target) {
  std::error_code ignored;
  if (!target.has_filename() || fs::is_directory(target, ignored)) {
    return file_error("write", target, EISDIR);
  }
  fs::path temporary = temporary_of(target);
  if (const int failure = write_all(temporary, {}); failure != 0) {
    return file_error("write", target, failure);
  }
  return AtomicFile(target, std::move(temporary));
}

Result<FileWritten> AtomicFile::commit() {
  std::error_code failure;
  const std::uint64_t bytes = fs::file_size(temporary_, failure);
  if (!failure) fs::rename(temporary_, target_, failure);
  if (failure) return file_error("write", target_, failure.value());
  temporary_.clear();
  return FileWritten{target_, bytes};
}

Result<fs::path> make_output_folder(const fs::path& folder) {
  if (folder.empty()) {
    return Error{"Cannot make the output folder: its name is empty; give one with -o DIR."};
  }
  std::error_code failure;
  fs::create_directories(folder, failure);
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    // A file of that very name is reported by some libraries as "File exists", by others not at
    // all.
    const bool in_the_way = fs::exists(folder, ignored);
    return file_error("make the output folder", folder,
                      in_the_way || !failure ? ENOTDIR : failure.value());
  }
  // Only creating a file tells: permissions, read-only mounts and full disks alike.
  const fs::path probe = folder / fmt::format(".gnomon.tmp-{}", ::getpid());
  if (const int reason = write_all(probe, {}); reason != 0) {
    return file_error("write to the output folder", folder, reason);
  }
  fs::remove(probe, ignored);
  return folder;
}

Result<FileWritten> write_text_file(const fs::path& path, std::string_view text) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (const int failure = write_all(file.value().temporary(), text); failure != 0) {
    return file_error("write", path, failure);
  }
  return file.value().commit();
}

}  // namespace gnomon
