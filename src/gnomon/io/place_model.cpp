#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/place_model.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

namespace gnomon {

namespace {

// Normals turn with the grid: by the difference of the meridian convergences in the model's middle.
// `before`: that middle in the CRS `from`; `after`: in `to`.
void turn_to_grid(Model& model, const std::string& from, const Vec3& before, const std::string& to,
                  const Vec3& after) {
  if (!model.looks || model.looks->normals.empty()) return;
  const auto a = locate(from, before), b = locate(to, after);
  if (a && b) turn_normals(model, b.value().true_north - a.value().true_north);
}

Vec3 middle_of(const std::optional<ModelBox>& box) {
  return box ? (box->low + box->high) / 2.0 : Vec3(0);
}

}  // namespace

std::optional<Error> move_to_crs(Model& model, const std::string& from, const std::string& to) {
  const Vec3 before = middle_of(box_of(model));
  std::vector<Vec2> flat;
  flat.reserve(model.vertices.size());
  for (const Vec3& v : model.vertices) {
    const Vec3 p = v * model.scale + model.translate;
    flat.push_back({p.x, p.y});
  }
  const auto moved = reproject(from, to, std::move(flat));
  if (!moved) return Error{model.report.path + ": " + moved.error().message};
  for (std::size_t k = 0; k < model.vertices.size(); ++k) {
    const double z = model.vertices[k].z * model.scale.z + model.translate.z;
    model.vertices[k] = Vec3(moved.value()[k].x, moved.value()[k].y, z);
  }
  model.scale = Vec3(1);
  model.translate = Vec3(0);
  turn_to_grid(model, from, before, to, middle_of(box_of(model)));
  return std::nullopt;
}

Result<SiteTurn> site_turn(const std::string& path, const Place& place, double north,
                           const std::string& crs) {
  const auto misplaced = [&](const Error& error) {
    return Error{fmt::format(
        "{}: its site, latitude {:.6f}, longitude {:.6f}, cannot be among the other files: {}; "
        "check whether the two are swapped, or give another one with --site {}=LAT,LON.",
        path, place.latitude / kDegree, place.longitude / kDegree, error.message,
        std::filesystem::path(path).filename().string())};
  };
  const auto at =
      reproject("OGC:CRS84", crs, {{place.longitude / kDegree, place.latitude / kDegree}});
  if (!at) return misplaced(at.error());
  const Vec2 p = at.value()[0];
  const auto grid = locate(crs, Vec3(p, 0));
  if (!grid) return misplaced(grid.error());
  return SiteTurn{p, grid.value().true_north - north};
}

GroundAt ground_from(const SiteTurn& at, const GroundAt& ground) {
  if (!ground) return {};
  return [at, ground, c = std::cos(at.turn), s = std::sin(at.turn)](double x, double y) {
    return ground(at.at.x + x * c + y * s, at.at.y + y * c - x * s);
  };
}

std::optional<Error> place_at_site(Model& model, const Site& site, double north,
                                   const std::string& crs, const GroundAt& ground) {
  const auto found = site_turn(model.report.path, site.place, north, crs);
  if (!found) return found.error();
  const auto [p, turn] = found.value();

  double height = site.place.height;
  const char* why = "as given";
  if (site.on_ground) {
    const auto below = ground ? ground(p.x, p.y) : std::nullopt;
    height = below.value_or(0.0);
    why = below ? "of the ground there" : "as none is known";
    if (!below) {
      warn(model.warnings,
           "No height is known where this model stands, so its origin is at height 0; give the "
           "height with --site LAT,LON,HEIGHT.",
           model.report.path);
    }
  }
  turn_normals(model, turn);
  const double c = std::cos(turn), s = std::sin(turn);
  for (Vec3& v : model.vertices) {
    const Vec3 m = v * model.scale + model.translate;
    v = Vec3(m.x * c + m.y * s, m.y * c - m.x * s, m.z);
  }
  model.scale = Vec3(1);
  model.translate = Vec3(p, height);
  model.report.placed = fmt::format(
      "local origin at {:.6f}, {:.6f} ({:.3f} east, {:.3f} north in {}), height {:.2f} m {}, "
      "turned by {:.3f} degrees {}",
      site.place.latitude / kDegree, site.place.longitude / kDegree, p.x, p.y, short_crs(crs),
      height, why, std::abs(turn) / kDegree, turn < 0 ? "anticlockwise" : "clockwise");
  return std::nullopt;
}

std::optional<ModelBox> box_of(const Model& model) {
  ModelBox box{Vec3(std::numeric_limits<double>::infinity()),
               Vec3(-std::numeric_limits<double>::infinity())};
  for (const std::uint32_t corner : model.corners) {
    const Vec3 p = model.vertices[corner] * model.scale + model.translate;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], p[k]);
      box.high[k] = std::max(box.high[k], p[k]);
    }
  }
  if (model.corners.empty()) return std::nullopt;
  return box;
}

}  // namespace gnomon
