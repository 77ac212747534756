// A scene as Gnomon sees it: triangles with the objects they belong to, who casts and who receives,
// and where on Earth it stands. Made by io (or by hand); everything after it only reads it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/core/warnings.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/scene/appearance.h>

namespace gnomon {

// A class of triangles that are chosen together. Names are empty where the file has none.
struct Surface {
  std::string object;       // id of the city object or OBJ object; parts as "parent/part"
  std::uint32_t whole = 0;  // length, within object, of the name of the outermost parent; 0: object
                            // is no part. Ids may hold '/' of their own ("way/5").
  std::string group;  // OBJ group; CityJSON object type ("Building", "BuildingPart", "TINRelief")
  std::string material;  // OBJ material; CityJSON material name
  std::string semantic;  // CityJSON semantic surface ("RoofSurface", "WallSurface", ...); "Ground"
                         // for --ground
  std::uint32_t file = 0;  // number of the file it is from; equal names in two are two objects
  bool city = false;       // group and semantic are words of CityJSON's, not a designer's
  bool casts = true;
  bool receives = true;
};

// How scene coordinates lie on Earth.
struct Frame {
  Vec3 origin{
      0, 0, 0};  // subtracted from the model's CRS coordinates (metres in that CRS) once, when read
  std::string crs;  // "EPSG:31256" or WKT; empty: local metric coordinates
  double true_north =
      0;  // radians, clockwise from the scene's +y axis (grid north) to true north, at the origin
  std::optional<Place> place;  // of the origin
};

struct Scene {
  TriMesh mesh;                           // welded; no triangle of zero area
  std::vector<std::uint32_t> surface_of;  // per triangle: index into surfaces
  std::vector<Surface> surfaces;
  Appearance appearance;  // empty where looks were not asked for
  Frame frame;
  Warnings warnings;
};

inline bool casts(const Scene& s, std::uint32_t triangle) {
  return s.surfaces[s.surface_of[triangle]].casts;
}
inline bool receives(const Scene& s, std::uint32_t triangle) {
  return s.surfaces[s.surface_of[triangle]].receives;
}

}  // namespace gnomon
