// Failures of the system, made on purpose: files that may not grow, a user without rights.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

namespace gnomon::testing {

// While it lives, writing past `bytes` of any file fails with EFBIG, as it does with ENOSPC on a
// full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

// Root may write anywhere; while this lives, it is an ordinary user.
class WithoutRoot {
 public:
  WithoutRoot() : root_(::geteuid() == 0) {
    constexpr uid_t kNobody = 65534;
    if (root_) lowered_ = ::seteuid(kNobody) == 0;
  }
  ~WithoutRoot() {
    if (lowered_) restored_ = ::seteuid(0);
  }
  WithoutRoot(const WithoutRoot&) = delete;
  WithoutRoot& operator=(const WithoutRoot&) = delete;
  bool ordinary() const { return !root_ || lowered_; }

 private:
  bool root_, lowered_ = false;
  int restored_ = 0;
};

}  // namespace gnomon::testing
