// A block of Vienna, straight from the whole millimetres of its file: no decimal fractions, no
// coordinate reference system, and no library that could cut polygons into other triangles from one
// version to the next.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "soup.h"

namespace gnomon::test {

// Lists of numbers within nested brackets: `text` from `at`, which is at the first bracket.
struct NumberList {
  std::vector<long> numbers;
  bool first = false;  // of its own list: a polygon's outer ring
};
inline std::vector<NumberList> number_lists(const std::string& text, std::size_t at) {
  std::vector<NumberList> lists;
  int depth = 0;
  do {
    const char c = text[at];
    if (c == '[') {
      lists.push_back({{}, at > 0 && text[at - 1] == '['});
      ++depth;
      ++at;
    } else if (c == ']') {
      --depth;
      ++at;
    } else if (c == ',') {
      ++at;
    } else {
      char* end = nullptr;
      lists.back().numbers.push_back(std::strtol(text.c_str() + at, &end, 10));
      at = static_cast<std::size_t>(end - text.c_str());
    }
  } while (depth > 0);
  std::erase_if(lists, [](const NumberList& l) { return l.numbers.empty(); });
  return lists;
}

// Every building with a corner in [x0, x1] x [y0, y1], metres in the file's own coordinates (the
// tile is 527 m by 614 m), on a level ground that does not cast. Solids' polygons are fans of their
// outer rings: where they are not convex not the city's faces, but still closed bodies.
inline Scene vienna_block(const std::string& file, double x0, double y0, double x1, double y1) {
  Scene s;
  s.surfaces.resize(2);
  s.surfaces[1].casts = false;
  std::ifstream in(file, std::ios::binary);
  for (std::string line; std::getline(in, line);) {
    const std::string key = "\"vertices\":";
    const std::size_t vertices = line.rfind(key);
    if (vertices == std::string::npos) continue;
    const auto base = static_cast<std::uint32_t>(s.mesh.positions.size());
    std::vector<Vec3> corners;
    bool inside = false;
    for (const NumberList& v : number_lists(line, vertices + key.size())) {
      const Vec3 p(static_cast<double>(v.numbers[0]) / 1000,
                   static_cast<double>(v.numbers[1]) / 1000,
                   static_cast<double>(v.numbers[2]) / 1000);
      inside = inside || (p.x >= x0 && p.x <= x1 && p.y >= y0 && p.y <= y1);
      corners.push_back(p);
    }
    if (!inside) continue;
    s.mesh.positions.insert(s.mesh.positions.end(), corners.begin(), corners.end());
    const std::string solid = "\"type\":\"Solid\",\"boundaries\":";
    for (std::size_t at = line.find(solid); at != std::string::npos; at = line.find(solid, at)) {
      at += solid.size();
      for (const NumberList& ring : number_lists(line, at)) {
        if (!ring.first) continue;
        const auto corner = [&](std::size_t k) {
          return base + static_cast<std::uint32_t>(ring.numbers[k]);
        };
        for (std::size_t k = 1; k + 1 < ring.numbers.size(); ++k) {
          s.mesh.triangles.push_back({corner(0), corner(k), corner(k + 1)});
          s.surface_of.push_back(0);
        }
      }
    }
  }
  add_quad(s.mesh, {x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0});
  s.surface_of.resize(s.mesh.triangles.size(), 1);
  weld(s.mesh, s.surface_of);
  return s;
}

}  // namespace gnomon::test
