#include <fmt/format.h>
#include <gnomon/io/cityjson.h>
#include <gnomon/io/cityjson_objects.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/read_text.h>

#include <optional>
#include <utility>

namespace gnomon {
namespace {

using cityjson::Json;
using cityjson::member;
using cityjson::Reading;

constexpr std::size_t kMostOfReason = 300;  // bytes; the parser quotes the whole string it is in

// The parser's reason without its own prefix and position, which we give ourselves.
std::string reason_of(const Json::exception& e) {
  std::string what = e.what();
  for (const std::string_view mark : {"column ", "] "}) {
    const std::size_t at = what.find(mark);
    if (at == std::string::npos) continue;
    const std::size_t colon = mark == "] " ? at + 1 : what.find(": ", at) + 1;
    what.erase(0, colon + 1);
    break;
  }
  return printable(what, kMostOfReason);
}

// A JSON document. `first_line`: the line of the file that `text` starts on.
std::optional<Json> parse(std::string_view text, std::size_t first_line, Reading& reading) {
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& e) {
    const std::size_t at = e.byte > 0 ? e.byte - 1 : 0;
    const std::size_t line_start = text.substr(0, at).rfind('\n') + 1;  // npos + 1 is 0
    reading.error = fmt::format(
        "{}: not JSON at line {}, column {}: {}; the file is damaged or cut off.", reading.path,
        first_line + line_of(text, at) - 1, at - line_start + 1, reason_of(e));
  } catch (const Json::exception& e) {  // a number that no double holds
    reading.error =
        fmt::format("{}: cannot be read as JSON{}: {}.", reading.path,
                    reading.line ? fmt::format(" in line {}", reading.line) : "", reason_of(e));
  }
  return std::nullopt;
}

// Cuts `text` after its first line; returns that line.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

bool blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

// "1.1" of "1.1.3"; empty if Gnomon does not know that version.
std::string known_version(const std::string& version) {
  for (const std::string_view known : {"1.0", "1.1", "2.0"}) {
    if (version == known || version.starts_with(std::string(known) + ".")) {
      return std::string(known);
    }
  }
  return {};
}

// Type, version, transform, CRS, templates' vertices.
bool read_header(Reading& reading, bool lines) {
  const Json& header = reading.header;
  Model& model = reading.builder.model;
  const std::string type = cityjson::text(member(&header, "type"));
  if (type == "CityJSONFeature") {
    return reading.fail(
        "starts with a CityJSONFeature; the first line of a CityJSONSeq must be the "
        "\"type\": \"CityJSON\" header with version and transform.");
  }
  if (type != "CityJSON") {
    return reading.fail(
        "is JSON, but not CityJSON (it has no \"type\": \"CityJSON\"); other JSON formats are not "
        "read.");
  }
  const Json* version = member(&header, "version");
  const std::string known = known_version(cityjson::text(version));
  if (known.empty()) {
    return reading.fail(fmt::format(
        "CityJSON version {} is not supported (1.0, 1.1 and 2.0 are); upgrade the file with "
        "\"cjio FILE upgrade save OUT\".",
        version && version->is_string() ? in_quotes(cityjson::text(version))
                                        : cityjson::kind_of(version)));
  }
  model.report.format = fmt::format("{} {}", lines ? "CityJSONSeq" : "CityJSON", known);

  if (const Json* transform = member(&header, "transform")) {
    const auto scale = cityjson::vec3(member(transform, "scale"));
    const auto translate = cityjson::vec3(member(transform, "translate"));
    if (!scale || !translate) {
      return reading.fail(
          "the transform is broken: \"scale\" and \"translate\" must be three finite numbers "
          "each.");
    }
    if (!(scale->x > 0 && scale->y > 0 && scale->z > 0)) {
      return reading.fail("the transform is broken: \"scale\" must be positive.");
    }
    model.scale = *scale;
    model.translate = *translate;
  } else if (known != "1.0") {
    warn(model.warnings,
         "The file has no transform, which its version requires; vertices were taken as they are.",
         reading.path);
  }

  const Json* metadata = member(&header, "metadata");
  if (const Json* crs = member(metadata, "referenceSystem")) {
    if (!crs->is_string()) return reading.fail("metadata.referenceSystem must be a text.");
    model.report.crs = short_crs(cityjson::text(crs));
  }

  const Json* templates = member(&header, "geometry-templates");
  if (const Json* vertices = member(templates, "vertices-templates")) {
    for (std::size_t k = 0; k < vertices->size(); ++k) {
      const auto v = cityjson::vec3(cityjson::element(vertices, k));
      if (!v) {
        return reading.fail(fmt::format("template vertex {} must be three finite numbers, not {}.",
                                        k, cityjson::kind_of(cityjson::element(vertices, k))));
      }
      reading.template_vertices.push_back(*v);
    }
  }
  return true;
}

// The lines after the header, each a CityJSONFeature; they start on line 2.
bool read_features(Reading& reading, std::string_view rest) {
  for (reading.line = 2; !rest.empty(); ++reading.line) {
    const std::string_view line = next_line(rest);
    if (blank(line)) continue;
    const auto feature = parse(line, reading.line, reading);
    if (!feature) return false;
    if (cityjson::text(member(&*feature, "type")) != "CityJSONFeature") {
      return reading.fail("must be a \"type\": \"CityJSONFeature\".");
    }
    if (!read_objects(reading, *feature)) return false;
  }
  return true;
}

void finish_report(Reading& reading) {
  Model& model = reading.builder.model;
  for (const cityjson::Lod& lod : reading.lods) {
    if (!lod.name.empty()) model.report.lods.push_back(lod.name);
  }
  if (!reading.lod.empty()) {
    model.report.lod_used = reading.lod;
  } else if (model.report.lods.size() == 1) {
    model.report.lod_used = model.report.lods[0];
  } else if (!model.report.lods.empty()) {
    model.report.lod_used = "highest of each object";
  }
  model.report.surfaces = model.polygons.size();
}

}  // namespace

Result<Model> read_cityjson(std::string_view text, const std::string& path, const std::string& lod,
                            const ReadOptions& options) {
  Reading reading;
  reading.path = path;
  reading.lod = lod;
  reading.builder.model.report.path = path;
  if (options.appearance) reading.builder.model.looks.emplace();

  // A first line that is a whole JSON value, with more after it: CityJSONSeq. Else one document.
  std::string_view rest = text;
  const std::string_view first = next_line(rest);
  auto document = parse(first, 1, reading);
  const bool lines = document && !blank(rest);
  if (!document && !blank(rest)) {
    reading.error.clear();
    document = parse(text, 1, reading);
  }
  if (!document) return Error{reading.error};
  reading.header = std::move(*document);
  reading.line = lines ? 1 : 0;

  const bool read = read_header(reading, lines) && read_objects(reading, reading.header) &&
                    (!lines || read_features(reading, rest));
  if (!read) return Error{reading.error};
  finish_report(reading);
  return std::move(reading.builder.model);
}

}  // namespace gnomon
