#include <gnomon/io/html.h>
#include <gnomon/io/png.h>
#include <gnomon/io/report_tables.h>
#include <gnomon/io/write_report.h>
#include <gtest/gtest.h>
#include <io/write_test_files.h>

#include <string>
#include <vector>

namespace gnomon {
namespace {

using testing::content;
using testing::TestFolder;

const Place kVienna{48.2 * kDegree, 16.37 * kDegree, 171};
constexpr std::uint32_t kHour = 3600000;  // milliseconds

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// Every element that is opened is closed, in order. Attributes hold no ">" where they are escaped.
::testing::AssertionResult balanced(const std::string& html) {
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return ::testing::AssertionFailure() << "a tag has no end";
    const bool closing = html[at + 1] == '/';
    const std::size_t begin = at + (closing ? 2 : 1);
    const std::string name = html.substr(begin, html.find_first_of(" >/", begin) - begin);
    if (name == "!DOCTYPE" || name == "meta" || name == "img" || html[end - 1] == '/') continue;
    if (!closing) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return ::testing::AssertionFailure() << "</" << name << "> closes nothing";
    } else {
      open.pop_back();
    }
  }
  if (!open.empty()) return ::testing::AssertionFailure() << open.back() << " is not closed";
  return ::testing::AssertionSuccess();
}

Samples study(const std::string& every) {
  return study_samples({"2024-09-18", "09:00", "17:00", every, "Europe/Vienna"}, kVienna, 0)
      .value();
}

// A report with everything in it, `name` wherever a text goes.
Report full(const TestFolder& folder, const std::string& name) {
  EXPECT_TRUE(write_png(folder / "plan.png", {2, 1, {{255, 0, 0}, {0, 0, 255}}}));
  Report r;
  r.title = r.subtitle = r.software = r.attribution = r.crs = name;
  r.place = kVienna;
  r.zone = "Europe/Vienna";
  r.inputs = {{name, name}, {"lod", ""}};
  r.input_tables = {{name, {name, "n"}, {{name, "1"}}, name}};
  r.warnings = {{name, 3, name}};
  r.method = {name};
  ReportSection s;
  s.title = name;
  s.facts = s.results = {{name, name}};
  s.tables = {{name, {name}, {{name}}, name, {{1, {1, 2, 3}}}}};
  s.pictures = {{folder / "plan.png", name}};
  const Samples samples = study("1h");
  s.sun_days = {{s.title, samples.begin, samples.end, samples.midpoints}};
  s.steps = samples.midpoints;
  r.sections = {s};
  return r;
}

Profile profile(std::vector<std::uint32_t> ticks, std::vector<std::uint8_t> valid,
                std::uint32_t daylight) {
  Profile p;
  p.width = static_cast<int>(ticks.size());
  p.height = 1;
  p.shadow_ticks = std::move(ticks);
  p.valid = std::move(valid);
  p.daylight_ticks = daylight;
  return p;
}

TEST(HtmlText, EscapesMarkupAndReplacesWhatIsNotText) {
  EXPECT_EQ(html_text("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;");
  EXPECT_EQ(html_text("Stra\u00dfe \u2013 \U0001F31E\t\n"), "Stra\u00dfe \u2013 \U0001F31E\t\n");
  const std::string r = "\xEF\xBF\xBD";
  EXPECT_EQ(html_text("a\xffz"), "a" + r + "z");
  EXPECT_EQ(html_text("\xC0\xAF"), r + r);          // overlong
  EXPECT_EQ(html_text("\xED\xA0\x80"), r + r + r);  // a surrogate
  EXPECT_EQ(html_text("\xE2\x82"), r);              // cut off at the end
  EXPECT_EQ(html_text("\xE2\x82<"), r + "&lt;");    // swallows no markup
  EXPECT_EQ(html_text("\xF4\x90\x80\x80"), r + r + r + r);
  EXPECT_EQ(html_text(std::string_view("a\0b\x1b\x7f", 5)), "a" + r + "b" + r + r);
  EXPECT_EQ(html_text("\xC2\x85\xEF\xBF\xBE"), r + r);  // C1 control, noncharacter
}

TEST(Base64, GivesTheExamplesOfItsRfc) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xff\xfe"), "///+");
}

TEST(Report, EmbedsPicturesWholeWithTheirSize) {
  const TestFolder folder;
  const std::string html = report_html(full(folder, "x")).value();
  EXPECT_TRUE(has(html, "src=\"data:image/png;base64," + base64(content(folder / "plan.png"))));
  EXPECT_TRUE(has(html, "width=\"2\" height=\"1\" alt=\"x\""));
}

TEST(Report, AsksForNothingOutsideOfItself) {
  const TestFolder folder;
  const std::string html = report_html(full(folder, "x")).value();
  for (const char* part : {"<script", "<link", "@import", "url(", "src=\"http", "href=\"http"})
    EXPECT_FALSE(has(html, part)) << part;
  EXPECT_EQ(count(html, "http"), count(html, "http://www.w3.org/2000/svg"));  // a namespace's name
}

TEST(Report, HostileNamesStayText) {
  const TestFolder folder;
  const std::string name =
      "</title></style></main><script>alert(1)</script>\" onload='x' &amp; \xff";
  const Result<std::string> html = report_html(full(folder, name));
  ASSERT_TRUE(html);
  EXPECT_FALSE(has(html.value(), "<script"));
  EXPECT_FALSE(has(html.value(), "\" onload"));
  EXPECT_FALSE(has(html.value(), "\xff"));
  EXPECT_EQ(count(html.value(), "<title>"), 1U);
  EXPECT_EQ(count(html.value(), "</style>"), 1U);
  EXPECT_TRUE(has(html.value(), "&amp;amp; \xEF\xBF\xBD"));
  EXPECT_TRUE(balanced(html.value()));
}

TEST(Report, IsBalancedAndNamesItsLanguageEncodingAndViewport) {
  const TestFolder folder;
  const std::string html = report_html(full(folder, "x")).value();
  EXPECT_TRUE(balanced(html));
  for (const char* part : {"<!DOCTYPE html>\n<html lang=\"en\">", "<meta charset=\"utf-8\">",
                           "name=\"viewport\"", "@page", "size: A4", "<figcaption>"})
    EXPECT_TRUE(has(html, part)) << part;
}

TEST(Report, SaysWarningsAtTheTopAndListsAll) {
  const TestFolder folder;
  Report r = full(folder, "x");
  r.warnings = {{"Walls were left out.", 3, "house 7"}, {"Steps are short.", 1, ""}};
  const std::string html = report_html(r).value();
  EXPECT_TRUE(has(html, "2 kinds of warning, listed at the end"));
  EXPECT_TRUE(has(html, "<td class=\"n\">3</td><td>Walls were left out.</td><td>house 7</td>"));
  EXPECT_TRUE(has(html, "Steps are short."));
  r.warnings.clear();
  EXPECT_TRUE(has(report_html(r).value(), "<p>No warnings.</p>"));
}

TEST(Report, HasAChapterForEveryDateAndLinksToThem) {
  const TestFolder folder;
  Report r = full(folder, "x");
  r.sections.push_back(r.sections[0]);
  r.sections[1].title = "21 December";
  const std::string html = report_html(r).value();
  EXPECT_EQ(count(html, "class=\"date\""), 2U);
  EXPECT_TRUE(has(html, "<a href=\"#date-2\">21 December</a>"));
  EXPECT_EQ(count(html, "<svg xmlns"), 2U);
}

TEST(Report, NamesTheTableThatDoesNotFit) {
  const TestFolder folder;
  Report r = full(folder, "x");
  r.input_tables = {{"Files", {"a", "b"}, {{"1"}}}};
  const Result<std::string> cells = report_html(r);
  ASSERT_FALSE(cells);
  EXPECT_TRUE(has(cells.error().message, "\"Files\"")) << cells.error().message;
  r.input_tables = {{"Chart", {"a"}, {{"1"}}, "", {{1, {}}, {1, {}}}}};
  const Result<std::string> bars = report_html(r);
  ASSERT_FALSE(bars);
  EXPECT_TRUE(has(bars.error().message, "\"Chart\"")) << bars.error().message;
}

TEST(Report, WritesNothingWhereAPictureIsMissingOrNoPng) {
  const TestFolder folder;
  Report r = full(folder, "x");
  r.sections[0].pictures[0].png = folder / "none.png";
  const Result<FileWritten> missing = write_report(folder / "report.html", r);
  ASSERT_FALSE(missing);
  EXPECT_TRUE(has(missing.error().message, "none.png")) << missing.error().message;
  ASSERT_TRUE(write_text_file(folder / "none.png", "GIF89a"));
  const Result<FileWritten> other = write_report(folder / "report.html", r);
  ASSERT_FALSE(other);
  EXPECT_TRUE(has(other.error().message, "not a PNG")) << other.error().message;
  EXPECT_FALSE(std::filesystem::exists(folder / "report.html"));
}

TEST(Report, IsTheSameBytesEachTime) {
  const TestFolder folder;
  const Report r = full(folder, "x");
  ASSERT_TRUE(write_report(folder / "a.html", r));
  EXPECT_EQ(content(folder / "a.html"), report_html(r).value());
}

TEST(HoursTable, CountsEverySampleOnce) {
  // The last sample has no surface.
  const ReportTable t = hours_table(profile({0, 1, kHour, kHour + 1, 2 * kHour, 5 * kHour / 2, 0},
                                            {1, 1, 1, 1, 1, 1, 0}, 5 * kHour / 2),
                                    4, kHour / 4);
  ASSERT_EQ(t.rows.size(), 10U);  // quarters of an hour
  double all = 0;
  for (const ReportBar& bar : t.bars) all += bar.length;
  EXPECT_EQ(all, 6);
  EXPECT_EQ(t.rows[0], (std::vector<std::string>{"0 to 0.25 h", "8.00", "33.3 %"}));
  EXPECT_EQ(t.bars[3].length, 0);
  EXPECT_EQ(t.bars[4].length, 2);  // exactly one hour belongs to [1, 1.25)
  EXPECT_EQ(t.rows[9][0], "2.25 to 2.5 h");
  EXPECT_EQ(t.bars[9].length, 1);  // the last class includes its end
  EXPECT_TRUE(has(t.note, "1 others are not counted"));
}

TEST(HoursTable, IsPerDayOverSeveralDays) {
  // Two days of 2 h in ticks of a second: 1 h in all is half an hour per day.
  Profile p = profile({3600}, {1}, 14400);
  p.tick_ms = 1000;
  p.days = 2;
  const ReportTable t = hours_table(p, 1, kHour / 4);
  ASSERT_EQ(t.rows.size(), 8U);
  EXPECT_EQ(t.rows[2][0], "0.5 to 0.75 h");
  EXPECT_EQ(t.bars[2].length, 1);
  EXPECT_TRUE(has(t.header[0], "per day"));
  EXPECT_EQ(hours_facts(p)[1].second, "30 min (25.0 % of the daylight)");
}

TEST(HoursTable, HasNoAreaForACamera) {
  EXPECT_EQ(hours_table(profile({0}, {1}, kHour), 0, kHour).header.size(), 2U);
}

TEST(HoursFacts, GiveMeanLongestAndShares) {
  const ReportFacts f = hours_facts(profile({0, 2 * kHour, 0}, {1, 1, 0}, 2 * kHour));
  EXPECT_EQ(f[1].second, "1 h (50.0 % of the daylight)");
  EXPECT_EQ(f[3].second, "2 h");
  EXPECT_EQ(f[5].second, "50.0 % of the area");
  EXPECT_EQ(hours_facts(profile({0}, {0}, kHour))[1].second, "no sample meets a surface");
}

TEST(StepsTable, ShowsClockUtcAndSun) {
  const ReportTable t = steps_table(study("1h").midpoints, "Europe/Vienna", kVienna).value();
  ASSERT_EQ(t.rows.size(), 8U);
  EXPECT_EQ(t.rows[0][0], "09:30");
  EXPECT_EQ(t.rows[0][1], "07:30");
  EXPECT_EQ(t.rows[0][4], "ESE");
  EXPECT_EQ(t.rows[0][5], "above");
  EXPECT_EQ(t.print_every, 1U);
}

TEST(StepsTable, ThinsLongTablesAndSaysSo) {
  const ReportTable minutes =
      steps_table(study("1min").midpoints, "Europe/Vienna", kVienna).value();
  EXPECT_EQ(minutes.rows.size(), 480U);
  EXPECT_EQ(minutes.print_every, 11U);
  EXPECT_TRUE(has(minutes.note, "On paper every 11th row"));
  const ReportTable pairs = steps_table(study("6min").midpoints, "Europe/Vienna", kVienna).value();
  EXPECT_TRUE(has(pairs.note, "every 2nd row"));
  const ReportTable seconds = steps_table(study("1s").midpoints, "Europe/Vienna", kVienna).value();
  EXPECT_LE(seconds.rows.size(), 2000U);
  EXPECT_TRUE(has(seconds.note, "28800 steps"));
}

TEST(ReportTexts, NameHemispheresDurationsAndNorth) {
  EXPECT_EQ(latitude_text(-33.9 * kDegree), "33.90000\u00b0 S");
  EXPECT_EQ(longitude_text(-70 * kDegree), "70.00000\u00b0 W");
  EXPECT_EQ(duration_text(0), "0 h");
  EXPECT_EQ(duration_text(7500000), "2 h 05 min");
  EXPECT_EQ(duration_text(750000), "12 min 30 s");
  EXPECT_EQ(duration_text(3630000), "1 h 00 min 30 s");
  // True north clockwise of the grid's: the grid's lies counter-clockwise, west, of it.
  EXPECT_TRUE(has(north_text(kDegree), "1.00\u00b0 west"));
  EXPECT_TRUE(has(north_text(-kDegree), "1.00\u00b0 east"));
}

}  // namespace
}  // namespace gnomon
