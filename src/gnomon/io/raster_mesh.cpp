// Notation: corner (i, j) of the grid has up to four cells around it, (i - 1 .. i, j - 1 .. j). On
// the upright line through it stand its levels: the heights at which the surface has a vertex
// there, sorted. A wall stands between two such lines, and its triangles use all levels of both
// that it covers.
#include <gnomon/io/raster_mesh.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

namespace gnomon {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kMostIndices = std::numeric_limits<std::uint32_t>::max();

Error too_many() {
  return {
      "it would have more vertices or triangles than can be numbered (2^32); take a part of it"};
}

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

// True where columns and rows run clockwise, as with row 0 in the north. `places`: width per row.
bool runs_clockwise(const std::vector<Vec2>& places, std::size_t width) {
  const Vec2& o = places[0];
  return cross(places[1] - o, places[width] - o) < 0;
}

struct Counter {
  std::uint64_t triangles = 0;
  void operator()(std::size_t, std::size_t, std::size_t) { ++triangles; }
};

struct Writer {
  std::vector<std::uint32_t>& corners;
  bool flip;
  void operator()(std::size_t a, std::size_t b, std::size_t c) {
    if (flip) std::swap(b, c);
    for (const std::size_t v : {a, b, c}) corners.push_back(static_cast<std::uint32_t>(v));
  }
};

// Tops and levels of all corners, for level and for sloped cells.
class Columns {
 public:
  Columns(const RasterCells& cells, bool sloped) : cells_(cells), sloped_(sloped) {
    const std::size_t n = (width() + 1) * (static_cast<std::size_t>(cells.rows) + 1);
    first_.reserve(n + 1);
    for (int pass = 0; pass < 2; ++pass) {  // counted, then written: no memory is taken twice
      std::uint64_t count = 0;
      for (int j = 0; j <= cells.rows; ++j) {
        for (int i = 0; i <= cells.columns; ++i) {
          const Levels at = levels_at(i, j);
          if (pass == 0) first_.push_back(static_cast<std::uint32_t>(count));
          if (pass == 1) levels_.insert(levels_.end(), at.z.begin(), at.z.begin() + at.size);
          count += at.size;
        }
      }
      if (count > kMostIndices) {
        too_many_ = true;
        return;
      }
      if (pass == 0) first_.push_back(static_cast<std::uint32_t>(count));
      if (pass == 0) levels_.reserve(count);
    }
  }

  bool too_many() const { return too_many_; }
  std::size_t width() const { return static_cast<std::size_t>(cells_.columns); }
  std::size_t corner(int i, int j) const {
    return static_cast<std::size_t>(j) * (width() + 1) + static_cast<std::size_t>(i);
  }
  const std::vector<double>& levels() const { return levels_; }
  std::uint32_t first(std::size_t corner) const { return first_[corner]; }

  // Index of the vertex of that height on the line through a corner. Precondition: it is there.
  std::size_t vertex(std::size_t corner, double z) const {
    std::size_t k = first_[corner];
    while (levels_[k] != z) ++k;
    assert(k < first_[corner + 1]);
    return k;
  }

  bool has(int i, int j) const { return !std::isnan(top(i, j)); }
  // NaN outside of the grid too.
  double top(int i, int j) const {
    if (i < 0 || j < 0 || i >= cells_.columns || j >= cells_.rows) return kNone;
    return cells_.top[static_cast<std::size_t>(j) * width() + static_cast<std::size_t>(i)];
  }
  double base(int i, int j) const {
    return cells_.base[static_cast<std::size_t>(j) * width() + static_cast<std::size_t>(i)];
  }

  // Height of the top of cell (i, j) at corner (ci, cj).
  double top_at(int i, int j, int ci, int cj) const {
    if (!sloped_) return top(i, j);
    double sum = 0, least = std::numeric_limits<double>::infinity(), most = -least;
    int n = 0;
    for (int y = cj - 1; y <= cj; ++y) {
      for (int x = ci - 1; x <= ci; ++x) {
        const double z = top(x, y);
        if (std::isnan(z)) continue;
        sum += z;
        least = std::min(least, z);
        most = std::max(most, z);
        ++n;
      }
    }
    return std::clamp(sum / n, least, most);  // rounding must not lift level cells
  }

 private:
  // Heights of up to four cells, top and base each; sorted, each once.
  struct Levels {
    std::array<double, 8> z{};
    std::size_t size = 0;

    void add(double height) {
      std::size_t at = 0;
      while (at < size && z[at] < height) ++at;
      if (at < size && z[at] == height) return;
      for (std::size_t k = size++; k > at; --k) z[k] = z[k - 1];
      z[at] = height;
    }
  };

  Levels levels_at(int i, int j) const {
    Levels at;
    for (int y = j - 1; y <= j; ++y) {
      for (int x = i - 1; x <= i; ++x) {
        if (!has(x, y)) continue;
        at.add(top_at(x, y, i, j));
        const bool exposed = !has(x == i ? x - 1 : x + 1, y) || !has(x, y == j ? y - 1 : y + 1);
        if (exposed && !cells_.base.empty()) at.add(base(x, y));
      }
    }
    return at;
  }

  const RasterCells& cells_;
  bool sloped_;
  bool too_many_ = false;
  std::vector<std::uint32_t> first_;  // per corner, and the end
  std::vector<double> levels_;
};

// The wall between the lines through corners a and b, the higher cell to the left of the way from a
// to b: from `low` up to that cell's top, which is top_a and top_b there.
template <class Sink>
void add_wall(const Columns& columns, std::size_t a, std::size_t b, double low, double top_a,
              double top_b, Sink& sink) {
  std::size_t left = columns.vertex(a, low), right = columns.vertex(b, low);
  const std::size_t left_end = columns.vertex(a, top_a), right_end = columns.vertex(b, top_b);
  const std::vector<double>& z = columns.levels();
  while (left < left_end || right < right_end) {
    if (right < right_end && (left == left_end || z[right + 1] <= z[left + 1])) {
      sink(left, right, right + 1);
      ++right;
    } else {
      sink(left, right, left + 1);
      ++left;
    }
  }
}

// All triangles, as if columns and rows ran counter-clockwise.
template <class Sink>
void each_triangle(const RasterCells& cells, const Columns& columns, bool sloped, Sink& sink) {
  std::size_t middle = columns.levels().size();  // vertices in the middle of sloped cells come last
  for (int j = 0; j < cells.rows; ++j) {
    for (int i = 0; i < cells.columns; ++i) {
      if (!columns.has(i, j)) continue;
      const std::array<std::array<int, 2>, 4> at = {
          {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
      std::array<std::size_t, 4> corner{}, top{};
      std::array<double, 4> z{};
      for (std::size_t k = 0; k < 4; ++k) {
        corner[k] = columns.corner(at[k][0], at[k][1]);
        z[k] = columns.top_at(i, j, at[k][0], at[k][1]);
        top[k] = columns.vertex(corner[k], z[k]);
      }
      if (sloped) {
        for (std::size_t k = 0; k < 4; ++k) sink(top[k], top[(k + 1) % 4], middle);
        ++middle;
      } else {
        sink(top[0], top[1], top[2]);
        sink(top[0], top[2], top[3]);
      }
      const std::array<std::array<int, 2>, 4> beside = {
          {{i, j - 1}, {i + 1, j}, {i, j + 1}, {i - 1, j}}};
      for (std::size_t k = 0; k < 4; ++k) {
        const double neighbour = columns.top(beside[k][0], beside[k][1]);
        const std::size_t next = (k + 1) % 4;
        if (std::isnan(neighbour)) {
          if (cells.base.empty()) continue;
          add_wall(columns, corner[k], corner[next], columns.base(i, j), z[k], z[next], sink);
        } else if (!sloped && neighbour < z[k]) {
          add_wall(columns, corner[k], corner[next], neighbour, z[k], z[next], sink);
        }
      }
    }
  }
}

Result<RasterTriangles> mesh_cells(const RasterCells& cells, const std::vector<Vec2>& corners,
                                   const std::vector<Vec2>* centres, const SizeCheck& check) {
  assert(corners.size() ==
         static_cast<std::size_t>(cells.columns + 1) * static_cast<std::size_t>(cells.rows + 1));
  const bool sloped = centres != nullptr;
  const Columns columns(cells, sloped);
  if (columns.too_many()) return too_many();
  Counter counter;
  each_triangle(cells, columns, sloped, counter);
  if (auto error = check(counter.triangles)) return *error;
  if (counter.triangles > kMostIndices / 3) return too_many();

  RasterTriangles out;
  out.vertices.reserve(columns.levels().size());
  for (std::size_t c = 0; c < corners.size(); ++c) {
    for (std::size_t k = columns.first(c); k < columns.first(c + 1); ++k) {
      out.vertices.emplace_back(corners[c].x, corners[c].y, columns.levels()[k]);
    }
  }
  if (sloped) {
    for (std::size_t k = 0; k < cells.top.size(); ++k) {
      if (std::isnan(cells.top[k])) continue;
      out.vertices.emplace_back((*centres)[k].x, (*centres)[k].y, cells.top[k]);
    }
    if (out.vertices.size() > kMostIndices) return too_many();
  }
  out.corners.reserve(counter.triangles * 3);
  Writer writer{out.corners, runs_clockwise(corners, columns.width() + 1)};
  each_triangle(cells, columns, sloped, writer);
  return out;
}

// Triangles between the middles of cells, as if columns and rows ran counter-clockwise.
template <class Sink>
void each_between(const RasterCells& cells, Sink& sink) {
  const auto w = static_cast<std::size_t>(cells.columns), h = static_cast<std::size_t>(cells.rows);
  const auto has = [&](std::size_t k) { return !std::isnan(cells.top[k]); };
  for (std::size_t j = 0; j + 1 < h; ++j) {
    for (std::size_t i = 0; i + 1 < w; ++i) {
      const std::size_t a = j * w + i, b = a + 1, c = b + w, d = a + w;
      const std::array<std::size_t, 4> around = {a, b, c, d};
      const auto missing = 4 - std::count_if(around.begin(), around.end(), has);
      if (missing > 1) continue;
      if (missing == 1) {
        std::array<std::size_t, 3> t{};
        std::copy_if(around.begin(), around.end(), t.begin(), has);
        sink(t[0], t[1], t[2]);
      } else if (std::fabs(cells.top[b] - cells.top[d]) < std::fabs(cells.top[a] - cells.top[c])) {
        sink(a, b, d);
        sink(b, c, d);
      } else {
        sink(a, b, c);
        sink(a, c, d);
      }
    }
  }
}

}  // namespace

Result<RasterTriangles> mesh_level_cells(const RasterCells& cells, const std::vector<Vec2>& corners,
                                         const SizeCheck& check) {
  return mesh_cells(cells, corners, nullptr, check);
}

Result<RasterTriangles> mesh_sloped_cells(const RasterCells& cells,
                                          const std::vector<Vec2>& corners,
                                          const std::vector<Vec2>& centres,
                                          const SizeCheck& check) {
  return mesh_cells(cells, corners, &centres, check);
}

Result<RasterTriangles> mesh_centres(const RasterCells& cells, const std::vector<Vec2>& centres,
                                     const SizeCheck& check, std::uint64_t& unused) {
  assert(centres.size() == cells.top.size());
  Counter counter;
  each_between(cells, counter);
  if (auto error = check(counter.triangles)) return *error;
  if (counter.triangles > kMostIndices / 3 || centres.size() > kMostIndices) return too_many();
  RasterTriangles out;
  unused = 0;
  if (counter.triangles == 0) {
    for (const double z : cells.top) unused += std::isnan(z) ? 0 : 1;
    return out;
  }
  out.corners.reserve(counter.triangles * 3);
  Writer writer{out.corners, runs_clockwise(centres, static_cast<std::size_t>(cells.columns))};
  each_between(cells, writer);

  // Vertices that some triangle uses, numbered in order.
  constexpr std::uint32_t kUnused = 0xffffffffu, kUsed = 0;
  std::vector<std::uint32_t> number(centres.size(), kUnused);
  for (const std::uint32_t k : out.corners) number[k] = kUsed;
  for (std::size_t k = 0; k < number.size(); ++k) {
    if (number[k] == kUnused) {
      unused += std::isnan(cells.top[k]) ? 0 : 1;
      continue;
    }
    number[k] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.emplace_back(centres[k].x, centres[k].y, cells.top[k]);
  }
  for (std::uint32_t& k : out.corners) k = number[k];
  return out;
}

}  // namespace gnomon
