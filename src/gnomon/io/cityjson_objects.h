// City objects of one CityJSON document (or of one line of a CityJSONSeq) -> polygons of a
// ModelBuilder.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include <gnomon/io/cityjson_access.h>
#include <gnomon/io/model.h>

namespace gnomon::cityjson {

// A level of detail as files write it: 2, 2.2, "2", "2.2". Ordered from coarse to fine; names that
// are no numbers, and geometry that does not say, stand between the flat LoD 0 and LoD 1.
struct Lod {
  double rank = 0;
  bool numeric = false;
  std::string name;  // "2.2"; empty where the geometry does not say
  bool operator<(const Lod& o) const { return rank != o.rank ? rank < o.rank : name < o.name; }
};
Lod lod_of(const Json* value);

// Where everything of one file goes.
struct Reading {
  std::string path;
  std::string lod;       // asked for; empty: the highest of each object
  std::size_t line = 0;  // of a CityJSONSeq, for messages; 0: the file is one document
  Json header;  // the document, or the first line of a CityJSONSeq: templates and their materials
  std::vector<Vec3> template_vertices;
  std::set<Lod> lods;
  ModelBuilder builder;
  std::unordered_map<std::string, std::uint32_t> materials;  // of looks, by their JSON text
  std::string error;                                         // the first one; reading stops there

  // Sets the error, with the file (and line) in front; returns false.
  bool fail(const std::string& what);
};

// Reads all city objects of `document` (with its own vertices). False: Reading::error says why.
bool read_objects(Reading& reading, const Json& document);

}  // namespace gnomon::cityjson
