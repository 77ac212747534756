#include "summary.h"

#include <algorithm>
#include <cmath>

#include <gnomon/io/crs.h>
#include <gnomon/raster/add_in_shadow.h>
#include <gnomon/sun/time_zone.h>

#include "summary_parts.h"

namespace gnomon::app {
namespace {

double rounded(double v, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(v * scale) / scale;
}

double degrees(double radians) { return rounded(radians / kDegree, 9); }

Json sample_json(const TimeSample& s) {
  return {{"utc", iso_text(s.utc)},
          {"azimuth_deg", degrees(s.sun.azimuth)},
          {"altitude_deg", degrees(s.sun.altitude_apparent)},
          {"altitude_geometric_deg", degrees(s.sun.altitude_geometric)},
          {"direction", {s.light.x, s.light.y, s.light.z}},
          {"weight_s", s.weight_ms / 1000.0},
          {"above_horizon", s.up}};
}

}  // namespace

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json site_json(const Site& site) {
  return {{"latitude_deg", degrees(site.place.latitude)},
          {"longitude_deg", degrees(site.place.longitude)},
          {"height_m", site.on_ground ? Json() : Json(site.place.height)}};
}

Json model_inputs_json(const ModelOptions& options) {
  const LoadOptions& l = options.load;
  Json models = Json::array();
  for (const auto& m : options.models) models.push_back(m.string());
  Json out{{"models", models},
           {"lod", text_or_null(l.lod)},
           {"up", l.up == 0 ? Json() : Json(std::string(1, l.up))},
           {"unit", text_or_null(l.unit)},
           {"north_deg", l.north ? Json(degrees(*l.north)) : Json()},
           {"crs", text_or_null(l.crs)},
           {"site", Json()},
           {"ground", l.ground},
           {"cast", l.cast},
           {"no_cast", l.no_cast},
           {"receive", l.receive},
           {"surface", l.surface == RasterMesh::cells ? "cells" : "triangles"},
           {"above_ground", l.above_ground},
           {"footprints",
            {{"layer", text_or_null(l.footprints.layer)},
             {"height_attribute", text_or_null(l.footprints.height)},
             {"floors_attribute", text_or_null(l.footprints.floors)},
             {"base_attribute", text_or_null(l.footprints.base)},
             {"floor_height_m", l.footprints.floor_height}}}};
  Json for_files = Json::array();
  for (const FileOptions& f : l.for_files) {
    for_files.push_back({{"file", f.file},
                         {"up", f.up == 0 ? Json() : Json(std::string(1, f.up))},
                         {"unit", text_or_null(f.unit)},
                         {"north_deg", f.north ? Json(degrees(*f.north)) : Json()},
                         {"crs", text_or_null(f.crs)},
                         {"site", f.site ? site_json(*f.site) : Json()}});
  }
  out["for_files"] = for_files;
  if (l.site) {
    out["site"] = site_json(*l.site);
  }
  return out;
}

Json scene_json(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  Json files = Json::array();
  for (const FileReport& f : loaded.files) {
    files.push_back({{"path", f.path},
                     {"format", f.format},
                     {"crs", text_or_null(f.crs)},
                     {"axes", text_or_null(f.axes)},
                     {"placed", text_or_null(f.placed)},
                     {"lods", f.lods},
                     {"lod_used", text_or_null(f.lod_used)},
                     {"objects", f.objects},
                     {"polygons", f.surfaces},
                     {"triangles", f.triangles},
                     {"stored_twice", f.stored_twice}});
  }
  std::size_t casting = 0, receiving = 0;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    casting += casts(scene, t) ? 1 : 0;
    receiving += receives(scene, t) ? 1 : 0;
  }
  const Frame& f = scene.frame;
  Json place;
  if (f.place) {
    place = {{"latitude_deg", degrees(f.place->latitude)},
             {"longitude_deg", degrees(f.place->longitude)},
             {"height_m", rounded(f.place->height, 3)}};
  }
  return {{"files", files},
          {"triangles", scene.mesh.triangles.size()},
          {"triangles_casting", casting},
          {"triangles_receiving", receiving},
          {"vertices", scene.mesh.positions.size()},
          {"zero_area_triangles_dropped", loaded.zero_area_triangles},
          {"ground", {{"kind", loaded.ground.kind}, {"triangles", loaded.ground.triangles}}},
          {"crs", text_or_null(f.crs)},
          {"origin", {f.origin.x, f.origin.y, f.origin.z}},
          {"true_north_deg", degrees(f.true_north)},
          {"place", place}};
}

Json view_json(const View& v, const Vec3& o) {
  const auto vec = [](const Vec4& a) { return Json{a.x, a.y, a.z, a.w}; };
  const bool plan = v.eye == Vec4(0, 0, 1, 0);
  Json out{{"kind", plan             ? "plan"
                    : is_parallel(v) ? "parallel camera"
                                     : "camera"},
           {"width", v.width},
           {"height", v.height}};
  if (plan) {
    const double pixel = v.right.x;
    out["pixel_m"] = pixel;
    out["bounds"] = {v.origin.x + o.x, v.origin.y + o.y - pixel * v.height,
                     v.origin.x + o.x + pixel * v.width, v.origin.y + o.y};
  }
  out["definition"] = {{"note",
                        "ray of column i, row j: q = origin + (i+1/2) right + (j+1/2) down; scene "
                        "coordinates (CRS minus origin)"},
                       {"eye", vec(v.eye)},
                       {"origin", vec(v.origin)},
                       {"right", vec(v.right)},
                       {"down", vec(v.down)}};
  return out;
}

Json warnings_json(const Warnings& warnings) {
  Json out = Json::array();
  for (const Warning& w : warnings) {
    out.push_back({{"what", w.what}, {"count", w.count}, {"first", text_or_null(w.first)}});
  }
  return out;
}

namespace {

Json inputs_json(const Summary& s) {
  Json out = model_inputs_json(s.models);
  out["date"] = s.times.date;
  out["from"] = text_or_null(s.times.from);
  out["to"] = text_or_null(s.times.to);
  out["every"] = s.times.every;
  out["tz"] = s.times.zone;
  out["threads"] = s.threads == 0 ? Json() : Json(s.threads);
  return out;
}

Json result_json(const Profile& p) {
  std::size_t samples = 0;
  double sum = 0;
  std::uint32_t largest = 0;
  for (std::size_t k = 0; k < p.valid.size(); ++k) {
    if (p.valid[k] == 0) continue;
    ++samples;
    sum += shadow_hours(p, k);
    largest = std::max(largest, p.shadow_ticks[k]);
  }
  return {{"samples", samples},
          {"days", p.days},
          {"daylight_h", daylight_hours(p)},
          {"mean_shadow_h",
           samples == 0 ? Json() : Json(rounded(sum / static_cast<double>(samples), 6))},
          {"max_shadow_h", hours_per_day(p, largest)}};
}

}  // namespace

std::string summary_json(const Summary& s, const Warnings& warnings) {
  Json json;
  json["program"] = "gnomon";
  json["version"] = GNOMON_VERSION;
  json["conventions"] =
      "azimuth_deg: from true north, clockwise; altitude_deg: of the sun's centre with refraction "
      "(the one shadows use); direction: "
      "[x east, y north, z up in the model's CRS, towards the sun]; hours: each step's midpoint "
      "times the step, per day of window.dates";
  json["inputs"] = inputs_json(s);
  json["scene"] = scene_json(s.loaded);
  json["view"] = view_json(s.view, s.loaded.scene.frame.origin);
  json["window"] = {{"begin_utc", iso_text(s.samples.begin)},
                    {"end_utc", iso_text(s.samples.end)},
                    {"dates", s.samples.dates}};
  json["samples"] = Json::array();
  for (const TimeSample& t : s.samples.midpoints) json["samples"].push_back(sample_json(t));
  json["instants"] = Json::array();
  // Of a range, pictures show a few of many; the midpoints say where the sun was.
  if (s.samples.dates.size() == 1)
    for (const TimeSample& t : s.samples.instants) {
      Json j = sample_json(t);
      j.erase("weight_s");
      json["instants"].push_back(j);
    }
  json["result"] = result_json(s.profile);
  json["result"]["isolines_every_h"] =
      s.step_ms == 0 ? Json() : Json(static_cast<double>(s.step_ms) / 3.6e6);
  json["result"]["shadows_reach_border"] = s.shadows_reach_border;
  json["counts"] = {
      {"silhouette_edges", s.stats.sides},
      {"samples_decided_in_double_or_exactly", s.stats.close},
      {"exact_decisions",
       s.stats.signs.exact + s.stats.spans.exact + s.stats.depths.exact + s.visibility.exact},
      {"ties", s.stats.signs.ties + s.stats.spans.ties + s.stats.depths.ties + s.visibility.ties},
      {"shadows_in_view_png", s.picture_instants},
      {"instruction_set", instruction_set()}};
  json["timings"] = Json::object();
  for (const auto& [stage, ms] : s.timings) json["timings"][stage] = rounded(ms, 3);
  json["warnings"] = warnings_json(warnings);
  json["outputs"] = s.outputs;
  // File names need not be UTF-8; JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gnomon::app
