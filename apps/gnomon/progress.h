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

}  // namespace gnomon::app
