#include <gnomon/raster/screen_space.h>

#include <algorithm>
#include <cmath>

#include <gnomon/core/exact.h>
#include <gnomon/core/parallel.h>

namespace gnomon {

ScreenSpace screen_space(const View& view) {
  ScreenSpace s;
  s.width = view.width;
  s.height = view.height;
  const H4<Approx> basis[4] = {lift<Approx>(view.right), lift<Approx>(view.down),
                               lift<Approx>(view.origin), lift<Approx>(view.eye)};
  const Approx determinant = det4(basis[0], basis[1], basis[2], basis[3]);
  s.orientation = determinant.sign();
  for (int row = 0; row < 4; ++row) {
    for (int k = 0; k < 4; ++k) {  // Cramer's rule, one axis at a time
      H4<Approx> b[4] = {basis[0], basis[1], basis[2], basis[3]};
      Vec4 axis(0.0);
      axis[k] = 1.0;
      b[row] = lift<Approx>(axis);
      s.rows[row][k] = det4(b[0], b[1], b[2], b[3]) / determinant;
    }
  }
  return s;
}

ScreenPoint<double> project(const ScreenSpace& s, const Vec4& p) {
  const auto row = [&](int r) {
    return ((s.rows[r][0].value * p.x + s.rows[r][1].value * p.y) + s.rows[r][2].value * p.z) +
           s.rows[r][3].value * p.w;
  };
  return {row(0), row(1), row(2), row(3)};
}

ScreenPoint<Bound> project_bound(const ScreenSpace& s, const Vec4& largest) {
  const auto row = [&](int r) {
    const auto term = [&](int k) {
      return Bound(std::fabs(s.rows[r][k].value), s.rows[r][k].error) * Bound(largest[k]);
    };
    return ((term(0) + term(1)) + term(2)) + term(3);
  };
  return {row(0), row(1), row(2), row(3)};
}

ScreenPoints project_all(const ScreenSpace& s, std::span<const Vec3> positions, int threads) {
  ScreenPoints out;
  out.points.resize(positions.size());
  constexpr std::size_t kChunk = 4096;  // ten microseconds' worth
  std::vector<Vec4> largest_of((positions.size() + kChunk - 1) / kChunk, Vec4(0, 0, 0, 1));
  parallel_for(static_cast<int>(largest_of.size()), threads, [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * kChunk,
                      end = std::min(positions.size(), begin + kChunk);
    for (std::size_t i = begin; i < end; ++i) out.points[i] = project(s, point(positions[i]));
    Vec4 largest(0, 0, 0, 1);
    for (std::size_t i = begin; i < end; ++i) {
      for (int k = 0; k < 3; ++k) largest[k] = std::max(largest[k], std::fabs(positions[i][k]));
    }
    largest_of[static_cast<std::size_t>(c)] = largest;
  });
  Vec4 largest(0, 0, 0, 1);
  for (const Vec4& l : largest_of) {
    for (int k = 0; k < 3; ++k) largest[k] = std::max(largest[k], l[k]);
  }
  out.bound = project_bound(s, largest);
  return out;
}

}  // namespace gnomon
