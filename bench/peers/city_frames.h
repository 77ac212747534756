// The frames that every contender draws and times, in turns, and how they are reported.
#pragma once

#include <CLI/CLI.hpp>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <gnomon/core/vec.h>

#include "../report.h"
#include "city_check.h"

namespace gnomon::bench {

// What every contender's command line has.
struct FrameCommand {
  int size = 512;  // pixels across and down
  int rounds = 4, frames = 25;
  std::string picture, json;  // files to write; empty: none
  int picture_frame = -1;     // of the moving lamp; -1: the still lamp
};
void add_options(CLI::App& app, FrameCommand& to);

struct FrameTime {
  double ms = 0;      // as the clock on the wall has it
  double cpu_ms = 0;  // of all threads of this program: a busy machine hardly changes it
};

// Starts when it is made.
class FrameWatch {
 public:
  FrameTime read() const;

 private:
  Watch watch_;
  std::clock_t start_ = std::clock();
};

struct FrameCase {
  std::string name;
  std::function<void()> begin;     // before its turn: what is to be drawn
  std::function<Vec3(int)> lamp;   // of the frame of this number, which may be negative
  std::vector<FrameTime> times{};  // of each frame that was timed
};

inline constexpr int kMovedFrame =
    7;  // of the moving lamp's frames, the one whose picture is checked

// Cases take turns of `frames` frames; before the first of `rounds` each has one to warm up.
// `frame` draws one under the lamp given and returns its milliseconds.
void measure(std::vector<FrameCase>& cases, int rounds, int frames,
             const std::function<FrameTime(const Vec3&)>& frame);

// Pictures of the three columns with shadows, against the exact mask.
struct FrameChecks {
  CityCheck kept, still, moved;
};

// The end of a table's row: milliseconds of each case, median (least; median of the processor's),
// then pixels that are wrong.
std::string to_columns(const std::vector<FrameCase>& cases, const FrameChecks& checks);
// Adds "check", "ms" and "cpu_ms".
void add_json(nlohmann::ordered_json& to, const std::vector<FrameCase>& cases,
              const FrameChecks& checks);

}  // namespace gnomon::bench
