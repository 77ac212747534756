#include <fmt/format.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/off.h>
#include <gnomon/io/read_text.h>

#include <utility>

namespace gnomon {
namespace {

// The least bytes that a vertex ("0 0 0" and a line end, but for the last) and a face ("0" or "1
// 0") take: what bounds the counts of a header by the size of its file.
constexpr std::uint64_t kVertexBytes = 6, kFaceBytes = 2;

class OffReader {
 public:
  OffReader(std::string_view text, const std::string& path, char up, double metres_per_unit)
      : size_(text.size()), lines_(text, '#'), path_(path), up_(up) {
    builder_.model.report.path = path;
    builder_.model.report.format = "OFF";
    builder_.model.scale = Vec3(metres_per_unit, metres_per_unit, metres_per_unit);
  }

  Result<Model> run() {
    if (auto error = read_header()) return *error;
    if (auto error = read_vertices()) return *error;
    if (auto error = read_faces()) return *error;
    Model& m = builder_.model;
    if (lines_.next()) {
      warn(m.warnings, "Lines after the last face that the header counts were left out.", line());
    }
    m.report.objects = m.surfaces.size();
    m.report.surfaces = m.polygons.size();
    return std::move(m);
  }

 private:
  std::string line() const { return fmt::format("{}: line {}", path_, lines_.number); }
  Error at_line(std::string_view what) const { return Error{fmt::format("{}: {}", line(), what)}; }

  std::optional<Error> read_header() {
    if (!lines_.next()) return Error{fmt::format("{}: there is no OFF header in it.", path_)};
    std::size_t word = 0;
    std::string_view key = lines_.words[0];
    if (key.ends_with("OFF")) {
      key.remove_suffix(3);
      if (key.starts_with("ST")) key.remove_prefix(2);
      if (key.starts_with('C')) key.remove_prefix(1);
      if (key.starts_with('N')) key.remove_prefix(1);
      if (key.starts_with('4')) {
        homogeneous_ = true;
        key.remove_prefix(1);
      }
      if (!key.empty()) {
        return at_line(fmt::format("{} is not read; save the model as plain OFF.",
                                   in_quotes(lines_.words[0])));
      }
      word = 1;
      if (word < lines_.words.size() && lines_.words[word] == "BINARY") {
        return at_line("binary OFF is not read; save the model as text.");
      }
    }
    std::uint64_t counts[2];
    for (int k = 0; k < 2; ++k, ++word) {
      if (word == lines_.words.size()) {
        if (!lines_.next()) return Error{fmt::format("{}: the counts are missing.", path_)};
        word = 0;
      }
      const auto n = whole_number(lines_.words[word]);
      if (!n) {
        return at_line(fmt::format("{} is no count of {}; check that the file is OFF.",
                                   in_quotes(lines_.words[word]), k == 0 ? "vertices" : "faces"));
      }
      counts[k] = *n;
    }
    vertices_ = counts[0];
    faces_ = counts[1];
    const std::uint64_t most_vertices = size_ / kVertexBytes + 1,
                        most_faces = size_ / kFaceBytes + 1;
    if (vertices_ > most_vertices || faces_ > most_faces) {
      return at_line(fmt::format(
          "the header counts {} and {}, more than a file of {} bytes can hold; correct the counts.",
          counted(vertices_, "vertex", "vertices"), counted(faces_, "face", "faces"), size_));
    }
    return std::nullopt;
  }

  std::optional<Error> read_vertices() {
    const std::size_t coordinates = homogeneous_ ? 4 : 3;
    at_.reserve(vertices_);
    for (std::uint64_t v = 0; v < vertices_; ++v) {
      if (!lines_.next()) {
        return Error{
            fmt::format("{}: the file ends after {}, but its header counts {}; it is cut off.",
                        path_, counted(v, "vertex", "vertices"), vertices_)};
      }
      double c[4] = {0, 0, 0, 1};
      for (std::size_t k = 0; k < coordinates; ++k) {
        const auto d = k < lines_.words.size() ? real_number(lines_.words[k]) : std::nullopt;
        if (!d) {
          return at_line(fmt::format(
              "vertex {} must have {} coordinates, but its {} is {}.", v, coordinates, "xyzw"[k],
              k < lines_.words.size() ? in_quotes(lines_.words[k]) : "missing"));
        }
        c[k] = *d;
      }
      at_.push_back(z_up(Vec3(c[0] / c[3], c[1] / c[3], c[2] / c[3]), up_));
    }
    return std::nullopt;
  }

  std::optional<Error> read_faces() {
    std::vector<std::vector<std::uint32_t>> ring(1);
    std::uint32_t surface = 0;
    for (std::uint64_t f = 0; f < faces_; ++f) {
      if (!lines_.next()) {
        return Error{
            fmt::format("{}: the file ends after {}, but its header counts {}; it is cut off.",
                        path_, counted(f, "face", "faces"), faces_)};
      }
      const auto corners = whole_number(lines_.words[0]);
      if (!corners || *corners == 0 || *corners >= lines_.words.size()) {
        return at_line(
            fmt::format("face {} must start with the number of its corners and name them.", f));
      }
      ring[0].clear();
      for (std::size_t k = 1; k <= *corners; ++k) {
        const auto v = whole_number(lines_.words[k]);
        if (!v || *v >= at_.size()) {
          return at_line(fmt::format("face {} names vertex {}, but there are {}, counted from 0.",
                                     f, in_quotes(lines_.words[k]), at_.size()));
        }
        if (!is_finite(at_[*v])) {
          return at_line(
              fmt::format("face {} uses vertex {}, which is not finite; repair the model.", f, *v));
        }
        ring[0].push_back(builder_.vertex(at_[*v]));
      }
      if (*corners < 3) {
        warn(builder_.model.warnings, "Points and lines cast no shadow and were left out.", line());
        continue;
      }
      surface = builder_.surface("", "", "", "");
      builder_.polygon(surface, static_cast<std::uint32_t>(f), ring);
    }
    return std::nullopt;
  }

  std::uint64_t size_;
  MeshLines lines_;
  const std::string& path_;
  char up_;
  ModelBuilder builder_;
  bool homogeneous_ = false;
  std::uint64_t vertices_ = 0, faces_ = 0;
  std::vector<Vec3> at_;  // z up
};

}  // namespace

Result<Model> read_off(std::string_view text, const std::string& path, char up,
                       double metres_per_unit) {
  return OffReader(text, path, up, metres_per_unit).run();
}

}  // namespace gnomon
