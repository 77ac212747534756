#include <fmt/format.h>
#include <gnomon/io/choose_animation.h>
#include <gnomon/io/gltf_animation.h>
#include <gnomon/io/gltf_values.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace gnomon {
namespace {

using cityjson::element;
using cityjson::member;
using Json = nlohmann::json;

std::optional<RigTrack::Of> path_of(const std::string& path) {
  if (path == "translation") return RigTrack::Of::translation;
  if (path == "rotation") return RigTrack::Of::rotation;
  if (path == "scale") return RigTrack::Of::scale;
  if (path == "weights") return RigTrack::Of::weights;
  return {};
}

bool all_finite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double d) { return std::isfinite(d); });
}

// Times and values of a sampler. `where`: for messages.
std::optional<Error> read_sampler(const GltfFile& file, const Json* sampler,
                                  const std::string& where, RigTrack& track) {
  const auto damaged = [&](const char* what) {
    return Error{fmt::format("{}: {}: {}; export the model again.", file.path, where, what)};
  };
  const std::string between = cityjson::text(member(sampler, "interpolation"));
  track.between = between == "STEP"          ? RigTrack::Between::step
                  : between == "CUBICSPLINE" ? RigTrack::Between::cubic
                                             : RigTrack::Between::linear;
  auto times = read_accessor(file, member(sampler, "input"), "SCALAR");
  if (!times) return times.error();
  const char* type = track.of == RigTrack::Of::rotation  ? "VEC4"
                     : track.of == RigTrack::Of::weights ? "SCALAR"
                                                         : "VEC3";
  auto values = read_accessor(file, member(sampler, "output"), type);
  if (!values) return values.error();
  track.times = std::move(times).value();
  track.values = std::move(values).value();
  if (track.times.empty() || !all_finite(track.times) || !(track.times[0] >= 0) ||
      !std::is_sorted(track.times.begin(), track.times.end())) {
    return damaged("its times must ascend from 0");
  }
  const std::size_t keys = track.times.size() * (track.between == RigTrack::Between::cubic ? 3 : 1);
  const bool fits = track.of == RigTrack::Of::weights
                        ? track.values.size() % keys == 0 && !track.values.empty()
                        : track.values.size() == keys * track.width;
  if (!fits) return damaged("it has another number of values than of times");
  track.width = track.values.size() / keys;
  if (!all_finite(track.values)) return damaged("its values must be finite numbers");
  return std::nullopt;
}

}  // namespace

std::vector<std::string> gltf_animation_names(const GltfFile& file) {
  const Json* list = member(&file.json, "animations");
  std::vector<std::string> names;
  for (std::size_t k = 0; k < size_of(list); ++k) {
    names.push_back(cityjson::text(member(element(list, k), "name")));
  }
  return animation_names(std::move(names));
}

Result<RigClip> read_gltf_animation(const GltfFile& file, std::size_t number,
                                    const std::unordered_map<std::size_t, std::uint32_t>& node_of,
                                    const std::vector<RigNode>& nodes, Warnings& warnings) {
  const Json* animation = element(member(&file.json, "animations"), number);
  const Json *channels = member(animation, "channels"), *samplers = member(animation, "samplers");
  RigClip clip;
  for (std::size_t k = 0; k < size_of(channels); ++k) {
    const Json *channel = element(channels, k), *target = member(channel, "target");
    const std::string element_name = fmt::format("animation {}, channel {}", number, k);
    const auto of = path_of(cityjson::text(member(target, "path")));
    const auto node =
        cityjson::index_below(member(target, "node"), size_of(member(&file.json, "nodes")));
    if (!of || !node) {
      warn(warnings,
           "Channels of animations that move anything but nodes and morph targets were left out.",
           fmt::format("{}: {}", file.path, element_name));
      continue;
    }
    const auto sampler = cityjson::index_below(member(channel, "sampler"), size_of(samplers));
    if (!sampler) {
      return Error{fmt::format("{}: {}: there is no sampler {}; export the model again.", file.path,
                               element_name, cityjson::kind_of(member(channel, "sampler")))};
    }
    RigTrack track;
    track.of = *of;
    track.width = *of == RigTrack::Of::rotation ? 4 : 3;
    const std::string where = fmt::format("animation {}, sampler {}", number, *sampler);
    if (auto error = read_sampler(file, element(samplers, *sampler), where, track)) return *error;
    clip.duration = std::max(clip.duration, track.times.back());
    const auto at = node_of.find(*node);
    if (at == node_of.end()) continue;
    track.node = at->second;
    if (nodes[track.node].matrix && *of != RigTrack::Of::weights) {
      warn(warnings,
           "Channels of nodes that have a matrix, which cannot be animated, were left out.",
           fmt::format("{}: {}", file.path, element_name));
      continue;
    }
    clip.tracks.push_back(std::move(track));
  }
  return clip;
}

}  // namespace gnomon
