#include <fmt/format.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/ply.h>
#include <gnomon/io/ply_header.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace gnomon {
namespace {

constexpr std::size_t kMostOfName = 60;  // bytes of an element's name in messages

template <class T>
double stored(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

// Every whole number of PLY is a double exactly.
double value_at(const char* at, PlyType type, bool swap) {
  char bytes[8];
  const std::size_t size = bytes_of(type);
  std::memcpy(bytes, at, size);
  if (swap) std::reverse(bytes, bytes + size);
  switch (type) {
    case PlyType::kInt8:
      return stored<std::int8_t>(bytes);
    case PlyType::kUint8:
      return stored<std::uint8_t>(bytes);
    case PlyType::kInt16:
      return stored<std::int16_t>(bytes);
    case PlyType::kUint16:
      return stored<std::uint16_t>(bytes);
    case PlyType::kInt32:
      return stored<std::int32_t>(bytes);
    case PlyType::kUint32:
      return stored<std::uint32_t>(bytes);
    case PlyType::kFloat:
      return stored<float>(bytes);
    case PlyType::kDouble:
      return stored<double>(bytes);
  }
  return 0;
}

class PlyReader {
 public:
  PlyReader(ModelBuilder& builder, const PlyHeader& header, char up)
      : builder_(builder),
        header_(header),
        up_(up),
        text_(header.body),
        bytes_(header.body),
        swap_((header.storage == PlyStorage::kBigEndian) ==
              (std::endian::native == std::endian::little)) {}

  std::optional<Error> run() {
    if (auto error = check_counts()) return error;
    for (const PlyElement& e : header_.elements) {
      const bool vertex = e.name == "vertex", face = e.name == "face",
                 strips = e.name == "tristrips";
      if (vertex && e.count > 0) {
        if (auto error = find_coordinates(e)) return error;
      }
      if ((face || strips) && e.count > 0) {
        if (auto error = find_indices(e)) return error;
      }
      for (index_ = 0; index_ < e.count; ++index_) {
        if (auto error = read_element(e)) return error;
        if (vertex) at_.push_back(z_up(coordinates_, up_));
        if (face || strips) faces_.push_back({index_, place(), strips, indices_});
      }
      if (e.name == "edge") {
        warn(warnings(), "Points and lines cast no shadow and were left out.", path(), e.count);
      }
    }
    if (header_.storage == PlyStorage::kText ? text_.next() : !bytes_.empty()) {
      warn(warnings(), "What follows the last element that the header counts was left out.",
           path());
    }
    for (const Face& f : faces_) {  // after all vertices, which may stand below
      if (auto error = add(f)) return error;
    }
    if (faces_.empty()) {
      warn(warnings(), "Points and lines cast no shadow and were left out.", path(), at_.size());
    }
    return std::nullopt;
  }

 private:
  struct Face {
    std::uint64_t index;
    std::string place;  // where messages find it, of texts
    bool strip;
    std::vector<double> corners;
  };

  const std::string& path() const { return builder_.model.report.path; }
  Warnings& warnings() { return builder_.model.warnings; }
  // "line 12: " of text, nothing of binary files.
  std::string place() const {
    return header_.storage == PlyStorage::kText
               ? fmt::format("line {}: ", header_.lines + text_.number)
               : std::string();
  }
  Error at(const PlyElement& e, const std::string& what) const {
    return Error{fmt::format("{}: {}{} {} {}", path(), place(), printable(e.name, kMostOfName),
                             index_, what)};
  }

  // What a header promises takes at least a byte an element, or the size of its fixed part.
  std::optional<Error> check_counts() const {
    for (const PlyElement& e : header_.elements) {
      std::uint64_t least = 0;
      for (const PlyProperty& p : e.properties) {
        least +=
            header_.storage == PlyStorage::kText ? 2 : bytes_of(p.list ? p.count_type : p.type);
      }
      if (least == 0 ? e.count > 0 : e.count > (header_.body.size() + 1) / least) {
        return Error{
            fmt::format("{}: the header counts {} of element {}, but the {} bytes after it have no "
                        "room for them; "
                        "the file is cut off or its header wrong.",
                        path(), e.count, in_quotes(e.name), header_.body.size())};
      }
    }
    return std::nullopt;
  }

  std::optional<Error> find_coordinates(const PlyElement& e) {
    for (int c = 0; c < 3; ++c) {
      coordinate_[c] = e.properties.size();
      for (std::size_t k = 0; k < e.properties.size(); ++k) {
        if (!e.properties[k].list && e.properties[k].name == std::string(1, "xyz"[c])) {
          coordinate_[c] = k;
        }
      }
      if (coordinate_[c] == e.properties.size()) {
        return Error{fmt::format("{}: vertices have no property \"{}\".", path(), "xyz"[c])};
      }
    }
    return std::nullopt;
  }

  std::optional<Error> find_indices(const PlyElement& e) {
    for (list_ = 0; list_ < e.properties.size(); ++list_) {
      const PlyProperty& p = e.properties[list_];
      if (p.list && (p.name == "vertex_indices" || p.name == "vertex_index")) return std::nullopt;
    }
    return Error{
        fmt::format("{}: element {} has no list \"vertex_indices\".", path(), in_quotes(e.name))};
  }

  std::optional<Error> read_element(const PlyElement& e) {
    if (header_.storage == PlyStorage::kText) {
      if (!text_.next()) {
        return Error{fmt::format("{}: the file ends before {} {} of {}; it is cut off.", path(),
                                 printable(e.name, kMostOfName), index_, e.count)};
      }
      word_ = 0;
    }
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      const PlyProperty& p = e.properties[k];
      double value = 0;
      if (auto error = read_value(e, p, p.list ? p.count_type : p.type, value)) return error;
      if (!p.list) {
        for (int c = 0; c < 3; ++c) {
          if (e.name == "vertex" && coordinate_[c] == k) coordinates_[c] = value;
        }
        continue;
      }
      if (!(value >= 0 && value <= double(header_.body.size()))) {
        return at(e, fmt::format("has a list {} of {} items; the file is damaged.",
                                 in_quotes(p.name), value));
      }
      const bool wanted = k == list_ && (e.name == "face" || e.name == "tristrips");
      if (wanted) indices_.clear();
      for (double left = value; left > 0; --left) {
        double item = 0;
        if (auto error = read_value(e, p, p.type, item)) return error;
        if (wanted) indices_.push_back(item);
      }
    }
    if (header_.storage == PlyStorage::kText && word_ < text_.words.size()) {
      return at(e, fmt::format("has {}, but its properties are {}; the header does not fit.",
                               counted(text_.words.size(), "number", "numbers"), word_));
    }
    return std::nullopt;
  }

  std::optional<Error> read_value(const PlyElement& e, const PlyProperty& p, PlyType type,
                                  double& value) {
    if (header_.storage == PlyStorage::kText) {
      const auto found =
          word_ < text_.words.size() ? real_number(text_.words[word_]) : std::nullopt;
      if (!found) {
        return at(e, fmt::format("must have a number for {}, but it is {}.", in_quotes(p.name),
                                 word_ < text_.words.size() ? in_quotes(text_.words[word_])
                                                            : std::string("missing")));
      }
      ++word_;
      value = *found;
      return std::nullopt;
    }
    const std::size_t size = bytes_of(type);
    if (bytes_.size() < size) {
      return at(e, fmt::format("is cut off: the file ends, but the header counts {}.", e.count));
    }
    value = value_at(bytes_.data(), type, swap_);
    bytes_.remove_prefix(size);
    return std::nullopt;
  }

  // Corner k of the face.
  Result<std::uint32_t> corner(const Face& f, std::size_t k) {
    const double v = f.corners[k];
    const char* element = f.strip ? "tristrips" : "face";
    if (!(v >= 0 && v < double(at_.size()) && v == std::floor(v))) {
      return Error{fmt::format("{}: {}{} {} names vertex {}, but there are {}, counted from 0.",
                               path(), f.place, element, f.index, v, at_.size())};
    }
    const Vec3& p = at_[static_cast<std::size_t>(v)];
    if (!is_finite(p)) {
      return Error{fmt::format(
          "{}: {}{} {} uses vertex {} ({}, {}, {}), which is not finite; repair the model.", path(),
          f.place, element, f.index, v, p.x, p.y, p.z)};
    }
    return builder_.vertex(p);
  }

  std::optional<Error> add(const Face& f) {
    std::vector<std::vector<std::uint32_t>> ring(1);
    std::size_t along = 0;  // corners of this strip so far
    for (std::size_t k = 0; k < f.corners.size(); ++k) {
      if (f.strip && f.corners[k] == -1) {
        ring[0].clear();
        along = 0;
        continue;
      }
      const auto c = corner(f, k);
      if (!c) return c.error();
      ring[0].push_back(c.value());
      if (!f.strip || ++along < 3) continue;
      auto triangle = ring;
      if (along % 2 == 0) std::swap(triangle[0][0], triangle[0][1]);
      builder_.polygon(builder_.surface("", "", "", ""), number_++, triangle);
      ring[0].erase(ring[0].begin());
    }
    if (f.strip) return std::nullopt;
    if (f.corners.size() < 3) {
      warn(warnings(), "Points and lines cast no shadow and were left out.",
           fmt::format("{}: {}face {}", path(), f.place, f.index));
      return std::nullopt;
    }
    builder_.polygon(builder_.surface("", "", "", ""), static_cast<std::uint32_t>(f.index), ring);
    return std::nullopt;
  }

  ModelBuilder& builder_;
  const PlyHeader& header_;
  char up_;
  MeshLines text_;
  std::string_view bytes_;
  bool swap_;
  std::size_t word_ = 0;                       // of the line
  std::uint64_t index_ = 0;                    // of the element
  std::size_t coordinate_[3] = {}, list_ = 0;  // properties
  Vec3 coordinates_{0, 0, 0};
  std::vector<double> indices_;
  std::vector<Vec3> at_;  // z up
  std::vector<Face> faces_;
  std::uint32_t number_ = 0;
};

}  // namespace

Result<Model> read_ply(std::string_view bytes, const std::string& path, char up,
                       double metres_per_unit) {
  ModelBuilder builder;
  Model& m = builder.model;
  m.report.path = path;
  m.report.format = "PLY";
  m.scale = Vec3(metres_per_unit, metres_per_unit, metres_per_unit);
  const auto header = read_ply_header(bytes, path, m.warnings);
  if (!header) return header.error();
  if (auto error = PlyReader(builder, header.value(), up).run()) return *error;
  m.report.objects = m.surfaces.size();
  m.report.surfaces = m.polygons.size();
  return std::move(m);
}

}  // namespace gnomon
