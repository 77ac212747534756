#include "staging.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gnomon/io/atomic_file.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

#include "commands.h"
#include "signals.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;

// Between making a folder and locking it another run may take it for a dead one's.
constexpr int kAttempts = 100;

// Where the folder above is there, "no such file" means that no files can be made (/proc).
int refused(int reason) { return reason == ENOENT ? EPERM : reason; }

// Makes the folder and those above it; adds what was made to `made`, the outermost first.
void make_folders(const fs::path& folder, std::vector<fs::path>& made) {
  std::error_code ignored;
  if (fs::is_directory(folder, ignored)) return;
  const fs::path above = folder.has_filename() ? folder.parent_path() : fs::path();
  if (!above.empty()) make_folders(above, made);
  if (::mkdir(folder.c_str(), 0777) == 0) {
    made.push_back(folder);
  } else if (!fs::is_directory(folder, ignored)) {
    const int reason = errno == EEXIST ? ENOTDIR : refused(errno);
    throw Failure(file_error("make the output folder", folder, reason).message);
  }
}

bool is_locked(int descriptor, const fs::path& folder) {
  struct stat here {};
  struct stat there {};
  return ::fstat(descriptor, &here) == 0 && ::stat(folder.c_str(), &there) == 0 &&
         here.st_ino == there.st_ino && here.st_dev == there.st_dev;
}

// Removes what killed runs left: the unfinished folders that nobody holds locked. Where the file
// system knows no locks, all are left alone.
void remove_dead(const fs::path& output) {
  std::error_code ignored;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(output, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("unfinished-") && name.ends_with(".tmp")) found.push_back(entry.path());
  }
  for (const fs::path& folder : found) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_locked(descriptor, folder)) {
      fs::remove_all(folder, ignored);
    }
    ::close(descriptor);
  }
}

}  // namespace

Staging::Staging(const fs::path& output) : output_(output) {
  if (output.empty()) {
    throw Failure("Cannot make the output folder: its name is empty; give one with -o DIR.");
  }
  std::vector<fs::path> made;
  for (int attempt = 0; lock_ < 0; ++attempt) {
    const SignalsWait wait;  // so that every folder made is known to be removed
    try {
      make_folders(output_, made);
      remove_dead(output_);
      folder_ = output_ / (attempt == 0 ? fmt::format("unfinished-{}.tmp", getpid())
                                        : fmt::format("unfinished-{}-{}.tmp", getpid(), attempt));
      if (::mkdir(folder_.c_str(), 0777) != 0) {
        const int reason = errno;
        // Another run has removed the empty output folder; or a process with this number on another
        // machine is at work.
        if ((reason == ENOENT || reason == EEXIST) && attempt < kAttempts) continue;
        throw Failure(file_error("write to the output folder", output_, refused(reason)).message);
      }
    } catch (...) {
      remove_unfinished({{}, made});
      throw;
    }
    lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool locks = lock_ >= 0 && ::flock(lock_, LOCK_EX) == 0;
    if (locks && !is_locked(lock_, folder_) && attempt < kAttempts) {
      ::close(lock_);
      lock_ = -1;
      continue;
    }
    set_unfinished({{folder_}, made});
    if (lock_ < 0) break;  // no descriptors left: goes on without a lock
  }
}

Staging::~Staging() {
  const SignalsWait wait;
  clear_unfinished();
  if (lock_ >= 0) ::close(lock_);
}

fs::path Staging::path(const std::string& name) {
  const fs::path path = folder_ / name;
  if (path.parent_path() != folder_) take(make_output_folder(path.parent_path()));
  names_.push_back(name);
  return path;
}

void Staging::publish() {
  const SignalsWait wait;
  // What can fail does so before the first rename.
  for (const std::string& name : names_) {
    const fs::path target = output_ / name;
    if (target.parent_path() != output_) take(make_output_folder(target.parent_path()));
    std::error_code ignored;
    if (fs::is_directory(target, ignored))
      throw Failure(file_error("write", target, EISDIR).message);
  }
  for (const std::string& name : names_) {
    std::error_code error;
    fs::rename(folder_ / name, output_ / name, error);
    if (error) throw Failure(file_error("write", output_ / name, error.value()).message);
  }
  for (const std::string& name : obsolete_) {
    std::error_code ignored;
    fs::remove(output_ / name, ignored);
  }
  note_published();
}

std::string as_published(std::string message) {
  const std::string folder = fmt::format("unfinished-{}.tmp/", getpid());
  for (std::size_t at; (at = message.find(folder)) != std::string::npos;)
    message.erase(at, folder.size());
  return message;
}

}  // namespace gnomon::app
