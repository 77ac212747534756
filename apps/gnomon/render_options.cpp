#include "render_options.h"

#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "commands.h"

namespace gnomon::app {
namespace {

constexpr const char* kGroup = "Shadows";

// An option whose values are the names of an enum.
template <class T>
void add_choice(CLI::App& command, const std::string& name, T& value, std::vector<T> choices,
                const std::string& help) {
  std::map<std::string, T> names;
  std::string all;
  for (const T choice : choices) {
    names[std::string(gl::name_of(choice))] = choice;
    all += (all.empty() ? "" : ", ") + std::string(gl::name_of(choice));
  }
  command
      .add_option_function<std::string>(
          name, [&value, names](const std::string& text) { value = names.at(text); },
          help + " (" + all + ")")
      ->check(CLI::IsMember([&] {
        std::vector<std::string> keys;
        for (const T choice : choices) keys.emplace_back(gl::name_of(choice));
        return keys;
      }()))
      ->default_str(std::string(gl::name_of(value)))
      ->type_name("NAME")
      ->group(kGroup);
}

// With the light from all around (gl::FrameOptions::ambient) a white surface that faces it is
// white.
constexpr Vec3 kUsualColour{0.75, 0.75, 0.75};

constexpr const char* kNoLamp =
    "--soft is for lamps, and there is none: suns have sharp shadows here";

Vec3 parse_colour(std::string_view text, const std::string& whole) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
  if (text.size() != 7 || error != std::errc() || end != text.data() + text.size()) {
    throw Failure(fmt::format("--light '{}': the colour '{}' cannot be read; write it as #rrggbb",
                              whole, text));
  }
  return Vec3((value >> 16) & 0xff, (value >> 8) & 0xff, value & 0xff) / 255.0;
}

// "X,Y,Z,point,#rrggbb,radius=30": what is behind the light's own words goes into `source`.
std::string take_looks(const std::string& text, gl::LightSource& source) {
  std::string rest;
  std::string_view left = text;
  bool coloured = false;
  while (!left.empty()) {
    const std::size_t comma = left.find(',');
    const std::string_view part = left.substr(0, comma);
    left.remove_prefix(comma == std::string_view::npos ? left.size() : comma + 1);
    if (part.starts_with('#')) {
      if (std::exchange(coloured, true))
        throw Failure(fmt::format("--light '{}' has two colours: give it one", text));
      source.colour = parse_colour(part, text);
    } else if (part.starts_with("radius=")) {
      const std::string_view number = part.substr(7);
      const auto [end, error] =
          std::from_chars(number.data(), number.data() + number.size(), source.radius);
      if (error != std::errc() || end != number.data() + number.size() || !(source.radius > 0)) {
        throw Failure(fmt::format("--light '{}': radius= takes metres above 0", text));
      }
    } else {
      rest += (rest.empty() ? "" : ",") + std::string(part);
    }
  }
  return rest;
}

// `n` points spread evenly over a ball (a Fibonacci lattice on shells of equal volume).
std::vector<Vec3> ball(const Vec3& centre, double radius, int n) {
  constexpr double kGoldenAngle = 2.399963229728653;  // pi (3 - sqrt 5)
  std::vector<Vec3> out;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, flat = std::sqrt(1 - z * z), a = kGoldenAngle * i;
    const double r =
        radius * std::cbrt((std::fmod(i * 0.618033988749895, 1.0) + 0.5 / n) / (1 + 0.5 / n));
    out.push_back(centre + r * Vec3(flat * std::cos(a), flat * std::sin(a), z));
  }
  return out;
}

}  // namespace

void add_method_options(CLI::App& command, gl::Method& m) {
  using namespace gl;
  add_choice(command, "--method", m.mask, {MaskIn::stencil, MaskIn::alpha, MaskIn::screen},
             "Where the shadow mask is kept");
  add_choice(command, "--count", m.count,
             {Count::z_pass, Count::z_fail, Count::near_cap, Count::zp_plus, Count::automatic,
              Count::mixed},
             "How faces of the shadow volumes are counted");
  add_choice(command, "--volumes", m.volumes,
             {VolumesOf::automatic, VolumesOf::caster, VolumesOf::polygon}, "One volume for each");
  add_choice(command, "--stencil-passes", m.passes,
             {StencilPasses::two_sided, StencilPasses::culled},
             "Both faces in one pass, or a pass for each");
  add_choice(command, "--stencil-ops", m.ops, {StencilOps::wrap, StencilOps::saturate},
             "Stencil arithmetic");
  add_choice(command, "--arithmetic", m.arithmetic, {Arithmetic::doubling, Arithmetic::maximum},
             "Blending of alpha and screen masks");
  add_choice(command, "--far", m.far_plane,
             {FarPlane::automatic, FarPlane::infinite, FarPlane::clamp}, "Far plane");
  add_choice(command, "--extrusion", m.extrusion,
             {Extrusion::cpu, Extrusion::shader, Extrusion::blend, Extrusion::blend_large},
             "Where volumes are extruded");
  add_choice(command, "--reach", m.reach, {Reach::automatic, Reach::infinite, Reach::bounded},
             "How far volumes reach");
  add_choice(command, "--primitives", m.primitives,
             {Primitives::quads, Primitives::strips, Primitives::fans}, "How sides are sent");
  add_choice(
      command, "--silhouettes", m.silhouettes,
      {SilhouetteBy::automatic, SilhouetteBy::brute_force, SilhouetteBy::dual_space,
       SilhouetteBy::edge_tree},
      "How silhouettes are found (auto: the tree of edges once a model has met many lights)");
  add_choice(command, "--shadows", m.shadows,
             {Shadows::automatic, Shadows::lights, Shadows::black, Shadows::ambient,
              Shadows::attenuated, Shadows::none},
             "What a shadow is: light by light, or the first paper's for one light");
  command.add_option("--mask-scale", m.mask_scale, "Size of the mask, as a share of the picture's")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str()
      ->group(kGroup);
  command.add_option("--samples", m.samples, "Samples per pixel (multisampling)")
      ->check(CLI::Range(1, 64))
      ->capture_default_str()
      ->group(kGroup);
}

void add_render_lights(CLI::App& command, RenderLights& o) {
  const char* group = "Light";
  command.add_option("--date", o.one.date, "Date of the sun, YYYY-MM-DD")->group(group);
  command.add_option("--at", o.one.at, "Local time of the sun, HH:MM[:SS]")->group(group);
  command.add_option("--tz", o.one.zone, "Time zone, such as Europe/Vienna, UTC or solar")
      ->group(group);
  command
      .add_option(
          "--light", o.lights,
          "X,Y,Z[,point|sun][,#rrggbb][,radius=METRES]: the place of a lamp (point, the "
          "default) in the model's coordinates, z up, or the direction towards a sun; its "
          "colour at full brightness (default #bfbfbf, which with the light from all around "
          "makes white; darker: dimmer); how far a lamp's light reaches (default: everywhere). May "
          "be repeated: lights add up")
      ->group(group);
  command
      .add_option("--soft", o.soft,
                  "METRES: each lamp becomes a ball of this radius, of --soft-lights lights with "
                  "its brightness together (soft shadows)")
      ->check(positive_number())
      ->group(group);
  command.add_option("--soft-lights", o.soft_lights, "Number of lights in the ball")
      ->needs("--soft")
      ->check(CLI::Range(2, 4096))
      ->capture_default_str()
      ->group(group);
}

ChosenLights choose_lights(const RenderLights& o, const Scene& scene) {
  ChosenLights out;
  if (o.lights.empty()) {
    check_light_options(o.one);
    if (o.soft > 0) throw Failure(kNoLamp);
    out.first = choose_light(o.one, scene);
    out.warnings = out.first.warnings;
    gl::LightSource sun;
    sun.light = out.first.light;
    sun.colour = kUsualColour;
    out.lights = {sun};
    return out;
  }
  bool lamp = false;
  for (const std::string& text : o.lights) {
    gl::LightSource source;
    source.colour = kUsualColour;
    LightOptions options = o.one;
    options.light = take_looks(text, source);
    check_light_options(options);
    const ChosenLight chosen = choose_light(options, scene);
    if (out.lights.empty()) out.first = chosen;
    append(out.warnings, chosen.warnings);
    source.light = chosen.light;
    if (source.light.w == 0 && source.radius > 0) {
      throw Failure(fmt::format(
          "--light '{}': radius= says how far a lamp's light reaches; a sun's reaches everywhere",
          text));
    }
    lamp |= source.light.w != 0;
    if (o.soft > 0 && source.light.w != 0) {
      const std::vector<Vec3> places = ball(Vec3(source.light), o.soft, o.soft_lights);
      source.colour /= double(places.size());
      for (const Vec3& p : places) {
        source.light = point(p);
        out.lights.push_back(source);
      }
    } else {
      out.lights.push_back(source);
    }
  }
  if (o.soft > 0 && !lamp) throw Failure(kNoLamp);
  if (o.lights.size() > 1) out.first.words = fmt::format("{} lights", o.lights.size());
  return out;
}

}  // namespace gnomon::app
