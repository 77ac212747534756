#include <gnomon/io/file_place.h>

#include <algorithm>

#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/place_model.h>

namespace gnomon {
namespace {

// A CRS in which a scene can be: the one given, or for maps in degrees the UTM zone of the point.
// Other models have one unit for all three axes, which cannot be degrees.
Result<std::string> projected(const std::string& crs, const SceneFile& f, const Vec3& at) {
  if (!is_georeferenced(f.format) || !is_geographic_crs(crs)) return crs;
  return utm_crs(Place{at.y * kDegree, at.x * kDegree, 0});
}

// What rasters and footprints make of their CRS is known once they are read; the first surface
// model is placed before anything needs to know.
Result<std::string> crs_of_first_map(const std::vector<SceneFile>& files,
                                     const LoadOptions& options) {
  for (const SceneFile& f : files) {
    if (is_read_first(f) || crs_of(f, true).empty()) continue;
    if (rank_of(f, true, true) == kKnown) return std::string();
  }
  for (const SceneFile& f : files) {
    if (is_read_first(f) || crs_of(f, true).empty()) continue;
    const auto model = read_model(f, options, "", {});
    if (!model) return model.error();
    return model.value().report.crs;
  }
  return std::string();
}

}  // namespace

bool is_read_first(const SceneFile& f) {
  return f.format != FileFormat::footprints && f.format != FileFormat::raster;
}

std::optional<Site> site_of(const SceneFile& f) {
  if (f.told.site) return f.told.site;
  if (f.model && f.model->site) return Site(*f.model->site);
  return std::nullopt;
}

std::optional<double> north_of(const SceneFile& f) {
  if (f.told.north || !f.model) return f.told.north;
  return f.model->north;
}

std::string crs_of(const SceneFile& f, bool others_georeferenced) {
  if (!f.named_crs.empty()) return f.named_crs;
  if (f.crs_of_its_own) return short_crs(f.told.crs);
  if (f.site_of_its_own) return "";
  if (!is_georeferenced(f.format) && site_of(f) && others_georeferenced) return "";
  return short_crs(f.told.crs);
}

bool has_georeferenced(const std::vector<SceneFile>& files) {
  return std::any_of(files.begin(), files.end(), [](const SceneFile& f) {
    return !f.named_crs.empty() || f.crs_of_its_own ||
           (is_georeferenced(f.format) && !crs_of(f, true).empty());
  });
}

Result<std::string> scene_crs(const std::vector<SceneFile>& files, const LoadOptions& options) {
  const bool georeferenced = has_georeferenced(files);
  for (const SceneFile& f : files) {
    if (!is_read_first(f)) continue;
    const std::string crs = crs_of(f, georeferenced);
    if (crs.empty()) continue;
    const auto box = box_of(*f.model);
    return projected(crs, f, box ? (box->low + box->high) / 2.0 : Vec3(0));
  }
  if (georeferenced) return crs_of_first_map(files, options);
  std::optional<Site> site;
  std::optional<double> north;
  for (const SceneFile& f : files) {
    const auto here = site_of(f);
    if (!here) continue;
    const double turned = north_of(f).value_or(0);
    if (site && (here->place.latitude != site->place.latitude ||
                 here->place.longitude != site->place.longitude || turned != *north)) {
      return utm_crs(site->place);
    }
    if (!site) site = here, north = turned;
  }
  return std::string();
}

int rank_of(const SceneFile& f, bool others_georeferenced, bool in_crs) {
  if (f.above_ground) return kAboveGround;
  if (f.format == FileFormat::footprints) return kFootprints;
  if (!crs_of(f, others_georeferenced).empty()) return kKnown;
  const auto site = site_of(f);
  if (!site || !in_crs) return kKnown;
  return site->on_ground && !is_georeferenced(f.format) ? kOnGround : kAtSite;
}

std::optional<Error> check_told_place(const SceneFile& f, bool others_georeferenced, bool in_crs) {
  const std::string path = f.path.string();
  const std::string own = crs_of(f, others_georeferenced);
  if (!own.empty() && f.site_of_its_own) {
    return Error{fmt::format(
        "{}: its coordinates are in {}, so that it cannot stand at a site as well; leave out its "
        "--site.",
        path, own)};
  }
  if (!own.empty() && f.north_of_its_own) {
    return Error{fmt::format(
        "{}: its coordinates are in {}, which says where north is; leave out its --north.", path,
        own)};
  }
  if (!f.named_crs.empty() && f.crs_of_its_own && short_crs(f.told.crs) != f.named_crs) {
    const auto box = f.model ? box_of(*f.model) : std::nullopt;
    if (!box || !agree(f.told.crs, f.named_crs, (box->low + box->high) / 2.0)) {
      return Error{
          fmt::format("{}: it says that its CRS is {}, but its --crs says {}; leave out "
                      "its --crs.",
                      path, f.named_crs, short_crs(f.told.crs))};
    }
  }
  if (own.empty() && in_crs && f.north_of_its_own && !site_of(f)) {
    return Error{fmt::format(
        "{}: it is turned by its --north, but nobody says around which place; give its --site "
        "LAT,LON as well.",
        path)};
  }
  return std::nullopt;
}

bool agree(const std::string& a, const std::string& b, const Vec3& at) {
  if (a == b) return true;
  const auto in_a = locate(a, at), in_b = locate(b, at);
  return in_a && in_b && in_a.value().place.latitude == in_b.value().place.latitude &&
         in_a.value().place.longitude == in_b.value().place.longitude;
}

}  // namespace gnomon
