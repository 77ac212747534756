#include "progress.h"

#include <unistd.h>

#include <fmt/format.h>
#include <cstdio>

namespace gnomon::app {
namespace {

constexpr auto kPatience = std::chrono::seconds(1);         // shorter work shows no bar
constexpr auto kInterval = std::chrono::milliseconds(100);  // between two drawings
constexpr int kCells = 30;                                  // characters of the bar

}  // namespace

ProgressLine::ProgressLine(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (enabled_) fmt::print(stderr, "\r\x1b[K");
}

void ProgressLine::show(const std::string& what) const {
  if (!enabled_) return;
  fmt::print(stderr, "\r\x1b[K{} ...", what);
  std::fflush(stderr);
}

ProgressBar::ProgressBar(std::string what, bool quiet)
    : what_(std::move(what)), enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
}

void ProgressBar::show(double share) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now - begin_ < kPatience || now - last_ < kInterval) return;
  last_ = now;
  shown_ = true;
  const int filled = static_cast<int>(share * kCells);
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3.0f} %", what_, "", filled, "", kCells - filled,
             100 * share);
  std::fflush(stderr);
}

}  // namespace gnomon::app
