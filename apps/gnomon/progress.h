// A progress bar on a terminal for work that takes more than a second.
#pragma once

#include <chrono>
#include <string>

namespace gnomon::app {

class ProgressBar {
 public:
  // Shows nothing where `quiet` or standard error is no terminal.
  ProgressBar(std::string what, bool quiet);
  ~ProgressBar();  // removes the bar
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double share);  // 0..1; one caller at a time

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool enabled_;
  bool shown_ = false;
  Clock::time_point begin_ = Clock::now(), last_ = begin_;
};

// On the terminal's last line: what is done now, in place of what was done before; removed at the
// end. Nothing where `quiet` or standard error is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& what) const;

 private:
  bool enabled_;
};

}  // namespace gnomon::app
