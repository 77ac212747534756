#include <fmt/format.h>
#include <gnomon/io/gltf_file.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

namespace gnomon {
namespace {

using cityjson::element;
using cityjson::member;
using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "buffers are read as they are stored");

// Offsets and counts above this are wrong in any file; sums and products of those below fit.
constexpr std::uint64_t kLargestOffset = std::uint64_t{1} << 40;

// A whole number below kLargestOffset; `missing` where it is not there.
std::optional<std::uint64_t> offset(const Json* value, std::uint64_t missing) {
  if (!value) return missing;
  return cityjson::index_below(value, kLargestOffset);
}

// Extensions that change no vertex, and one that is understood.
bool needs_nothing(std::string_view extension) {
  for (const std::string_view harmless :
       {"KHR_materials_", "KHR_texture_", "KHR_lights_", "KHR_animation_", "KHR_xmp",
        "KHR_mesh_quantization", "KHR_techniques_webgl", "EXT_texture_", "EXT_lights_"}) {
    if (extension.starts_with(harmless)) return true;
  }
  return false;
}

// The bytes of base64 text; nothing if it is none.
std::optional<std::string> from_base64(std::string_view text) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char c : text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return {};
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

// A buffer's own file; bytes, so that nothing in it is taken for a byte order mark.
Result<std::string> read_beside(const std::string& path, const std::string& uri,
                                const std::string& name) {
  const std::filesystem::path relative = percent_decoded(uri);
  if (uri.find(':') != std::string::npos || relative.is_absolute() ||
      relative.string().find('\0') != std::string::npos) {
    return Error{fmt::format("{}: {} is at {}; only files beside the model are read.", path, name,
                             in_quotes(uri))};
  }
  const std::filesystem::path at = std::filesystem::path(path).parent_path() / relative;
  std::error_code code;
  std::ifstream file;
  if (std::filesystem::is_regular_file(at, code)) file.open(at, std::ios::binary);
  if (!file.is_open()) {
    return Error{fmt::format("{}: {}, the file {}, is missing; put it beside the model.", path,
                             name, in_quotes(uri))};
  }
  return std::string(std::istreambuf_iterator<char>(file), {});
}

Result<std::string> read_buffer(const GltfFile& f, std::size_t k,
                                std::optional<std::string_view> chunk) {
  const Json* buffer = element(member(&f.json, "buffers"), k);
  const std::string name = fmt::format("buffer {}", k);
  const Json* uri = member(buffer, "uri");
  std::string bytes;
  if (!uri && k == 0 && chunk) {
    bytes = *chunk;
  } else if (const std::string where = cityjson::text(uri); where.starts_with("data:")) {
    auto decoded = bytes_of_data_uri(where);
    if (!decoded) {
      return Error{fmt::format("{}: {}: its data are no base64; export it again.", f.path, name)};
    }
    bytes = std::move(*decoded);
  } else if (!where.empty()) {
    auto read = read_beside(f.path, where, name);
    if (!read) return read.error();
    bytes = std::move(read).value();
  } else {
    return Error{
        fmt::format("{}: {} has neither a uri nor a binary chunk; export it again.", f.path, name)};
  }
  const auto length = offset(member(buffer, "byteLength"), kLargestOffset);
  if (!length || *length > bytes.size()) {
    return Error{fmt::format("{}: {} has {} bytes, but must have {}; it is cut off.", f.path, name,
                             bytes.size(), cityjson::kind_of(member(buffer, "byteLength")))};
  }
  return bytes;
}

struct Chunks {
  std::string_view json;
  std::optional<std::string_view> binary;
};

Result<Chunks> glb_chunks(std::string_view bytes, const std::string& path) {
  constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  const auto number = [&](std::size_t at) {
    std::uint32_t n = 0;
    std::memcpy(&n, bytes.data() + at, sizeof n);
    return n;
  };
  if (bytes.size() < 20)
    return Error{fmt::format("{}: ends within its header; it is cut off.", path)};
  if (number(4) != 2) {
    return Error{
        fmt::format("{}: is GLB of version {}, but only 2 is read; convert it.", path, number(4))};
  }
  const std::uint64_t length = number(8);
  if (length > bytes.size()) {
    return Error{fmt::format("{}: has {} bytes, but its header says {}; it is cut off.", path,
                             bytes.size(), length)};
  }
  Chunks chunks;
  for (std::size_t at = 12; at + 8 <= length;) {
    const std::uint64_t size = number(at), type = number(at + 4);
    if (size > length - at - 8) {
      return Error{fmt::format("{}: a chunk of {} bytes reaches beyond the end; it is cut off.",
                               path, size)};
    }
    const std::string_view chunk = bytes.substr(at + 8, size);
    if (type == kJson && chunks.json.empty()) chunks.json = chunk;
    if (type == kBinary && !chunks.binary) chunks.binary = chunk;
    at += 8 + size;
  }
  return chunks;
}

std::optional<Error> check_version(const GltfFile& f) {
  const Json* asset = member(&f.json, "asset");
  const std::string version = cityjson::text(member(asset, "version"));
  if (!version.starts_with("2.")) {
    return Error{fmt::format(
        "{}: is glTF of version {}, but only 2.0 is read; convert it or export it again.", f.path,
        version.empty() ? "unknown" : in_quotes(version))};
  }
  const Json* required = member(&f.json, "extensionsRequired");
  for (std::size_t k = 0; required && k < required->size(); ++k) {
    const std::string name = cityjson::text(element(required, k));
    if (!needs_nothing(name)) {
      return Error{fmt::format(
          "{}: needs the extension {}, which is not read; export it without (Draco and meshopt: "
          "without compression).",
          f.path, in_quotes(name))};
    }
  }
  return std::nullopt;
}

struct Layout {  // of a run of numbers in a buffer
  const char* first = nullptr;
  std::uint64_t stride = 0;
  int component = 0;  // glTF's componentType
  std::size_t components = 0;
  bool normalized = false;
};

std::size_t bytes_of(int component) {
  switch (component) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

template <class T>
double stored(const char* at, bool normalized) {
  T value;
  std::memcpy(&value, at, sizeof value);
  if constexpr (std::is_integral_v<T>) {
    if (normalized) return std::max(-1.0, double(value) / double(std::numeric_limits<T>::max()));
  }
  return double(value);
}

double number_at(const char* at, const Layout& l) {
  switch (l.component) {
    case 5120:
      return stored<std::int8_t>(at, l.normalized);
    case 5121:
      return stored<std::uint8_t>(at, l.normalized);
    case 5122:
      return stored<std::int16_t>(at, l.normalized);
    case 5123:
      return stored<std::uint16_t>(at, l.normalized);
    case 5125:
      return stored<std::uint32_t>(at, l.normalized);
    default:
      return stored<float>(at, false);
  }
}

// Where `count` elements that `owner` (an accessor, or part of a sparse one) describes are.
std::optional<Error> locate(const GltfFile& f, const Json* owner, const std::string& name,
                            std::uint64_t count, Layout& l) {
  const Json* views = member(&f.json, "bufferViews");
  const auto v = cityjson::index_below(member(owner, "bufferView"), views ? views->size() : 0);
  if (!v) return Error{fmt::format("{}: {}: its bufferView is not in the file.", f.path, name)};
  const Json* view = element(views, *v);
  const auto buffer = cityjson::index_below(member(view, "buffer"), f.buffers.size());
  const auto at = offset(member(view, "byteOffset"), 0);
  const auto length = offset(member(view, "byteLength"), kLargestOffset);
  if (!buffer || !at || !length || *at + *length > f.buffers[*buffer].size()) {
    return Error{fmt::format("{}: bufferView {} reaches beyond its buffer; the file is damaged.",
                             f.path, *v)};
  }
  const std::uint64_t size = bytes_of(l.component) * l.components;
  const auto begin = offset(member(owner, "byteOffset"), 0);
  const auto stride = offset(member(view, "byteStride"), size);
  if (!begin || !stride || *stride < size ||
      (count > 0 && *begin + *stride * (count - 1) + size > *length)) {
    return Error{
        fmt::format("{}: {} of {} elements reaches beyond its bufferView {}; the file is damaged.",
                    f.path, name, count, *v)};
  }
  l.first = f.buffers[*buffer].data() + *at + *begin;
  l.stride = *stride;
  return std::nullopt;
}

std::size_t components_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  return type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

}  // namespace

Result<GltfFile> open_gltf(std::string_view bytes, const std::string& path) {
  GltfFile f;
  f.path = path;
  f.glb = bytes.starts_with("glTF");
  Chunks chunks{bytes, {}};
  if (f.glb) {
    auto found = glb_chunks(bytes, path);
    if (!found) return found.error();
    chunks = found.value();
  }
  f.json = Json::parse(chunks.json, nullptr, false);
  if (!f.json.is_object()) {
    return Error{fmt::format("{}: its JSON cannot be read; check that the file is whole.", path)};
  }
  if (auto error = check_version(f)) return *error;
  const Json* buffers = member(&f.json, "buffers");
  for (std::size_t k = 0; buffers && k < buffers->size(); ++k) {
    auto buffer = read_buffer(f, k, chunks.binary);
    if (!buffer) return buffer.error();
    f.buffers.push_back(std::move(buffer).value());
  }
  return f;
}

Result<std::vector<double>> read_accessor(const GltfFile& file, const Json* index,
                                          std::string_view type) {
  const Json* accessors = member(&file.json, "accessors");
  const auto a = cityjson::index_below(index, accessors ? accessors->size() : 0);
  if (!a) {
    return Error{fmt::format("{}: there is no accessor {}; the file is damaged.", file.path,
                             cityjson::kind_of(index))};
  }
  const Json* accessor = element(accessors, *a);
  const std::string name = fmt::format("accessor {}", *a);
  Layout l;
  l.components = components_of(type);
  l.component =
      static_cast<int>(cityjson::index_below(member(accessor, "componentType"), 6000).value_or(0));
  const Json* normalized = member(accessor, "normalized");
  l.normalized = normalized && normalized->is_boolean() && normalized->get<bool>();
  const auto count = offset(member(accessor, "count"), kLargestOffset);
  if (cityjson::text(member(accessor, "type")) != type || bytes_of(l.component) == 0 || !count) {
    return Error{
        fmt::format("{}: {} must be a list of {}; the file is damaged.", file.path, name, type)};
  }
  std::uint64_t all = 0;  // bytes
  for (const std::string& b : file.buffers) all += b.size();
  if (*count > all) {
    return Error{fmt::format(
        "{}: {} has {} elements, more than all buffers have bytes; the file is damaged.", file.path,
        name, *count)};
  }
  std::vector<double> numbers(*count * l.components, 0.0);
  if (member(accessor, "bufferView")) {
    if (auto error = locate(file, accessor, name, *count, l)) return *error;
    for (std::uint64_t k = 0; k < *count; ++k) {
      for (std::size_t c = 0; c < l.components; ++c) {
        numbers[k * l.components + c] =
            number_at(l.first + k * l.stride + c * bytes_of(l.component), l);
      }
    }
  }
  const Json* sparse = member(accessor, "sparse");
  if (!sparse) return numbers;
  const auto changed = offset(member(sparse, "count"), kLargestOffset);
  const Json *where = member(sparse, "indices"), *values = member(sparse, "values");
  Layout at;
  at.components = 1;
  at.component =
      static_cast<int>(cityjson::index_below(member(where, "componentType"), 6000).value_or(0));
  Layout to = l;
  if (!changed || *changed > *count || bytes_of(at.component) == 0) {
    return Error{fmt::format("{}: {}: its sparse part cannot be read.", file.path, name)};
  }
  if (auto error = locate(file, where, name, *changed, at)) return *error;
  if (auto error = locate(file, values, name, *changed, to)) return *error;
  for (std::uint64_t k = 0; k < *changed; ++k) {
    const double to_index = number_at(at.first + k * at.stride, at);
    if (!(to_index >= 0 && to_index < double(*count))) {
      return Error{
          fmt::format("{}: {}: sparse index {} is out of range.", file.path, name, to_index)};
    }
    for (std::size_t c = 0; c < l.components; ++c) {
      numbers[static_cast<std::size_t>(to_index) * l.components + c] =
          number_at(to.first + k * to.stride + c * bytes_of(to.component), to);
    }
  }
  return numbers;
}

std::string percent_decoded(std::string_view uri) {
  const auto hex = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string out;
  for (std::size_t k = 0; k < uri.size(); ++k) {
    if (uri[k] == '%' && k + 2 < uri.size() && hex(uri[k + 1]) >= 0 && hex(uri[k + 2]) >= 0) {
      out += static_cast<char>(hex(uri[k + 1]) * 16 + hex(uri[k + 2]));
      k += 2;
    } else {
      out += uri[k];
    }
  }
  return out;
}

std::optional<std::string> bytes_of_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(";base64,");
  return comma == std::string_view::npos ? std::nullopt : from_base64(uri.substr(comma + 8));
}

Result<std::string> read_buffer_view(const GltfFile& f, const Json* index) {
  const Json* views = member(&f.json, "bufferViews");
  const auto v = cityjson::index_below(index, views && views->is_array() ? views->size() : 0);
  const Json* view = v ? element(views, *v) : nullptr;
  const auto buffer = cityjson::index_below(member(view, "buffer"), f.buffers.size());
  const auto at = offset(member(view, "byteOffset"), 0);
  const auto length = offset(member(view, "byteLength"), kLargestOffset);
  if (!buffer || !at || !length || *at + *length > f.buffers[*buffer].size()) {
    return Error{"its bytes are not in the file"};
  }
  return f.buffers[*buffer].substr(*at, *length);
}

}  // namespace gnomon
