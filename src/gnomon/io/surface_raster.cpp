#include <gnomon/io/surface_raster.h>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <gnomon/core/place.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/raster_mesh.h>

namespace gnomon {
namespace {

// Bytes a triangle of a raster needs from here to the finished, welded scene, and bytes a cell
// needs while it is read: measured, docs/surface-models.md.
constexpr double kBytesPerTriangle = 160, kBytesPerCell = 60;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Error prefixed(const std::string& name, const Error& error) {
  return {name + ": " + error.message + (error.message.ends_with('.') ? "" : ".")};
}

double memory_of_machine() {
  return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<double>(::sysconf(_SC_PAGE_SIZE));
}

std::optional<Error> check_memory(const std::string& name, const RasterGrid& grid, double bytes) {
  const double have = memory_of_machine();
  if (bytes <= have) return {};
  constexpr double kGiga = 1 << 30;
  return Error{fmt::format(
      "{}: {} x {} cells as a mesh need about {:.1f} GiB, but the machine has {:.1f} GiB; take a "
      "part "
      "of it with 'gdal_translate -projwin WEST NORTH EAST SOUTH', or larger cells with "
      "'gdal_translate -r average -outsize 50% 50%'.",
      name, grid.columns, grid.rows, bytes / kGiga, have / kGiga)};
}

// From the CRS that a grid's coordinates are in to the one that is asked for.
struct Placement {
  std::string own, target;  // both empty: no CRS is known
  bool moved = false;       // the two differ
};

Result<std::string> choose_target(const RasterGrid& grid, const std::string& own) {
  const Vec2 middle = place_of(grid, grid.columns / 2.0, grid.rows / 2.0);
  if (is_geographic_crs(own)) {
    return utm_crs({middle.y * kDegree, middle.x * kDegree, 0});
  }
  const auto at = locate(own, {middle.x, middle.y, 0});
  if (!at) return at.error();
  return at.value().metres_per_unit == 1.0 ? own : utm_crs(at.value().place);
}

Result<Placement> place(const RasterGrid& grid, const std::string& target,
                        const std::string& fallback) {
  Placement p;
  p.own = short_crs(grid.crs.empty() ? fallback : grid.crs);
  if (p.own.empty()) return p;
  p.target = short_crs(target);
  if (p.target.empty()) {
    auto chosen = choose_target(grid, p.own);
    if (!chosen) return chosen.error();
    p.target = std::move(chosen).value();
  }
  if (p.own == p.target) return p;
  // Two names of one CRS (with and without heights, WKT) leave every point where it is.
  const std::vector<Vec2> corners = {place_of(grid, 0, 0), place_of(grid, grid.columns, 0),
                                     place_of(grid, 0, grid.rows),
                                     place_of(grid, grid.columns, grid.rows)};
  const auto there = reproject(p.own, p.target, corners);
  if (!there) return there.error();
  p.moved = there.value() != corners;
  return p;
}

// Points of the grid in the target CRS, less `origin`, which is subtracted before anything rounds
// where the grid is not moved: (i + shift, j + shift) for i < columns, j < rows, row-major.
Result<std::vector<Vec2>> places(const RasterGrid& grid, const Placement& at, const Vec2& origin,
                                 double shift, int columns, int rows) {
  std::vector<Vec2> points;
  points.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto& t = grid.transform;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double x = i + shift, y = j + shift;
      points.push_back(at.moved ? place_of(grid, x, y)
                                : Vec2(x * t[1] + y * t[2], x * t[4] + y * t[5]));
    }
  }
  if (!at.moved) return points;
  auto there = reproject(at.own, at.target, std::move(points));
  if (!there) return there;
  for (Vec2& p : there.value()) p -= origin;
  return there;
}

// Blocks on the ground in place of heights above it.
void stand_on_ground(RasterCells& cells, const std::vector<Vec2>& centres, const Vec2& origin,
                     const GroundAt& ground, const std::string& name, Warnings& warnings) {
  const int w = cells.columns, h = cells.rows;
  const auto index = [&](int i, int j) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(w) + static_cast<std::size_t>(i);
  };
  for (double& z : cells.top) {
    if (!(z > 0)) z = kNone;
  }
  // Asked once a cell and only around blocks. Infinity: not asked yet.
  std::vector<double> known(cells.top.size(), std::numeric_limits<double>::infinity());
  const auto ground_of = [&](int i, int j) {
    double& z = known[index(i, j)];
    if (std::isinf(z)) {
      const Vec2 p = centres[index(i, j)] + origin;
      z = ground ? ground(p.x, p.y).value_or(kNone) : kNone;
    }
    return z;
  };
  const auto lowest_around = [&](int i, int j, const auto& height) {
    double lowest = std::numeric_limits<double>::infinity();
    for (int y = std::max(0, j - 1); y <= std::min(h - 1, j + 1); ++y) {
      for (int x = std::max(0, i - 1); x <= std::min(w - 1, i + 1); ++x) {
        lowest = std::fmin(lowest, height(x, y));  // NaN does not count
      }
    }
    return lowest;
  };
  const auto each_block = [&](const auto& visit) {
    for (int j = 0; j < h; ++j) {
      for (int i = 0; i < w; ++i) {
        if (!std::isnan(cells.top[index(i, j)])) visit(i, j);
      }
    }
  };
  // What each block stands on, for all of them before any base: a base must lie below the tops of
  // the blocks around it too, also where their ground is not known.
  std::vector<double> below(cells.top.size(), kNone);
  std::size_t missing = 0;
  std::string first;
  each_block([&](int i, int j) {
    double z = ground_of(i, j);
    if (std::isnan(z)) {
      if (missing++ == 0) first = fmt::format("{}: column {}, row {}", name, i, j);
      z = lowest_around(i, j, ground_of);
      if (std::isinf(z)) z = 0;
    }
    below[index(i, j)] = z;
  });
  cells.base.assign(cells.top.size(), kNone);
  each_block([&](int i, int j) {
    const double blocks = lowest_around(i, j, [&](int x, int y) { return below[index(x, y)]; });
    cells.base[index(i, j)] = std::fmin(blocks, lowest_around(i, j, ground_of));
  });
  each_block([&](int i, int j) { cells.top[index(i, j)] += below[index(i, j)]; });
  warn(warnings,
       "Cells of heights above ground have no ground below them; the lowest ground beside them "
       "was taken, or 0 where there is none.",
       first, missing);
}

Model model_of(RasterTriangles mesh, const RasterGrid& grid, const std::string& name,
               const Vec2& origin, const RasterOptions& options) {
  Model m;
  m.report.path = name;
  m.report.format = grid.format;
  m.report.objects = 1;
  m.report.surfaces = mesh.corners.size() / 3;
  m.translate = {origin.x, origin.y, 0};
  m.vertices = std::move(mesh.vertices);
  m.corners = std::move(mesh.corners);
  const std::size_t triangles = m.report.surfaces;
  m.ring_begin.resize(triangles + 1);
  m.polygons.resize(triangles);
  for (std::uint32_t k = 0; k < triangles; ++k) {
    m.ring_begin[k + 1] = 3 * (k + 1);
    m.polygons[k] = {0, k, k + 1, k};
  }
  Surface surface;
  surface.object = std::filesystem::path(name).stem().string();
  surface.group = options.above_ground ? "HeightAboveGround" : "TINRelief";
  m.surfaces.push_back(std::move(surface));
  return m;
}

Result<RasterTriangles> mesh_of(const RasterCells& cells, const RasterOptions& options,
                                const std::vector<Vec2>& corners, const std::vector<Vec2>& centres,
                                const SizeCheck& check, std::uint64_t& unused) {
  if (options.mesh == RasterMesh::cells) return mesh_level_cells(cells, corners, check);
  if (options.above_ground) return mesh_sloped_cells(cells, corners, centres, check);
  return mesh_centres(cells, centres, check, unused);
}

}  // namespace

Result<Model> surface_of_grid(RasterGrid grid, const std::string& name,
                              const RasterOptions& options, const std::string& target_crs,
                              const std::string& fallback_crs, const GroundAt& ground) {
  const auto at = place(grid, target_crs, fallback_crs);
  if (!at) return prefixed(name, at.error());
  Vec2 origin = place_of(grid, 0, 0);
  if (at.value().moved) {
    const auto there = reproject(at.value().own, at.value().target, {origin});
    if (!there) return prefixed(name, there.error());
    origin = {std::floor(there.value()[0].x), std::floor(there.value()[0].y)};
  }
  Warnings warnings;
  const auto empty =
      std::count_if(grid.z.begin(), grid.z.end(), [](double z) { return std::isnan(z); });
  warn(warnings, "Cells without data are holes in the surface.", name,
       static_cast<std::size_t>(empty));

  std::vector<Vec2> corners, centres;
  if (options.mesh == RasterMesh::cells || options.above_ground) {
    auto found = places(grid, at.value(), origin, 0.0, grid.columns + 1, grid.rows + 1);
    if (!found) return prefixed(name, found.error());
    corners = std::move(found).value();
  }
  if (options.mesh == RasterMesh::triangles || options.above_ground) {
    auto found = places(grid, at.value(), origin, 0.5, grid.columns, grid.rows);
    if (!found) return prefixed(name, found.error());
    centres = std::move(found).value();
  }
  RasterCells cells{grid.columns, grid.rows, std::move(grid.z), {}};
  if (options.above_ground) stand_on_ground(cells, centres, origin, ground, name, warnings);

  const SizeCheck check = [&](std::uint64_t triangles) {
    return check_memory(name, grid, static_cast<double>(triangles) * kBytesPerTriangle);
  };
  std::uint64_t unused = 0;
  auto mesh = mesh_of(cells, options, corners, centres, check, unused);
  if (!mesh) {
    return mesh.error().message.starts_with(name) ? mesh.error() : prefixed(name, mesh.error());
  }
  warn(warnings,
       "Cells without two neighbours that touch each other got no triangle; read as cells, none is "
       "lost.",
       name, unused);
  if (mesh.value().corners.empty()) {
    return Error{fmt::format("{}: there is no surface in it: {}.", name,
                             options.above_ground ? "no cell is above 0"
                             : unused > 0 ? "no three cells with data touch, so read it as cells"
                                          : "no cell has data")};
  }
  Model model = model_of(std::move(mesh).value(), grid, name, origin, options);
  model.report.crs = at.value().target;
  if (at.value().moved) {
    model.report.placed =
        fmt::format("moved from {} to {}", crs_in_words(at.value().own), at.value().target);
  }
  model.warnings = std::move(warnings);
  return model;
}

Result<Model> read_surface_raster(const std::filesystem::path& path, const RasterOptions& options,
                                  const std::string& target_crs, const std::string& fallback_crs,
                                  const GroundAt& ground) {
  const std::string name = path.string();
  const auto check = [&](const RasterGrid& header) {
    // Terrain has two triangles a cell at least.
    const double cells = static_cast<double>(header.columns) * header.rows;
    return check_memory(
        name, header, cells * (kBytesPerCell + (options.above_ground ? 0 : 2 * kBytesPerTriangle)));
  };
  Warnings warnings;
  auto grid = read_raster_grid(path, fallback_crs, check, warnings);
  if (!grid) return grid.error();
  auto model =
      surface_of_grid(std::move(grid).value(), name, options, target_crs, fallback_crs, ground);
  if (model) append(model.value().warnings, warnings);
  return model;
}

}  // namespace gnomon
