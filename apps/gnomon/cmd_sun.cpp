// gnomon sun: where the sun stands, when it rises and sets.
#include <fmt/format.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/profile/study_times.h>
#include <gnomon/sun/time_zone.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "commands.h"
#include "place_text.h"
#include "time_options.h"

namespace gnomon::app {

namespace {

struct Options {
  Common common;
  TimeOptions time;
  std::string site;
  std::string output;
  bool json = false;
  bool csv = false;
};

struct Row {
  Instant utc;
  SunPosition sun;
};

struct Report {
  Place place;
  StudyTimes times;
  LocalDay day;
  std::vector<Row> rows;
};

double degrees(double radians) { return radians / kDegree; }

// Degrees to `decimals`; a direction that rounds to 360 is 0.
double rounded(double radians, int decimals) {
  const double scale = std::pow(10.0, decimals);
  const double value = std::round(degrees(radians) * scale) / scale;
  return value == 360 ? 0 : value;
}

// "2024-09-18T09:00:00+02:00"; without an offset on the solar clock, which is none of the world's
// zones.
std::string local_text(const Report& report, Instant utc) {
  const ClockTime clock = utc_to_clock(report.times.zone, report.place, utc).value();
  std::string text = iso_text(clock);
  if (report.times.zone == "solar") return text;
  const auto offset = clock.time_since_epoch() - utc.time_since_epoch();
  const std::chrono::hh_mm_ss parts{std::chrono::duration_cast<std::chrono::seconds>(offset)};
  text += fmt::format("{}{:02}:{:02}", parts.is_negative() ? '-' : '+', parts.hours().count(),
                      parts.minutes().count());
  // Local mean times of the 19th century have seconds.
  if (parts.seconds().count() != 0) text += fmt::format(":{:02}", parts.seconds().count());
  return text;
}

// An instant and the clock at it, whole seconds: "2024-09-18 06:40:12".
std::string whole_seconds(std::string iso) {
  iso[10] = ' ';
  return iso.substr(0, 19);
}

std::string as_table(const Report& report) {
  const auto clock = [&](Instant utc) {
    return whole_seconds(iso_text(utc_to_clock(report.times.zone, report.place, utc).value()));
  };
  const double latitude = degrees(report.place.latitude),
               longitude = degrees(report.place.longitude);
  std::string text = fmt::format(
      "Sun at {:.6f} {}, {:.6f} {}, {:g} m above sea level; {}, clock: {}\n\n", std::abs(latitude),
      latitude < 0 ? "S" : "N", std::abs(longitude), longitude < 0 ? "W" : "E", report.place.height,
      report.times.date, report.times.zone);

  const SunDay& sun = report.day.sun;
  const auto event = [&](const char* name, const std::optional<Instant>& at) {
    if (at)
      text += fmt::format("{:8}  {}   {} UTC\n", name, clock(*at), whole_seconds(iso_text(*at)));
    else
      text += fmt::format("{:8}  none on this date\n", name);
  };
  event("sunrise", sun.sunrise);
  event("transit", sun.transit);
  event("sunset", sun.sunset);
  if (sun.polar_day) text += "polar day: the sun is up all day\n";
  if (sun.polar_night) text += "polar night: the sun is down all day\n";

  text += fmt::format("\n{:19}   {:19}   {:>10}   {:>18}   {:>17}\n", "clock", "UTC", "azimuth",
                      "altitude geometric", "altitude apparent");
  for (const Row& row : report.rows)
    text += fmt::format("{}   {}   {:>10.4f}   {:>18.4f}   {:>17.4f}\n", clock(row.utc),
                        whole_seconds(iso_text(row.utc)), rounded(row.sun.azimuth, 4),
                        degrees(row.sun.altitude_geometric), degrees(row.sun.altitude_apparent));
  const Atmosphere air;
  text += fmt::format(
      "\nazimuth: degrees from true north, clockwise\n"
      "altitude: degrees of the sun's centre above the horizon; apparent: with refraction at {:g} "
      "mbar, {:g} C\n"
      "sunrise, sunset: upper limb on the horizon, refraction {:.4f} degrees\n",
      air.pressure, air.temperature, degrees(air.horizon_refraction));
  return text;
}

std::string as_csv(const Report& report) {
  std::string text = "utc,local,azimuth_deg,altitude_geometric_deg,altitude_apparent_deg\n";
  for (const Row& row : report.rows)
    text += fmt::format("{},{},{:.6f},{:.6f},{:.6f}\n", iso_text(row.utc),
                        local_text(report, row.utc), rounded(row.sun.azimuth, 6),
                        degrees(row.sun.altitude_geometric), degrees(row.sun.altitude_apparent));
  return text;
}

std::string as_json(const Report& report) {
  using Json = nlohmann::ordered_json;
  // Degrees to nine decimals: far below the algorithm's 0.0003, and free of the last digits' noise.
  const auto nine = [](double radians) { return rounded(radians, 9); };
  const auto utc_or_null = [](const std::optional<Instant>& t) {
    return t ? Json(iso_text(*t)) : Json();
  };

  const SunDay& sun = report.day.sun;
  Json json;
  json["place"] = {{"latitude_deg", nine(report.place.latitude)},
                   {"longitude_deg", nine(report.place.longitude)},
                   {"height_m", report.place.height}};
  json["date"] = report.times.date;
  json["tz"] = report.times.zone;
  json["sunrise_utc"] = utc_or_null(sun.sunrise);
  json["transit_utc"] = iso_text(sun.transit);
  json["sunset_utc"] = utc_or_null(sun.sunset);
  json["polar"] = sun.polar_day ? Json("day") : sun.polar_night ? Json("night") : Json();
  json["positions"] = Json::array();
  for (const Row& row : report.rows)
    json["positions"].push_back({{"utc", iso_text(row.utc)},
                                 {"local", local_text(report, row.utc)},
                                 {"azimuth_deg", nine(row.sun.azimuth)},
                                 {"altitude_geometric_deg", nine(row.sun.altitude_geometric)},
                                 {"altitude_apparent_deg", nine(row.sun.altitude_apparent)}});
  json["version"] = GNOMON_VERSION;
  return json.dump(2) + "\n";
}

void run(const Options& options) {
  const std::optional<Place> place = parse_site(options.site);
  if (!place) throw Failure("no place given: add --site LAT,LON[,HEIGHT], as --site 48.2,16.37");

  Report report;
  report.place = *place;
  report.times = options.time.times;
  if (report.times.from.empty()) report.times.from = "00:00";
  if (report.times.to.empty()) report.times.to = "24:00";
  const StudyWindow window = take(study_window(report.times, *place));
  report.day = take(local_day(report.times.date, report.times.zone, *place));
  for (const Instant t : window.edges) report.rows.push_back({t, sun_position(t, *place)});

  const std::string text = options.json  ? as_json(report)
                           : options.csv ? as_csv(report)
                                         : as_table(report);
  if (options.output.empty())
    fmt::print("{}", text);
  else
    take(write_text_file(options.output, text));

  Warnings warnings = window.warnings;
  check_place(warnings, *place, report.times.zone);
  if (!options.common.quiet) print_warnings(warnings);
}

}  // namespace

void add_sun(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("sun", "Positions of the sun, sunrise, transit and sunset");
  add_site_option(*command, options->site);
  add_time_options(*command, options->time, Dates::kOne);
  command->get_option("--from")->description(
      "Begin on the local clock, HH:MM[:SS] (default: 00:00)");
  command->get_option("--to")->description("End on the local clock, HH:MM[:SS] (default: 24:00)");
  CLI::Option* json = command->add_flag("--json", options->json, "JSON")->group("Output");
  command->add_flag("--csv", options->csv, "CSV: one line for each position")
      ->excludes(json)
      ->group("Output");
  command->add_option("-o,--output", options->output, "File instead of the terminal")
      ->group("Output");
  add_common(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
