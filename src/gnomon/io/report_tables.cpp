#include <gnomon/io/report_tables.h>
#include <gnomon/profile/hour_classes.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gnomon/io/colour_map.h>
#include <gnomon/io/plan_picture.h>
#include <gnomon/sun/time_zone.h>

namespace gnomon {
namespace {

constexpr std::size_t kMostPrinted = 45;  // rows: a page of A4 and what is left below the sun path
constexpr std::size_t kMostRows = 2000;   // some 250 kB of HTML

constexpr double kHour = 3.6e6;  // milliseconds

std::string hours_label(double hours) { return fmt::format("{:.6g}", hours); }

std::string area_text(double square_metres) {
  return fmt::format("{:.{}f}", square_metres, square_metres < 100 ? 2 : 0);
}

// 0.04 % is not nothing, and 99.96 % not all.
std::string share_text(double share) {
  if (share > 0 && share < 0.0005) return "< 0.1 %";
  if (share < 1 && share > 0.9995) return "> 99.9 %";
  return fmt::format("{:.1f} %", 100 * share);
}

// "2nd", "3rd", "11th", "21st".
std::string ordinal(std::size_t n) {
  const bool teen = n / 10 % 10 == 1;
  const std::size_t last = teen ? 0 : n % 10;
  return fmt::format("{}{}", n, last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th");
}

const char* compass(double azimuth) {
  static constexpr const char* kNames[] = {"N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE",
                                           "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"};
  return kNames[static_cast<std::size_t>(std::lround(azimuth / (kPi / 8))) % 16];
}

// "2024-09-18T09:30:00" without the parts that are the same for all.
std::string clock_text(const std::string& iso, bool date, bool seconds) {
  const std::string time = iso.substr(11, seconds ? 8 : 5);
  return date ? iso.substr(0, 10) + " " + time : time;
}

// To the second, each as short as all of them allow.
std::vector<std::string> short_texts(const std::vector<std::string>& iso) {
  bool date = false, seconds = false;
  for (const std::string& t : iso) {
    date = date || t.substr(0, 10) != iso.front().substr(0, 10);
    seconds = seconds || t.substr(17, 2) != "00";
  }
  std::vector<std::string> out;
  out.reserve(iso.size());
  for (const std::string& t : iso) out.push_back(clock_text(t, date, seconds));
  return out;
}

}  // namespace

std::string duration_text(double milliseconds) {
  const std::int64_t seconds = std::llround(milliseconds / 1000);
  const std::int64_t h = seconds / 3600, min = seconds / 60 % 60, s = seconds % 60;
  if (seconds == 0) return "0 h";
  std::string out;
  if (h > 0) out = fmt::format("{} h", h);
  if (min > 0 || (h > 0 && s > 0))
    out += h > 0 ? fmt::format(" {:02} min", min) : fmt::format("{} min", min);
  if (s > 0) out += out.empty() ? fmt::format("{} s", s) : fmt::format(" {:02} s", s);
  return out;
}

std::string north_text(double true_north) {
  // The grid's north lies at the azimuth -true_north.
  const double degrees = std::abs(true_north) / kDegree;
  if (degrees < 0.005) return "grid north (+y of the model) is true north, to 0.01\u00b0";
  return fmt::format("grid north (+y of the model) lies {:.2f}\u00b0 {} of true north", degrees,
                     true_north > 0 ? "west" : "east");
}

std::string latitude_text(double radians) {
  return fmt::format("{:.5f}\u00b0 {}", std::abs(radians) / kDegree, radians < 0 ? "S" : "N");
}

std::string longitude_text(double radians) {
  return fmt::format("{:.5f}\u00b0 {}", std::abs(radians) / kDegree, radians < 0 ? "W" : "E");
}

ReportTable hours_table(const Profile& profile, double sample_area, std::uint64_t step_ms) {
  const double daylight = daylight_hours(profile), step = static_cast<double>(step_ms) / kHour;
  std::vector<std::size_t> counts(classes(profile, step_ms));
  std::size_t samples = 0;
  for (std::size_t k = 0; k < profile.valid.size(); ++k) {
    if (profile.valid[k] == 0) continue;
    ++samples;
    ++counts[class_of(profile, k, step_ms, counts.size())];
  }
  const double all = static_cast<double>(std::max<std::size_t>(samples, 1));

  ReportTable table;
  table.title = "Area by hours in shadow";
  table.header = {profile.days > 1 ? "Hours in shadow per day" : "Hours in shadow"};
  if (sample_area > 0) table.header.push_back("Area, m\u00b2");
  table.header.push_back("Share");
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double from = static_cast<double>(k) * step;
    const double to = k + 1 < counts.size() ? from + step : daylight;
    std::vector<std::string> row;
    row.push_back(
        fmt::format("{} to {} h", hours_label(from), hours_label(std::round(100 * to) / 100)));
    const double count = static_cast<double>(counts[k]);
    if (sample_area > 0) row.push_back(area_text(count * sample_area));
    row.push_back(share_text(count / all));
    table.rows.push_back(std::move(row));
    table.bars.push_back({count, hours_colour(daylight > 0 ? (from + to) / 2 / daylight : 0)});
  }
  table.note = fmt::format(
      "A class holds its lower bound and not its upper one; the last holds both. {} samples on "
      "receiving surfaces",
      samples);
  if (sample_area > 0) {
    table.note += fmt::format(", {} m\u00b2 each, as seen from above: {} m\u00b2",
                              fmt::format("{:.4g}", sample_area),
                              area_text(static_cast<double>(samples) * sample_area));
  }
  const std::size_t empty = profile.valid.size() - samples;
  table.note += empty == 0 ? "." : fmt::format("; {} others are not counted.", empty);
  return table;
}

ReportTable objects_table(const Profile& profile, double sample_area,
                          const std::vector<ObjectHours>& objects) {
  // Rows that a reader looks through; the file has all.
  constexpr std::size_t kMostObjects = 30;
  const double ms_per_tick = static_cast<double>(profile.tick_ms) / profile.days;
  std::vector<const ObjectHours*> order;
  for (std::size_t k = 1; k < objects.size(); ++k) order.push_back(&objects[k]);
  const auto mean_ticks = [](const ObjectHours& o) {
    return static_cast<double>(o.ticks) / static_cast<double>(o.samples);
  };
  std::stable_sort(order.begin(), order.end(), [&](const ObjectHours* a, const ObjectHours* b) {
    return mean_ticks(*a) > mean_ticks(*b);
  });
  ReportTable table;
  table.title = "Receiving objects, longest in shadow first";
  table.header = {"Object", "Area, m\u00b2", "Least", "Mean", "Longest"};
  for (const ObjectHours* o : order) {
    if (table.rows.size() == kMostObjects) break;
    table.rows.push_back({o->object, area_text(static_cast<double>(o->samples) * sample_area),
                          duration_text(o->least * ms_per_tick),
                          duration_text(mean_ticks(*o) * ms_per_tick),
                          duration_text(o->most * ms_per_tick)});
  }
  table.note = order.size() > kMostObjects
                   ? fmt::format("The first {} of {} objects; all are in objects.csv.",
                                 kMostObjects, order.size())
                   : "The same figures are in objects.csv.";
  return table;
}

ReportFacts hours_facts(const Profile& profile) {
  std::size_t samples = 0, never = 0, always = 0;
  double sum = 0;
  std::uint32_t longest = 0;
  for (std::size_t k = 0; k < profile.valid.size(); ++k) {
    if (profile.valid[k] == 0) continue;
    ++samples;
    sum += profile.shadow_ticks[k];
    longest = std::max(longest, profile.shadow_ticks[k]);
    never += profile.shadow_ticks[k] == 0 ? 1 : 0;
    always += profile.shadow_ticks[k] == profile.daylight_ticks ? 1 : 0;
  }
  const double ms_per_tick = static_cast<double>(profile.tick_ms) / profile.days;
  const double daylight = profile.daylight_ticks * ms_per_tick;
  const std::string per_day = profile.days > 1 ? " per day" : "";
  ReportFacts facts{
      {"Sun above the horizon" + per_day, duration_text(daylight) + " of the window"}};
  if (samples == 0) {
    facts.emplace_back("Time in shadow", "no sample meets a surface");
    return facts;
  }
  const double all = static_cast<double>(samples);
  const double mean = sum / all * ms_per_tick;
  facts.emplace_back("Mean time in shadow" + per_day,
                     fmt::format("{} ({:.1f} % of the daylight)", duration_text(mean),
                                 daylight > 0 ? 100 * mean / daylight : 0.0));
  facts.emplace_back("Mean time of sun" + per_day, duration_text(daylight - mean));
  facts.emplace_back("Longest time in shadow" + per_day, duration_text(longest * ms_per_tick));
  facts.emplace_back("Never in shadow",
                     share_text(static_cast<double>(never) / all) + " of the area");
  facts.emplace_back("Always in shadow",
                     share_text(static_cast<double>(always) / all) + " of the area");
  return facts;
}

Result<ReportTable> steps_table(const std::vector<TimeSample>& steps, const std::string& zone,
                                const Place& place) {
  ReportTable table;
  table.title = "Steps and positions of the sun";
  table.header = {zone == "solar" ? "Solar time" : "Clock, " + zone,
                  "UTC",
                  "Azimuth",
                  "Altitude",
                  "Direction",
                  "Horizon",
                  "Step"};
  const std::size_t stride = std::max<std::size_t>(1, (steps.size() + kMostRows - 1) / kMostRows);
  std::vector<std::string> clock, utc;
  for (std::size_t k = 0; k < steps.size(); k += stride) {
    const auto second = std::chrono::round<std::chrono::seconds>(steps[k].utc);
    const Result<ClockTime> local = utc_to_clock(zone, place, steps[k].utc);
    if (!local) return local.error();
    clock.push_back(iso_text(ClockTime(std::chrono::round<std::chrono::seconds>(local.value()))));
    utc.push_back(iso_text(Instant(second)));
  }
  clock = short_texts(clock);
  utc = short_texts(utc);
  std::size_t down = 0;
  for (const TimeSample& s : steps) down += s.up ? 0 : 1;
  for (std::size_t k = 0, row = 0; k < steps.size(); k += stride, ++row) {
    const TimeSample& s = steps[k];
    table.rows.push_back(
        {clock[row], utc[row], fmt::format("{:.2f}\u00b0", s.sun.azimuth / kDegree),
         fmt::format("{:.2f}\u00b0", s.sun.altitude_apparent / kDegree), compass(s.sun.azimuth),
         s.up ? "above" : "below, not counted", duration_text(s.weight_ms)});
  }
  table.note =
      "Times are the midpoints of the steps. Azimuth from true north, clockwise; altitude of the "
      "sun's centre with refraction.";
  if (down > 0)
    table.note +=
        fmt::format(" In {} of {} steps the sun is below the horizon.", down, steps.size());
  table.print_every = (table.rows.size() + kMostPrinted - 1) / kMostPrinted;
  table.print_every = std::max<std::size_t>(table.print_every, 1);
  if (stride > 1) {
    table.note += fmt::format(" Every {} of {} steps is listed; summary.json has all of them.",
                              ordinal(stride), steps.size());
  }
  if (table.print_every > 1) {
    table.note +=
        fmt::format(" On paper every {} row of {} is printed; the file has {}.",
                    ordinal(table.print_every), table.rows.size(), stride > 1 ? "more" : "all");
  }
  return table;
}

ReportTable files_table(const std::vector<FileReport>& files) {
  ReportTable table;
  table.title = "Model files";
  table.header = {"File", "Format", "CRS", "LoD", "Objects", "Polygons", "Triangles"};
  for (const FileReport& f : files) {
    std::string lod = f.lod_used;
    if (f.lods.size() > 1) {
      lod += " (of ";
      for (std::size_t k = 0; k < f.lods.size(); ++k) lod += (k == 0 ? "" : ", ") + f.lods[k];
      lod += ")";
    }
    table.rows.push_back({f.path, f.format, f.crs, lod, fmt::format("{}", f.objects),
                          fmt::format("{}", f.surfaces), fmt::format("{}", f.triangles)});
    if (f.stored_twice > 0) {
      table.note += fmt::format("{}{}: {} polygons stored twice were taken once.",
                                table.note.empty() ? "" : " ", f.path, f.stored_twice);
    }
  }
  return table;
}

}  // namespace gnomon
