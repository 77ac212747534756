#include <fmt/format.h>
#include <gnomon/core/lower_case.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/stl.h>

#include <bit>
#include <cstring>
#include <unordered_map>
#include <utility>

namespace gnomon {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it is stored");

constexpr std::size_t kHeader = 80, kFirstFacet = 84, kFacet = 50;  // bytes

bool is_word(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t k = 0; k < word.size(); ++k) {
    if (lower_case(word[k]) != lower[k]) return false;
  }
  return true;
}

std::uint64_t facets_of(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeader, sizeof count);
  return count;
}

bool is_binary(std::string_view bytes) {
  if (bytes.size() >= kFirstFacet && bytes.size() == kFirstFacet + kFacet * facets_of(bytes)) {
    return true;
  }
  // Many binary files start with "solid" too; no text has a zero byte.
  return !(MeshLines(bytes).next()) || bytes.find('\0') != std::string_view::npos ||
         !is_word(bytes.substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()), 5),
                  "solid");
}

std::optional<Error> read_binary(ModelBuilder& b, std::string_view bytes, char up) {
  const std::string& path = b.model.report.path;
  if (bytes.size() < kFirstFacet) {
    return Error{fmt::format(
        "{}: is no STL: neither does it start with \"solid\", nor has it the {} bytes of a binary "
        "header.",
        path, kFirstFacet)};
  }
  const std::uint64_t count = facets_of(bytes), room = (bytes.size() - kFirstFacet) / kFacet;
  if (count > room) {
    return Error{fmt::format(
        "{}: the header counts {}, but the file of {} bytes has room for {}; it is cut off or no "
        "STL.",
        path, counted(count, "triangle", "triangles"), bytes.size(), room)};
  }
  if (bytes.size() > kFirstFacet + kFacet * count) {
    warn(b.model.warnings, "Bytes after the last triangle that the header counts were left out.",
         path, bytes.size() - kFirstFacet - kFacet * count);
  }
  if (count == 0) return std::nullopt;
  const std::uint32_t surface = b.surface("", "", "", "");
  std::vector<std::vector<std::uint32_t>> ring(1);
  for (std::uint64_t f = 0; f < count; ++f) {
    float c[12];  // the normal and three vertices
    std::memcpy(c, bytes.data() + kFirstFacet + kFacet * f, sizeof c);
    ring[0].clear();
    for (int v = 1; v <= 3; ++v) {
      const Vec3 p(c[3 * v], c[3 * v + 1], c[3 * v + 2]);
      if (!is_finite(p)) {
        return Error{
            fmt::format("{}: triangle {}: vertex {} ({}, {}, {}) is not finite; repair the model.",
                        path, f, v - 1, p.x, p.y, p.z)};
      }
      ring[0].push_back(b.vertex(z_up(p, up)));
    }
    b.polygon(surface, static_cast<std::uint32_t>(f), ring);
  }
  return std::nullopt;
}

class TextStl {
 public:
  TextStl(ModelBuilder& b, std::string_view text, char up) : b_(b), lines_(text), up_(up) {}

  std::optional<Error> run() {
    while (lines_.next()) {
      if (!is_word(lines_.words[0], "solid")) return expected("\"solid\"");
      const auto name_at = static_cast<std::size_t>(lines_.words[0].data() + 5 - lines_.all.data());
      std::string_view name = lines_.all.substr(name_at);
      name.remove_prefix(std::min(name.find_first_not_of(" \t"), name.size()));
      name = name.substr(0, name.find_last_not_of(" \t") + 1);
      name_ = name;
      if (auto error = read_solid()) return error;
    }
    return std::nullopt;
  }

 private:
  const std::string& path() const { return b_.model.report.path; }

  Error expected(std::string_view what) const {
    return Error{fmt::format("{}: line {}: expected {}, not {}; check that the file is STL.",
                             path(), lines_.number, what, in_quotes(lines_.words[0]))};
  }

  Error cut_off() const {
    return Error{
        fmt::format("{}: the file ends within solid {}, before \"endsolid\"; it is cut off.",
                    path(), in_quotes(name_))};
  }

  std::optional<Error> read_solid() {
    while (lines_.next()) {
      if (is_word(lines_.words[0], "endsolid")) return std::nullopt;
      if (!is_word(lines_.words[0], "facet")) return expected("\"facet\" or \"endsolid\"");
      if (auto error = read_facet()) return error;
    }
    return cut_off();
  }

  std::optional<Error> read_facet() {
    const std::size_t first_line = lines_.number;
    ring_[0].clear();
    if (!lines_.next()) return cut_off();
    if (!is_word(lines_.words[0], "outer")) return expected("\"outer loop\"");
    while (true) {
      if (!lines_.next()) return cut_off();
      if (is_word(lines_.words[0], "endloop")) break;
      if (!is_word(lines_.words[0], "vertex")) return expected("\"vertex\" or \"endloop\"");
      if (auto error = read_vertex()) return error;
    }
    if (!lines_.next()) return cut_off();
    if (!is_word(lines_.words[0], "endfacet")) return expected("\"endfacet\"");
    if (ring_[0].size() < 3) {
      return Error{fmt::format("{}: line {}: the facet has {}, but needs three.", path(),
                               first_line, counted(ring_[0].size(), "vertex", "vertices"))};
    }
    b_.polygon(b_.surface(name_, "", "", ""), number_of_[name_]++, ring_);
    return std::nullopt;
  }

  std::optional<Error> read_vertex() {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      const auto word = static_cast<std::size_t>(k + 1);
      const auto d = word < lines_.words.size() ? real_number(lines_.words[word]) : std::nullopt;
      if (!d || !std::isfinite(*d)) {
        return Error{
            fmt::format("{}: line {}: the vertex's {} coordinate is {}, not a finite number.",
                        path(), lines_.number, "xyz"[k],
                        word < lines_.words.size() ? in_quotes(lines_.words[word]) : "missing")};
      }
      p[k] = *d;
    }
    ring_[0].push_back(b_.vertex(z_up(p, up_)));
    return std::nullopt;
  }

  ModelBuilder& b_;
  MeshLines lines_;
  char up_;
  std::string name_;
  std::vector<std::vector<std::uint32_t>> ring_{1};
  std::unordered_map<std::string, std::uint32_t> number_of_;  // polygons so far, by solid
};

}  // namespace

Result<Model> read_stl(std::string_view bytes, const std::string& path, char up,
                       double metres_per_unit) {
  ModelBuilder builder;
  Model& m = builder.model;
  m.report.path = path;
  m.report.format = "STL";
  m.scale = Vec3(metres_per_unit, metres_per_unit, metres_per_unit);
  if (auto error =
          is_binary(bytes) ? read_binary(builder, bytes, up) : TextStl(builder, bytes, up).run()) {
    return *error;
  }
  m.report.objects = m.surfaces.size();
  m.report.surfaces = m.polygons.size();
  return std::move(m);
}

}  // namespace gnomon
