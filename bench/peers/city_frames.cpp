#include "city_frames.h"

#include <fmt/format.h>

#include <algorithm>

namespace gnomon::bench {
namespace {

nlohmann::ordered_json to_json(const CityCheck& c) {
  return {{"samples", c.samples}, {"in_shadow", c.shadow}, {"wrong", c.wrong}};
}

std::vector<double> column(const FrameCase& c, double FrameTime::*part) {
  std::vector<double> out;
  for (const FrameTime& time : c.times) out.push_back(time.*part);
  return out;
}

}  // namespace

void add_options(CLI::App& app, FrameCommand& o) {
  app.add_option("--size", o.size, "Pixels across and down")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--rounds", o.rounds, "Turns of each case")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--frames", o.frames, "Frames timed in each turn")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--picture", o.picture, "Write the picture to this PNG");
  app.add_option("--picture-frame", o.picture_frame,
                 "Of the moving lamp's frames, the picture's (-1: the still lamp)")
      ->capture_default_str();
  app.add_option("--json", o.json, "Write all times to this file");
}

FrameTime FrameWatch::read() const {
  return {1000 * watch_.seconds(), 1000.0 * double(std::clock() - start_) / CLOCKS_PER_SEC};
}

void measure(std::vector<FrameCase>& cases, int rounds, int frames,
             const std::function<FrameTime(const Vec3&)>& frame) {
  constexpr int kWarmUp = 3;                       // frames at the beginning of each turn
  for (int round = -1; round < rounds; ++round) {  // round -1 warms up
    for (FrameCase& c : cases) {
      c.begin();
      for (int k = -kWarmUp; k < frames; ++k) {
        const FrameTime time = frame(c.lamp(round * frames + k));
        if (round >= 0 && k >= 0) c.times.push_back(time);
      }
    }
  }
}

std::string to_columns(const std::vector<FrameCase>& cases, const FrameChecks& checks) {
  std::string row;
  for (const FrameCase& c : cases) {
    const std::vector<double> ms = column(c, &FrameTime::ms);
    row +=
        fmt::format(" {:.1f} ({:.1f}; {:.1f}) |", median(ms),
                    *std::min_element(ms.begin(), ms.end()), median(column(c, &FrameTime::cpu_ms)));
  }
  return row + fmt::format(" {}, {}, {} of {} |", checks.kept.wrong, checks.still.wrong,
                           checks.moved.wrong, checks.still.samples);
}

void add_json(nlohmann::ordered_json& to, const std::vector<FrameCase>& cases,
              const FrameChecks& checks) {
  to["check"] = {{"still", to_json(checks.still)},
                 {"kept", to_json(checks.kept)},
                 {"moved", to_json(checks.moved)}};
  for (const FrameCase& c : cases) {
    to["ms"][c.name] = column(c, &FrameTime::ms);
    to["cpu_ms"][c.name] = column(c, &FrameTime::cpu_ms);
  }
}

}  // namespace gnomon::bench
