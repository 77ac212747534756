#include <gnomon/io/write_gltf.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/io/scene_parts.h>

namespace gnomon {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the specification.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

static_assert(std::endian::native == std::endian::little,
              "glTF is little-endian; elsewhere values need turning");

template <class T>
void put(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

// sRGB to the linear light that baseColorFactor is given in (IEC 61966-2-1).
double linear(std::uint8_t v) {
  const double c = v / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  const auto byte = [&](std::size_t k) {
    return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u;
  };
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const unsigned three = byte(k) << 16 | byte(k + 1) << 8 | byte(k + 2);
    out += kDigits[three >> 18];
    out += kDigits[three >> 12 & 63];
    out += k + 1 < bytes.size() ? kDigits[three >> 6 & 63] : '=';
    out += k + 2 < bytes.size() ? kDigits[three & 63] : '=';
  }
  return out;
}

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json asset_json(const Frame& f, const std::string& software) {
  Json place;
  if (f.place) {
    place = {{"latitude_deg", f.place->latitude / kDegree},
             {"longitude_deg", f.place->longitude / kDegree},
             {"height_m", f.place->height}};
  }
  return {
      {"version", "2.0"},
      {"generator", software},
      {"extras",
       {{"crs", text_or_null(f.crs)},
        {"origin", {f.origin.x, f.origin.y, f.origin.z}},
        {"true_north_deg", f.true_north / kDegree},
        {"place", place},
        {"axes",
         "x east, y up, z south, metres; CRS coordinates = (x, -z, y) + origin; true_north_deg: "
         "clockwise from grid north (-z)"}}}};
}

// One file under construction: bytes and the JSON that describes them.
struct Building {
  const Scene& scene;
  std::string bytes;
  Json views = Json::array(), accessors = Json::array(), meshes = Json::array(),
       nodes = Json::array();
  double largest_rounding = 0;

  std::size_t add_accessor(std::size_t begin, int target, int type, std::size_t count,
                           const char* shape) {
    views.push_back({{"buffer", 0},
                     {"byteOffset", begin},
                     {"byteLength", bytes.size() - begin},
                     {"target", target}});
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", type},
                         {"count", count},
                         {"type", shape}});
    return accessors.size() - 1;
  }

  // The vertices of one object, once each; `local` tells their numbers.
  std::size_t add_positions(const SceneObject& object,
                            std::unordered_map<std::uint32_t, std::uint32_t>& local) {
    const std::size_t begin = bytes.size();
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (const ScenePart& part : object.parts) {
      for (const std::uint32_t t : part.triangles) {
        for (const std::uint32_t v : scene.mesh.triangles[t]) {
          if (!local.try_emplace(v, static_cast<std::uint32_t>(local.size())).second) continue;
          const Vec3& p = scene.mesh.positions[v];
          const std::array<double, 3> turned{p.x, p.z, 0.0 - p.y};  // y up; no -0
          double squares = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            const auto f = static_cast<float>(turned[k]);
            low[k] = std::min(low[k], f);
            high[k] = std::max(high[k], f);
            squares += (turned[k] - f) * (turned[k] - f);
            put(bytes, f);
          }
          largest_rounding = std::max(largest_rounding, std::sqrt(squares));
        }
      }
    }
    const std::size_t at = add_accessor(begin, kArrayBuffer, kFloat, local.size(), "VEC3");
    accessors[at]["min"] = {low[0], low[1], low[2]};
    accessors[at]["max"] = {high[0], high[1], high[2]};
    return at;
  }

  Json add_primitive(const ScenePart& part, std::size_t positions,
                     const std::unordered_map<std::uint32_t, std::uint32_t>& local) {
    const std::size_t begin = bytes.size();
    for (const std::uint32_t t : part.triangles) {
      for (const std::uint32_t v : scene.mesh.triangles[t]) put(bytes, local.at(v));
    }
    const std::size_t indices =
        add_accessor(begin, kElementArrayBuffer, kUnsignedInt, 3 * part.triangles.size(), "SCALAR");
    const Surface& s = scene.surfaces[part.surface];
    return {{"attributes", {{"POSITION", positions}}},
            {"indices", indices},
            {"material", part.material},
            {"extras",
             {{"type", text_or_null(s.group)},
              {"semantic", text_or_null(s.semantic)},
              {"material", text_or_null(s.material)},
              {"casts", s.casts},
              {"receives", s.receives}}}};
  }

  void add_object(const SceneObject& object) {
    std::unordered_map<std::uint32_t, std::uint32_t> local;
    const std::size_t positions = add_positions(object, local);
    Json primitives = Json::array();
    bool casts = false, receives = false;
    for (const ScenePart& part : object.parts) {
      primitives.push_back(add_primitive(part, positions, local));
      casts = casts || scene.surfaces[part.surface].casts;
      receives = receives || scene.surfaces[part.surface].receives;
    }
    Json mesh, node;
    if (!object.name.empty()) mesh["name"] = node["name"] = object.name;
    mesh["primitives"] = std::move(primitives);
    meshes.push_back(std::move(mesh));
    node["mesh"] = meshes.size() - 1;
    node["extras"] = {{"type", text_or_null(scene.surfaces[object.parts[0].surface].group)},
                      {"casts", casts},
                      {"receives", receives}};
    nodes.push_back(std::move(node));
  }
};

Json materials_json(const SceneParts& parts) {
  Json out = Json::array();
  for (const PartMaterial& m : parts.materials) {
    out.push_back(
        {{"name", m.name},
         {"doubleSided", true},  // the winding of triangles carries no meaning
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {linear(m.colour.r), linear(m.colour.g), linear(m.colour.b), 1.0}},
           {"metallicFactor", 0.0},
           {"roughnessFactor", 1.0}}}});
  }
  return out;
}

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// 12 bytes of header, the JSON padded with blanks and the bytes padded with zeros to multiples
// of 4.
Result<std::string> as_glb(const std::filesystem::path& path, std::string json,
                           const std::string& bytes) {
  while (json.size() % 4 != 0) json += ' ';
  const std::uint64_t size = 12 + 8 + json.size() + 8 + bytes.size();
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    return Error{fmt::format(
        "Cannot write {}: {:.1f} GB are more than the 4 GiB that a .glb can have; write .obj, or "
        "fewer models.",
        path.string(), static_cast<double>(size) / 1e9)};
  }
  std::string out;
  out.reserve(size);
  put(out, kMagic);
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(size));
  put(out, static_cast<std::uint32_t>(json.size()));
  put(out, kJsonChunk);
  out += json;
  put(out, static_cast<std::uint32_t>(bytes.size()));
  put(out, kBinChunk);
  out += bytes;  // whole words already: floats and 32-bit indices
  return out;
}

}  // namespace

Result<GltfWritten> write_gltf(const std::filesystem::path& path, const Scene& scene, GltfForm form,
                               const std::string& software) {
  const SceneParts parts = scene_parts(scene);
  Building building{scene, {}, Json::array(), Json::array(), Json::array(), Json::array(), 0};
  for (const SceneObject& object : parts.objects) building.add_object(object);

  Json json;
  json["asset"] = asset_json(scene.frame, software);
  json["scene"] = 0;
  Json roots = Json::array();
  for (std::size_t k = 0; k < building.nodes.size(); ++k) roots.push_back(k);
  json["scenes"] = Json::array({{{"nodes", std::move(roots)}}});
  json["nodes"] = std::move(building.nodes);
  json["meshes"] = std::move(building.meshes);
  json["materials"] = materials_json(parts);
  json["accessors"] = std::move(building.accessors);
  json["bufferViews"] = std::move(building.views);
  Json buffer{{"byteLength", building.bytes.size()}};
  if (form == GltfForm::embedded) {
    buffer["uri"] = "data:application/octet-stream;base64," + base64(building.bytes);
  }
  json["buffers"] = Json::array({std::move(buffer)});

  std::string text = dumped(json);
  if (form == GltfForm::binary) {
    Result<std::string> glb = as_glb(path, std::move(text), building.bytes);
    if (!glb) return glb.error();
    text = std::move(glb).value();
  }
  Result<FileWritten> file = write_text_file(path, text);
  if (!file) return file.error();
  return GltfWritten{std::move(file).value(), parts.objects.size(), building.largest_rounding};
}

}  // namespace gnomon
