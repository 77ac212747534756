#include <gnomon/io/ifc_units.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace gnomon {
namespace {

using Kind = StepValue::Kind;

constexpr int kDeepest = 8;  // feet by inches by millimetres; a file in a circle must end
constexpr double kFoot = 0.3048;
constexpr double kSurveyFoot = 1200.0 / 3937.0;  // of the United States

constexpr std::array<std::pair<std::string_view, double>, 16> kPrefixes = {{
    {"EXA", 1e18},
    {"PETA", 1e15},
    {"TERA", 1e12},
    {"GIGA", 1e9},
    {"MEGA", 1e6},
    {"KILO", 1e3},
    {"HECTO", 1e2},
    {"DECA", 1e1},
    {"DECI", 1e-1},
    {"CENTI", 1e-2},
    {"MILLI", 1e-3},
    {"MICRO", 1e-6},
    {"NANO", 1e-9},
    {"PICO", 1e-12},
    {"FEMTO", 1e-15},
    {"ATTO", 1e-18},
}};

std::optional<double> prefix(std::string_view name) {
  for (const auto& [text, factor] : kPrefixes) {
    if (text == name) return factor;
  }
  return std::nullopt;
}

std::optional<IfcLengthUnit> unit_at(const StepFile& file, std::uint64_t id, int depth) {
  const StepInstance* unit = depth > kDeepest ? nullptr : find(file, id);
  if (!unit) return std::nullopt;
  const auto a = arguments_of(*unit);
  if (a.size() < 4 || a[1].text != "LENGTHUNIT") return std::nullopt;
  if (same_keyword(unit->keyword, "IFCSIUNIT")) {
    if (a[3].text != "METRE") return std::nullopt;
    if (a[2].kind == Kind::kNull) return IfcLengthUnit{};
    const auto factor = prefix(a[2].text);
    if (!factor) return std::nullopt;
    return IfcLengthUnit{*factor, true};
  }
  const bool conversion = same_keyword(unit->keyword, "IFCCONVERSIONBASEDUNIT") ||
                          same_keyword(unit->keyword, "IFCCONVERSIONBASEDUNITWITHOFFSET");
  const StepInstance* measure = conversion ? find(file, a[3].reference) : nullptr;
  if (!measure || !same_keyword(measure->keyword, "IFCMEASUREWITHUNIT")) return std::nullopt;
  const auto m = arguments_of(*measure);  // IFCLENGTHMEASURE(0.3048), #19
  if (m.size() < 2 || m[0].items.empty() || m[0].items[0].kind != Kind::kNumber ||
      m[1].kind != Kind::kReference) {
    return std::nullopt;
  }
  const auto base = unit_at(file, m[1].reference, depth + 1);
  const double metres = base ? m[0].items[0].number * base->metres : 0;
  if (!std::isfinite(metres) || metres <= 0) return std::nullopt;
  return IfcLengthUnit{metres, false};
}

}  // namespace

std::optional<IfcLengthUnit> ifc_length_unit(const StepFile& file, std::uint64_t id) {
  return unit_at(file, id, 0);
}

std::optional<double> ifc_length_unit_named(std::string_view name) {
  std::string text;  // without spaces and the like, one spelling of metre
  for (const char c : name) {
    if (c >= 'a' && c <= 'z') text += static_cast<char>(c - 'a' + 'A');
    if (c >= 'A' && c <= 'Z') text += c;
  }
  if (text.ends_with('S')) text.pop_back();
  if (text.ends_with("METER")) text.replace(text.size() - 2, 2, "RE");
  if (text == "M" || text == "METRE") return 1.0;
  if (text == "MM") return 1e-3;
  if (text == "CM") return 1e-2;
  if (text == "KM") return 1e3;
  if (text == "FT" || text == "FOOT" || text == "FEET" || text == "INTERNATIONALFOOT") return kFoot;
  if (text == "USSURVEYFOOT" || text == "USSURVEYFEET" || text == "USFOOT" || text == "FTU") {
    return kSurveyFoot;
  }
  if (text == "INCH" || text == "INCHE") return kFoot / 12;
  if (!text.ends_with("METRE")) return std::nullopt;
  return prefix(std::string_view(text).substr(0, text.size() - 5));
}

const StepInstance* ifc_project(const StepFile& file) {
  for (const StepInstance& i : file.instances) {
    if (same_keyword(i.keyword, "IFCPROJECT")) return &i;
  }
  return nullptr;
}

std::optional<IfcLengthUnit> ifc_project_unit(const StepFile& file) {
  const StepInstance* project = ifc_project(file);
  if (!project) return std::nullopt;
  const auto a = arguments_of(*project);
  const StepInstance* assignment = a.size() > 8 ? find(file, a[8].reference) : nullptr;
  if (!assignment) return std::nullopt;
  for (const StepValue& list : arguments_of(*assignment)) {
    for (const StepValue& unit : list.items) {
      const auto length = ifc_length_unit(file, unit.reference);
      if (length) return length;
    }
  }
  return std::nullopt;
}

}  // namespace gnomon
