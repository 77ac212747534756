#include <gnomon/io/write_report.h>

#include <fmt/format.h>

#include <algorithm>

#include <gnomon/io/html.h>
#include <gnomon/io/report_style.h>
#include <gnomon/io/report_tables.h>
#include <gnomon/io/sun_path.h>

namespace gnomon {
namespace {

constexpr std::size_t kTallTable = 48;  // rows; more of them scroll in a box on the screen

std::string or_dash(const std::string& text) { return text.empty() ? "\u2013" : html_text(text); }

void add_facts(std::string& out, const ReportFacts& facts) {
  if (facts.empty()) return;
  out += "<dl>\n";
  for (const auto& [name, value] : facts)
    out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html_text(name), or_dash(value));
  out += "</dl>\n";
}

// Columns of nothing but numbers with their unit are set flush right.
bool is_number(const std::string& cell) {
  if (cell.empty() || cell == "\u2013") return true;
  return (cell[0] >= '0' && cell[0] <= '9') || cell[0] == '-' || cell[0] == '<' || cell[0] == '>';
}

std::vector<bool> number_columns(const ReportTable& table) {
  std::vector<bool> numbers(table.header.size(), !table.rows.empty());
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) numbers[c] = numbers[c] && is_number(row[c]);
  }
  return numbers;
}

// An SVG, because browsers do not print backgrounds.
std::string bar_svg(double share, const Rgb& colour) {
  return fmt::format(
      "<svg viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" aria-hidden=\"true\"><rect x=\"0\" "
      "y=\"0\" width=\"{:.2f}\" height=\"10\" fill=\"#{:02x}{:02x}{:02x}\" stroke=\"#55535c\" "
      "vector-effect=\"non-scaling-stroke\"/></svg>",
      100 * share, colour.r, colour.g, colour.b);
}

std::optional<Error> misfit(const ReportTable& table) {
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    if (table.rows[k].size() != table.header.size()) {
      return Error{fmt::format(
          "The report's table \"{}\" cannot be written: row {} has {} cells, its header {}.",
          table.title, k + 1, table.rows[k].size(), table.header.size())};
    }
  }
  if (!table.bars.empty() && table.bars.size() != table.rows.size()) {
    return Error{
        fmt::format("The report's table \"{}\" cannot be written: it has {} bars for {} rows.",
                    table.title, table.bars.size(), table.rows.size())};
  }
  return {};
}

std::optional<Error> add_table(std::string& out, const ReportTable& table) {
  if (auto failed = misfit(table)) return failed;
  const std::vector<bool> numbers = number_columns(table);
  double longest = 0;
  for (const ReportBar& bar : table.bars) longest = std::max(longest, bar.length);

  if (!table.title.empty()) out += fmt::format("<h3>{}</h3>\n", html_text(table.title));
  // A box that scrolls must be reached by keys.
  out +=
      fmt::format("<div class=\"{}\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">\n<table>\n",
                  table.rows.size() > kTallTable ? "box tall" : "box",
                  html_text(table.title.empty() ? "Table" : table.title));
  out += "<thead><tr>";
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    out += fmt::format("<th scope=\"col\"{}>{}</th>", numbers[c] ? " class=\"n\"" : "",
                       html_text(table.header[c]));
  }
  if (!table.bars.empty()) out += "<td class=\"bar\"></td>";
  out += "</tr></thead>\n<tbody>\n";
  const std::size_t every = std::max<std::size_t>(table.print_every, 1);
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    out += k % every == 0 ? "<tr>" : "<tr class=\"screen\">";
    for (std::size_t c = 0; c < table.header.size(); ++c)
      out +=
          fmt::format("<td{}>{}</td>", numbers[c] ? " class=\"n\"" : "", or_dash(table.rows[k][c]));
    if (!table.bars.empty()) {
      const ReportBar& bar = table.bars[k];
      out += fmt::format("<td class=\"bar\">{}</td>",
                         bar.length > 0 ? bar_svg(bar.length / longest, bar.colour) : "");
    }
    out += "</tr>\n";
  }
  out += "</tbody>\n</table>\n</div>\n";
  if (!table.note.empty()) out += fmt::format("<p class=\"note\">{}</p>\n", html_text(table.note));
  return {};
}

std::optional<Error> add_picture(std::string& out, const ReportPicture& picture) {
  const Result<EmbeddedPicture> png = embed_png(picture.png);
  if (!png) return png.error();
  const EmbeddedPicture& p = png.value();
  out += fmt::format("<figure>\n<img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\">\n", p.uri,
                     p.width, p.height,
                     html_text(picture.alt.empty() ? picture.caption : picture.alt));
  if (!picture.caption.empty())
    out += fmt::format("<figcaption>{}</figcaption>\n", html_text(picture.caption));
  out += "</figure>\n";
  return {};
}

std::optional<Error> add_sun(std::string& out, const Report& report, const ReportSection& section) {
  if (!section.sun_days.empty()) {
    const Result<std::string> svg =
        sun_path_svg({report.place, report.true_north, report.zone, report.air, section.sun_days});
    if (!svg) return svg.error();
    out += fmt::format(
        "<h3>Sun path</h3>\n<figure class=\"sun\">\n{}<figcaption>Sun-path diagram, equidistant: "
        "the centre is the zenith, the rim the horizon, and the distance from the rim is the "
        "sun\u2019s apparent altitude. True north is up, east at the right; {}. Hours are those of "
        "{}.</figcaption>\n</figure>\n",
        svg.value(), north_text(report.true_north),
        report.zone == "solar" ? "true solar time" : html_text(report.zone));
  }
  if (section.steps.empty()) return {};
  const Result<ReportTable> steps = steps_table(section.steps, report.zone, report.place);
  if (!steps) return steps.error();
  return add_table(out, steps.value());
}

std::optional<Error> add_section(std::string& out, const Report& report, std::size_t index) {
  const ReportSection& section = report.sections[index];
  out += fmt::format("<section class=\"date\" id=\"date-{}\">\n<h2>{}</h2>\n", index + 1,
                     html_text(section.title));
  add_facts(out, section.facts);
  if (!section.results.empty()) out += "<h3>Results</h3>\n";
  add_facts(out, section.results);
  for (const ReportTable& table : section.tables) {
    if (auto failed = add_table(out, table)) return failed;
  }
  for (const ReportPicture& picture : section.pictures) {
    if (auto failed = add_picture(out, picture)) return failed;
  }
  if (auto failed = add_sun(out, report, section)) return failed;
  for (const ReportTable& table : section.later_tables) {
    if (auto failed = add_table(out, table)) return failed;
  }
  out += "</section>\n";
  return {};
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void add_header(std::string& out, const Report& report) {
  out += fmt::format("<header>\n<h1>{}</h1>\n", or_dash(report.title));
  if (!report.subtitle.empty())
    out += fmt::format("<p class=\"subtitle\">{}</p>\n", html_text(report.subtitle));
  const Place& place = report.place;
  add_facts(out,
            {{"Place", fmt::format("{}, {} (WGS 84)", latitude_text(place.latitude),
                                   longitude_text(place.longitude))},
             {"Coordinates", report.crs.empty() ? "local metres, no reference system" : report.crs},
             {"North", north_text(report.true_north)},
             {"Clock", report.zone == "solar" ? "true solar time" : report.zone}});
  // The warnings stand at the end; nobody should miss them.
  out += fmt::format("<p><a href=\"#warnings\">{}</a></p>\n",
                     report.warnings.empty() ? "No warnings"
                                             : counted(report.warnings.size(), "kind") +
                                                   " of warning, listed at the end");
  if (report.sections.size() > 1) {
    out += "<nav class=\"screen\" aria-label=\"Dates\"><ul>\n";
    for (std::size_t k = 0; k < report.sections.size(); ++k) {
      out += fmt::format("<li><a href=\"#date-{}\">{}</a></li>\n", k + 1,
                         html_text(report.sections[k].title));
    }
    out += "</ul></nav>\n";
  }
  out += "</header>\n";
}

void add_method(std::string& out, const Report& report) {
  out += "<section>\n<h2>Method and definitions</h2>\n";
  out += fmt::format(
      "<p><b>Sun.</b> Its position is computed for the place and every step with the Solar "
      "Position "
      "Algorithm (I. Reda, A. Andreas, NREL/TP-560-34302, 2003, revised 2008; stated bound "
      "0.0003\u00b0); shadows use the apparent sun, a point in the centre of its disc, with "
      "standard "
      "refraction at {:g} mbar and {:g} \u00b0C, and while it is not above the level horizon it is "
      "night, which counts as neither shadow nor sun.</p>\n",
      report.air.pressure, report.air.temperature);
  out +=
      "<p><b>Hours.</b> The window is cut into steps, the sun at a step\u2019s midpoint stands for "
      "the whole step, and a sample\u2019s time in shadow is the sum of the lengths of the steps "
      "at "
      "which it is in shadow while the sun is up; its time of sun is the rest of the time the sun "
      "is "
      "up.</p>\n"
      "<p><b>Shadow.</b> A sample, the point of the model seen at a pixel\u2019s centre, is in "
      "shadow "
      "if a casting triangle lies between it and the sun or if its surface faces away from the "
      "sun; "
      "this is decided exactly for the model and the sun\u2019s direction as given, without "
      "tolerances, so that what remains uncertain is the model (its level of detail, ground and "
      "vegetation) and, near the horizon, refraction.</p>\n";
  for (const std::string& more : report.method) out += fmt::format("<p>{}</p>\n", html_text(more));
  out += "</section>\n";
}

std::optional<Error> add_warnings(std::string& out, const Warnings& warnings) {
  out += "<section id=\"warnings\">\n<h2>Warnings</h2>\n";
  if (warnings.empty()) {
    out += "<p>No warnings.</p>\n</section>\n";
    return {};
  }
  ReportTable table{"", {"Cases", "Warning", "First"}, {}};
  for (const Warning& w : warnings)
    table.rows.push_back({fmt::format("{}", w.count), w.what, w.first});
  if (auto failed = add_table(out, table)) return failed;
  out += "</section>\n";
  return {};
}

}  // namespace

Result<std::string> report_html(const Report& report) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"{}\">\n<title>{}{}{}</title>\n<style>\n{}</style>\n"
      "</head>\n<body>\n<main>\n",
      html_text(report.software), html_text(report.title.empty() ? "Shadow profile" : report.title),
      report.subtitle.empty() ? "" : ": ", html_text(report.subtitle), kReportStyle);
  add_header(out, report);
  for (std::size_t k = 0; k < report.sections.size(); ++k) {
    if (auto failed = add_section(out, report, k)) return *failed;
  }
  out += "<section class=\"inputs\">\n<h2>Inputs</h2>\n";
  for (const ReportTable& table : report.input_tables) {
    if (auto failed = add_table(out, table)) return *failed;
  }
  if (!report.inputs.empty()) out += "<h3>Options</h3>\n";
  add_facts(out, report.inputs);
  out += "</section>\n";
  add_method(out, report);
  if (auto failed = add_warnings(out, report.warnings)) return *failed;
  out += "</main>\n<footer>\n";
  if (!report.attribution.empty()) out += fmt::format("<p>{}</p>\n", html_text(report.attribution));
  out += fmt::format("<p>Made with {}.</p>\n</footer>\n</body>\n</html>\n",
                     html_text(report.software));
  return out;
}

Result<FileWritten> write_report(const std::filesystem::path& path, const Report& report) {
  const Result<std::string> html = report_html(report);
  if (!html) return html.error();
  return write_text_file(path, html.value());
}

}  // namespace gnomon
