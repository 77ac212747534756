#include "time_options.h"

#include <charconv>
#include <string_view>
#include <vector>

#include "commands.h"

namespace gnomon::app {

namespace {

std::optional<double> read_number(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

}  // namespace

void add_time_options(CLI::App& command, TimeOptions& options, Dates dates) {
  StudyTimes& times = options.times;
  if (dates == Dates::kOne) {
    command.add_option("--date", times.date, "Date on the local calendar, YYYY-MM-DD")
        ->group("Time");
  } else {
    command
        .add_option(
            "--date", options.dates,
            "YYYY-MM-DD on the local calendar; or a range whose hours are the mean per day, "
            "YYYY-MM-DD..YYYY-MM-DD, of every 7th day with /7d; may be repeated, one "
            "folder of results each")
        ->type_name("DATE[..DATE[/Nd]]")
        ->allow_extra_args(false)  // else MODEL... after it would count as dates
        ->group("Time");
  }
  command
      .add_option("--from", times.from, "Begin on the local clock, HH:MM[:SS] (default: sunrise)")
      ->group("Time");
  command.add_option("--to", times.to, "End on the local clock, HH:MM[:SS] (default: sunset)")
      ->group("Time");
  command.add_option("--every", times.every, "Step: 1h, 30min, 90s, 1h30min")
      ->capture_default_str()
      ->group("Time");
  command
      .add_option("--tz", times.zone,
                  "Clock: an IANA time zone (Europe/Vienna), UTC, or solar (true solar time)")
      ->group("Time");
}

void add_site_option(CLI::App& command, std::string& site) {
  command
      .add_option(
          "--site", site,
          "Place LAT,LON[,HEIGHT]: degrees, north and east positive; metres above sea level")
      ->group("Place");
}

std::optional<Place> parse_site(const std::string& text) {
  if (text.empty()) return {};
  std::vector<double> numbers;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const auto number = read_number(rest.substr(0, comma));
    if (!number) {
      numbers.clear();
      break;
    }
    numbers.push_back(*number);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (numbers.size() != 2 && numbers.size() != 3)
    throw Failure("--site '" + text +
                  "' cannot be read: write LAT,LON or LAT,LON,HEIGHT in degrees and metres, as "
                  "48.2,16.37,171");

  const double latitude = numbers[0], longitude = numbers[1];
  const double height = numbers.size() == 3 ? numbers[2] : 0.0;
  // Written so that a NaN fails as well.
  if (!(latitude >= -90 && latitude <= 90))
    throw Failure("--site '" + text +
                  "': the latitude is not between -90 and 90 degrees (latitude comes first)");
  if (!(longitude >= -180 && longitude <= 180))
    throw Failure("--site '" + text + "': the longitude is not between -180 and 180 degrees");
  if (!(height >= -500 && height <= 10000))
    throw Failure("--site '" + text + "': the height is not between -500 and 10000 metres");
  return Place{latitude * kDegree, longitude * kDegree, height};
}

}  // namespace gnomon::app
