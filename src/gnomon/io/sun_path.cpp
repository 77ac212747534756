#include <gnomon/io/sun_path.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include <glm/geometric.hpp>

#include <gnomon/io/html.h>
#include <gnomon/sun/time_zone.h>

namespace gnomon {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;

// Units of the viewBox. 400 across is a phone's width, so that type of 10 units stays legible.
constexpr double kWidth = 400;
constexpr double kRadius = 162;  // of the horizon
const Vec2 kCentre(200, 190);
constexpr double kLegendTop = 392, kLegendLine = 15;

constexpr milliseconds kStep = minutes(4);  // one degree of the sun's way

// Dark enough to print; told apart by their order in the legend and the labels, too.
constexpr std::array<const char*, 4> kDayColours{"#c4500c", "#1f5fa8", "#2d7d46", "#7b3f98"};

bool is_up(const SunPosition& sun) { return sun.altitude_apparent > 0; }

Vec2 projected(const SunPosition& sun) {
  return sun_path_point(sun.azimuth, sun.altitude_apparent);
}

// The moment between `down` and `up`, on the side of `up`, to the millisecond.
Instant crossing(Instant down, Instant up, const Place& place, const Atmosphere& air) {
  while (std::chrono::abs(up - down) > milliseconds(1)) {
    const Instant middle = down + (up - down) / 2;
    (is_up(sun_position(middle, place, air)) ? up : down) = middle;
  }
  return up;
}

struct Drawing {
  std::string svg;
  const SunPath& path;

  Vec2 on_page(const Vec2& p) const { return kCentre + kRadius * p; }

  void text(const Vec2& at, const char* anchor, double size, const char* colour,
            const std::string& words, bool bold = false) {
    // A white rim keeps letters legible on lines.
    svg += fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:g}\" text-anchor=\"{}\" fill=\"{}\"{} "
        "stroke=\"#fff\" stroke-width=\"2.5\" stroke-linejoin=\"round\" "
        "paint-order=\"stroke\">{}</text>\n",
        at.x, at.y + 0.35 * size, size, anchor, colour, bold ? " font-weight=\"bold\"" : "",
        html_text(words));
  }
  void line(const Vec2& a, const Vec2& b, const char* colour, double width) {
    svg += fmt::format(
        "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\" "
        "stroke-width=\"{:g}\"/>\n",
        a.x, a.y, b.x, b.y, colour, width);
  }
  void circle(const Vec2& at, double radius, const char* fill, const char* stroke, double width) {
    svg += fmt::format(
        "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" fill=\"{}\" stroke=\"{}\" "
        "stroke-width=\"{:g}\"/>\n",
        at.x, at.y, radius, fill, stroke, width);
  }
  void arc(const SkyArc& arc, const char* kind, const char* colour, double width) {
    std::string d;
    for (const Vec2& p : arc.points) {
      const Vec2 at = on_page(p);
      d += fmt::format("{}{:.2f} {:.2f}", d.empty() ? "M" : "L", at.x, at.y);
    }
    if (arc.closed) d += "Z";
    svg += fmt::format(
        "<path class=\"{}\" d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" "
        "stroke-linejoin=\"round\"/>\n",
        kind, d, colour, width);
  }
};

// The sun's way at a moment: its place on the page and the unit normal of the path to the left.
struct Way {
  Vec2 at{0, 0}, normal{0, 0};
};

Way way(const Drawing& d, Instant t) {
  const auto at = [&](Instant u) {
    return d.on_page(projected(sun_position(u, d.path.place, d.path.air)));
  };
  const Vec2 along = at(t + kStep) - at(t - kStep);
  const double length = glm::length(along);
  // The sun stands still for no one, but at the pole's zenith distance of 0 it would turn on a
  // spot.
  const Vec2 unit = length > 0 ? along / length : Vec2(-1, 0);
  return {at(t), {unit.y, -unit.x}};
}

// +1 or -1: the side of the path, constant along it, that is away from the zenith at the transit.
double outer_side(const Drawing& d, Instant transit) {
  const Way w = way(d, transit);
  return glm::dot(w.normal, w.at - kCentre) < 0 ? -1 : 1;
}

void draw_sky(Drawing& d, bool labels_north) {
  d.circle(kCentre, kRadius, "#fff", "#1c1b20", 1.2);
  for (int altitude = 15; altitude < 90; altitude += 15)
    d.circle(kCentre, kRadius * (90 - altitude) / 90, "none", "#d4d4d8", 0.7);
  for (int azimuth = 0; azimuth < 360; azimuth += 30) {
    const double a = azimuth * kDegree;
    d.line(d.on_page(sun_path_point(a, 75 * kDegree)), d.on_page(sun_path_point(a, 0)), "#d4d4d8",
           0.7);
    const Vec2 rim = d.on_page(1.085 * sun_path_point(a, 0));
    constexpr const char* kPoints[] = {"N", "E", "S", "W"};
    if (azimuth % 90 == 0)
      d.text(rim, "middle", 13, "#1c1b20", kPoints[azimuth / 90], true);
    else
      d.text(rim, "middle", 10, "#55535c", fmt::format("{}\u00b0", azimuth));
  }
  d.circle(kCentre, 1.5, "#8a8890", "none", 0);
  const double spoke = labels_north ? 0 : kPi;
  for (int altitude = 15; altitude < 90; altitude += 15) {
    const Vec2 at = d.on_page(sun_path_point(spoke, altitude * kDegree));
    d.text({at.x + 3, at.y}, "start", 9, "#55535c", fmt::format("{}\u00b0", altitude));
  }
  // The grid's +y, as seen from true north. Nearer than half a degree the mark would lie on N.
  if (std::abs(d.path.true_north) >= 0.5 * kDegree) {
    const Vec2 rim = sun_path_point(-d.path.true_north, 0);
    d.line(d.on_page(0.965 * rim), d.on_page(1.03 * rim), "#1c1b20", 2);
  }
}

// Days of the solstices and the March equinox, by the declination at 12:00 UTC.
struct Season {
  const char* label;
  const char* name;
  std::chrono::sys_days day;
};

std::array<Season, 3> seasons(std::chrono::year year, const Place& place, const Atmosphere& air) {
  const std::chrono::sys_days first = year / 1 / 1;
  std::array<Season, 3> out{{{"Jun", "June solstice", first},
                             {"Mar, Sep", "equinoxes", first},
                             {"Dec", "December solstice", first}}};
  double highest = -kPi, lowest = kPi, nearest = kPi;
  for (std::chrono::sys_days day = first;
       day < std::chrono::sys_days((year + std::chrono::years(1)) / 1 / 1);
       day += std::chrono::days(1)) {
    const double declination = sun_position(day + hours(12), place, air).declination;
    if (declination > highest) {
      highest = declination;
      out[0].day = day;
    }
    // The first half of the year alone: the sun in March.
    if (day - first < std::chrono::days(182) && std::abs(declination) < nearest) {
      nearest = std::abs(declination);
      out[1].day = day;
    }
    if (declination < lowest) {
      lowest = declination;
      out[2].day = day;
    }
  }
  return out;
}

// Returns the names of those that stay below the horizon.
std::vector<std::string> draw_seasons(Drawing& d, std::chrono::year year) {
  const Place& place = d.path.place;
  std::vector<std::string> below;
  std::vector<std::pair<Vec2, const char*>> labels;
  for (const Season& season : seasons(year, place, d.path.air)) {
    const auto east = milliseconds(std::llround(place.longitude / (2 * kPi) * 86400000.0));
    const Instant noon = season.day + hours(12) - east;
    const std::vector<SkyArc> arcs = day_arcs(noon, place, d.path.air);
    if (arcs.empty()) below.push_back(season.name);
    for (const SkyArc& arc : arcs) d.arc(arc, "season", "#9d9ba3", 1);
    if (!arcs.empty()) {
      const Instant transit = sun_arc(noon, place, d.path.air).transit;
      const Way w = way(d, transit);
      labels.emplace_back(w.at - 8.0 * outer_side(d, transit) * w.normal, season.label);
    }
  }
  for (const auto& [at, label] : labels) d.text(at, "middle", 9, "#6b6972", label);
  return below;
}

// Full hours of the zone's clock in [begin, end), in the order of time; an hour that the clock
// shows twice has its first mark alone.
struct HourMark {
  Instant utc;
  int hour = 0;
};

Result<std::vector<HourMark>> hour_marks(const SunPath& path, Instant begin, Instant end) {
  const Result<ClockTime> first = utc_to_clock(path.zone, path.place, begin);
  if (!first) return first.error();
  const Result<ClockTime> last = utc_to_clock(path.zone, path.place, end);
  if (!last) return last.error();
  std::vector<HourMark> marks;
  for (auto clock = std::chrono::ceil<hours>(first.value()); clock <= last.value();
       clock += hours(1)) {
    const Result<ClockInstant> at = clock_to_utc(path.zone, path.place, clock);
    if (!at) return at.error();
    if (at.value().skipped || at.value().utc < begin || at.value().utc >= end) continue;
    const auto since = clock - std::chrono::floor<std::chrono::days>(clock);
    const int hour = static_cast<int>(since / hours(1));
    // A solar day may be shorter than 24 h: its midnight then comes at both ends of the arc.
    if (!marks.empty() && marks.front().hour == hour) continue;
    marks.push_back({at.value().utc, hour});
  }
  return marks;
}

std::optional<Error> draw_day(Drawing& d, const SunPathDay& day, const char* colour) {
  const SunPath& path = d.path;
  const Instant middle = day.begin + (day.end - day.begin) / 2;
  const Instant transit = sun_arc(middle, path.place, path.air).transit;
  const std::vector<SkyArc> arcs = day_arcs(middle, path.place, path.air);
  for (const SkyArc& arc : arcs) d.arc(arc, "day", colour, 1.4);
  for (const SkyArc& arc : sky_arcs(day.begin, day.end, path.place, path.air))
    d.arc(arc, "window", colour, 5);

  const double side = outer_side(d, transit);
  for (const SkyArc& arc : arcs) {
    const Result<std::vector<HourMark>> marks = hour_marks(path, arc.begin, arc.end);
    if (!marks) return marks.error();
    for (const HourMark& mark : marks.value()) {
      const Way w = way(d, mark.utc);
      d.line(w.at - 3.5 * w.normal, w.at + 3.5 * w.normal, "#1c1b20", 1.1);
      // Labels stay inside the rim, whose own labels stand outside.
      Vec2 label = w.at + 12.0 * side * w.normal;
      if (glm::length(label - kCentre) > kRadius - 5) label = w.at - 12.0 * side * w.normal;
      d.text(label, "middle", 10, "#1c1b20", fmt::format("{}", mark.hour));
    }
  }
  // Small enough to stay apart on an arc of about 300 units.
  const double count = static_cast<double>(std::max<std::size_t>(day.steps.size(), 1));
  const double radius = std::clamp(100 / count, 0.6, 2.2);
  for (const TimeSample& step : day.steps) {
    if (step.up) d.circle(d.on_page(projected(step.sun)), radius, "#1c1b20", "#fff", radius / 3);
  }
  return {};
}

// Returns the height of the whole drawing.
double draw_legend(Drawing& d, std::chrono::year year, const std::vector<std::string>& below) {
  double y = kLegendTop;
  const auto words = [&](double x, const std::string& text) {
    d.text({x, y}, "start", 10, "#1c1b20", text);
  };
  for (std::size_t k = 0; k < d.path.days.size(); ++k) {
    const SunPathDay& day = d.path.days[k];
    const char* colour = kDayColours[k % kDayColours.size()];
    const Instant middle = day.begin + (day.end - day.begin) / 2;
    if (day_arcs(middle, d.path.place, d.path.air).empty()) {
      words(14, day.label + ": the sun stays below the horizon");
    } else {
      d.line({14, y}, {40, y}, colour, 5);
      words(46, day.label + ", window of the study");
      d.line({256, y}, {282, y}, colour, 1.4);
      words(288, "rest of the day");
    }
    y += kLegendLine;
  }
  d.circle({27, y}, 2.2, "#1c1b20", "#fff", 0.7);
  words(46, "steps (their midpoints)");
  d.line({269, y - 4}, {269, y + 4}, "#1c1b20", 1.1);
  words(288, "full hours");
  y += kLegendLine;
  d.line({14, y}, {40, y}, "#9d9ba3", 1);
  words(46, fmt::format("solstices and equinoxes of {}", static_cast<int>(year)));
  for (const std::string& name : below) {
    y += kLegendLine;
    words(46, name + ": the sun stays below the horizon");
  }
  return y + kLegendLine;
}

}  // namespace

Vec2 sun_path_point(double azimuth, double altitude) {
  const double r = (kPi / 2 - altitude) / (kPi / 2);
  return {r * std::sin(azimuth), -r * std::cos(azimuth)};
}

std::vector<SkyArc> sky_arcs(Instant begin, Instant end, const Place& place,
                             const Atmosphere& air) {
  std::vector<SkyArc> arcs;
  Instant last = begin;
  bool was_up = false;
  for (Instant t = begin;; t = std::min(end, t + kStep)) {
    const SunPosition sun = sun_position(t, place, air);
    const auto add = [&](Instant at) {
      arcs.back().points.push_back(projected(sun_position(at, place, air)));
      arcs.back().end = at;
    };
    if (is_up(sun)) {
      if (!was_up) {
        const Instant rise = t == begin ? t : crossing(last, t, place, air);
        arcs.push_back({{}, rise, rise, false});
        add(rise);
      }
      if (arcs.back().end < t) add(t);
    } else if (was_up) {
      const Instant set = crossing(t, last, place, air);
      if (arcs.back().end < set) add(set);
    }
    was_up = is_up(sun);
    last = t;
    if (t == end) break;
  }
  return arcs;
}

std::vector<SkyArc> day_arcs(Instant noon, const Place& place, const Atmosphere& air) {
  const Instant transit = sun_arc(noon, place, air).transit;
  const Instant begin = transit - hours(12), end = transit + hours(12);
  std::vector<SkyArc> arcs = sky_arcs(begin, end, place, air);
  if (arcs.size() == 1 && arcs[0].begin == begin && arcs[0].end == end) arcs[0].closed = true;
  return arcs;
}

Result<std::string> sun_path_svg(const SunPath& path) {
  if (path.days.empty()) return Error{"A sun-path diagram needs at least one day."};
  for (const SunPathDay& day : path.days) {
    if (!(day.begin < day.end)) {
      return Error{fmt::format(
          "The sun-path diagram of {} cannot be drawn: its window does not end after it begins.",
          day.label)};
    }
  }
  const Result<ClockTime> clock = utc_to_clock(path.zone, path.place, path.days[0].begin);
  if (!clock) return clock.error();
  const auto date = std::chrono::floor<std::chrono::days>(clock.value());
  const std::chrono::year year =
      std::chrono::year_month_day(std::chrono::sys_days(date.time_since_epoch())).year();

  std::string label = "Sun-path diagram: " + path.days[0].label;
  for (std::size_t k = 1; k < path.days.size(); ++k) label += "; " + path.days[k].label;
  Drawing d{"", path};
  const Instant middle = path.days[0].begin + (path.days[0].end - path.days[0].begin) / 2;
  const SunPosition noon =
      sun_position(sun_arc(middle, path.place, path.air).transit, path.place, path.air);
  draw_sky(d, std::cos(noon.azimuth) <= 0);
  const std::vector<std::string> below = draw_seasons(d, year);
  for (std::size_t k = 0; k < path.days.size(); ++k) {
    if (const auto failed = draw_day(d, path.days[k], kDayColours[k % kDayColours.size()]))
      return *failed;
  }
  const double height = draw_legend(d, year, below);
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" "
             "aria-label=\"{}\" font-family=\"sans-serif\">\n",
             kWidth, height, html_text(label)) +
         d.svg + "</svg>\n";
}

}  // namespace gnomon
