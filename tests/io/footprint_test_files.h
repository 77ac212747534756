// GeoJSON files of footprints made for a test, and what their solids are like.
#pragma once

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored \
    "-Wrestrict"  // GCC 12 warns of "text" + std::string (its bug 105651)
#endif

#include <gnomon/io/footprint_layer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "io/write_test_files.h"

namespace gnomon {

using gnomon::testing::TestFolder;

inline const std::string kMetres =
    R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::31256"}},)";

// A ring as GeoJSON, closed, of points in EPSG:31256 relative to (1000, 340000), in Vienna.
inline std::string ring(const std::vector<Vec2>& points) {
  std::string out = "[";
  for (std::size_t k = 0; k <= points.size(); ++k) {
    const Vec2& p = points[k % points.size()];
    out += (k ? ",[" : "[") + std::to_string(1000 + p.x) + "," + std::to_string(340000 + p.y) + "]";
  }
  return out + "]";
}

inline std::string square(double x, double y, double side) {
  return ring({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}});
}

inline std::string feature(const std::string& properties, const std::string& geometry,
                           const std::string& id = "") {
  return R"({"type":"Feature",)" + (id.empty() ? "" : R"("id":")" + id + R"(",)") +
         R"("properties":{)" + properties + R"(},"geometry":)" + geometry + "}";
}

inline std::string polygon(const std::string& rings) {
  return R"({"type":"Polygon","coordinates":[)" + rings + "]}";
}

// A square building of 10 m; `x` where it stands.
inline std::string house(const std::string& properties, double x = 0, const std::string& id = "") {
  return feature(properties, polygon(square(x, 0, 10)), id);
}

inline std::string collection(const std::vector<std::string>& features) {
  std::string out = R"({"type":"FeatureCollection",)" + kMetres + R"("features":[)";
  for (std::size_t k = 0; k < features.size(); ++k) out += (k ? "," : "") + features[k];
  return out + "]}";
}

class FootprintLayer : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Result<Model> read(const std::string& text, const FootprintOptions& options = {},
                     const GroundAt& ground = {}) const {
    return read_footprints(write("town.geojson", text), options, "", "", ground);
  }
  Model model(const std::string& text, const FootprintOptions& options = {},
              const GroundAt& ground = {}) const {
    auto m = read(text, options, ground);
    EXPECT_TRUE(m) << (m ? "" : m.error().message);
    return m ? std::move(m).value() : Model{};
  }
  std::string refusal(const std::string& text, const FootprintOptions& options = {}) const {
    const auto m = read(text, options);
    EXPECT_FALSE(m);
    return m ? "" : m.error().message;
  }
  TestFolder folder_;
};

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// The warning whose sentence has `part`; count 0 if there is none.
inline Warning warning(const Model& m, const std::string& part) {
  for (const Warning& w : m.warnings) {
    if (has(w.what, part)) return w;
  }
  return {};
}

struct Span {
  double low = INFINITY, high = -INFINITY;
};
inline std::map<std::string, Span> heights(const Model& m) {
  std::map<std::string, Span> out;
  for (const ModelPolygon& p : m.polygons) {
    Span& s = out[m.surfaces[p.surface].object];
    for (auto c = m.ring_begin[p.first_ring]; c < m.ring_begin[p.last_ring]; ++c) {
      const double z = m.vertices[m.corners[c]].z;
      s = {std::min(s.low, z), std::max(s.high, z)};
    }
  }
  return out;
}

// Top of the only building.
inline double top(const Model& m) {
  const auto h = heights(m);
  return h.size() == 1 ? h.begin()->second.high : NAN;
}

// Each edge of the polygons runs as often one way as the other: closed, and wound alike.
inline bool watertight(const Model& m) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (std::size_t r = 0; r + 1 < m.ring_begin.size(); ++r) {
    const auto begin = m.ring_begin[r], n = m.ring_begin[r + 1] - begin;
    for (std::uint32_t k = 0; k < n; ++k) {
      const auto a = m.corners[begin + k], b = m.corners[begin + (k + 1) % n];
      if (a < b) ++balance[{a, b}];
      if (b < a) --balance[{b, a}];
    }
  }
  return !m.polygons.empty() &&
         std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

// By the divergence theorem over the rings' fans, positive if they are wound outwards.
inline double volume(const Model& m) {
  double six = 0;
  const Vec3 o = m.vertices[0];
  for (std::size_t r = 0; r + 1 < m.ring_begin.size(); ++r) {
    for (auto c = m.ring_begin[r] + 1; c + 1 < m.ring_begin[r + 1]; ++c) {
      const Vec3 a = m.vertices[m.corners[m.ring_begin[r]]] - o;
      const Vec3 b = m.vertices[m.corners[c]] - o, d = m.vertices[m.corners[c + 1]] - o;
      six += glm::dot(a, glm::cross(b, d));
    }
  }
  return six / 6;
}

inline std::size_t count(const Model& m, const std::string& semantic) {
  return static_cast<std::size_t>(std::count_if(
      m.polygons.begin(), m.polygons.end(),
      [&](const ModelPolygon& p) { return m.surfaces[p.surface].semantic == semantic; }));
}

}  // namespace gnomon
