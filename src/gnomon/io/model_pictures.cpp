#include <fmt/format.h>
#include <gnomon/io/model_pictures.h>
#include <gnomon/io/read_picture.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

std::string key_of(const std::string& name, const PictureEdges& edges) {
  return fmt::format("{}{}{}{}", static_cast<int>(edges.u), static_cast<int>(edges.v), edges.smooth,
                     name);
}

// Of a path that stays below the folder it starts from.
bool stays_below(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return !normal.empty() && normal.is_relative() && *normal.begin() != "..";
}

}  // namespace

Result<std::string> read_beside_model(const std::string& model, const std::string& name) {
  if (name.find('\0') != std::string::npos) return Error{"its name is no file's"};
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const fs::path folder = fs::path(model).parent_path();
  for (const fs::path& at : {fs::path(slashes), fs::path(slashes).filename()}) {
    std::error_code code;
    if (!stays_below(at)) continue;
    if (!fs::is_regular_file(folder / at, code)) continue;
    std::ifstream file(folder / at, std::ios::binary);
    if (file.is_open()) return std::string(std::istreambuf_iterator<char>(file), {});
  }
  return Error{"it is not beside the model"};
}

int ModelPictures::add(Result<Texture> texture, const std::string& name, const std::string& key,
                       const PictureEdges& edges) {
  int& index = known_[key];
  index = -1;
  if (!texture) {
    warn(model_.warnings,
         "Pictures on surfaces were left out; put PNG, JPEG, BMP or GIF files beside the model.",
         fmt::format("{}: {}: {}", model_.report.path, in_quotes(name, 200),
                     printable(texture.error().message, 200)));
    return index;
  }
  texture.value().edge_u = edges.u;
  texture.value().edge_v = edges.v;
  texture.value().smooth = edges.smooth;
  index = static_cast<int>(model_.looks->textures.size());
  model_.looks->textures.push_back(std::move(texture).value());
  return index;
}

int ModelPictures::file(const std::string& name, const PictureEdges& edges) {
  const std::string key = key_of("file " + name, edges);
  if (const auto at = known_.find(key); at != known_.end()) return at->second;
  const auto read = read_beside_model(model_.report.path, name);
  return add(read ? read_picture(read.value(), name) : Result<Texture>(read.error()), name, key,
             edges);
}

int ModelPictures::bytes(std::string_view bytes, const std::string& name, const std::string& id,
                         const PictureEdges& edges) {
  const std::string key = key_of("bytes " + id, edges);
  if (const auto at = known_.find(key); at != known_.end()) return at->second;
  return add(read_picture(bytes, name), name, key, edges);
}

int ModelPictures::texels(Texture texture, const std::string& id, const PictureEdges& edges) {
  const std::string key = key_of("bytes " + id, edges);
  if (const auto at = known_.find(key); at != known_.end()) return at->second;
  const std::string name = texture.name;
  return add(std::move(texture), name, key, edges);
}

}  // namespace gnomon
