// report.html: a study as one self-contained page, to be read on a phone, printed on A4 and handed
// to an authority. Plain values in, a file out; nothing is computed here but the sun's arcs.
//
// The page needs no script, no font and no other file: style, pictures (base64) and diagrams (SVG)
// stand in it. All texts are given as UTF-8 and escaped here; what is not UTF-8 shows as U+FFFD.
// Order on the page: title, place; per date its facts, results, tables, pictures, sun-path diagram
// and steps; inputs, method, warnings, software. The same values give the same bytes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/picture.h>
#include <gnomon/io/sun_path.h>
#include <gnomon/profile/study_times.h>
#include <gnomon/sun/sun.h>

namespace gnomon {

// Name and value, in the order in which they are shown. An empty value is shown as a dash.
using ReportFacts = std::vector<std::pair<std::string, std::string>>;

// A horizontal bar at the end of a table's row; bars of a table are drawn to the same scale, the
// longest across its whole column.
struct ReportBar {
  double length = 0;  // >= 0, any unit
  Rgb colour;
};

struct ReportTable {
  std::string title;                           // may be empty
  std::vector<std::string> header;             // one per column
  std::vector<std::vector<std::string>> rows;  // each as long as the header
  std::string note = {};                       // a sentence below; may be empty
  std::vector<ReportBar> bars = {};            // none, or one per row
  // On paper every k-th row alone (the screen has all, in a box that scrolls where there are many);
  // `note` should say so.
  std::size_t print_every = 1;
};

struct ReportPicture {
  std::filesystem::path png;  // embedded as it is
  std::string caption;
  std::string alt = {};  // for those who do not see it; empty: the caption
};

// One date.
struct ReportSection {
  std::string title;                // "18 September 2024"
  ReportFacts facts;                // window, steps, daylight
  ReportFacts results;              // key results: mean, longest, ...
  std::vector<ReportTable> tables;  // hours_table() first, see report_tables.h
  std::vector<ReportPicture> pictures;
  std::vector<ReportTable> later_tables = {};  // after pictures, sun path and steps: long ones
  std::vector<SunPathDay> sun_days;            // of the sun-path diagram; none: no diagram
  std::vector<TimeSample> steps;               // midpoints of the steps; empty: no table of them
};

struct Report {
  std::string title;        // "Vienna"
  std::string subtitle;     // "Shadow profile, 18 September 2024, 09:00 - 17:00 Europe/Vienna"
  std::string software;     // "gnomon 0.1.0"
  std::string attribution;  // whom the model comes from; may be empty
  Place place;              // of the scene's origin
  double true_north = 0;    // as Frame::true_north, radians
  std::string crs;          // "EPSG:31256 (MGI / Austria GK East)"; empty: local coordinates
  std::string zone;         // as in time_zone.h
  Atmosphere air = {};      // with which the steps' sun positions were computed
  std::vector<ReportSection> sections;    // dates in their order
  ReportFacts inputs;                     // every option
  std::vector<ReportTable> input_tables;  // files_table(), who casts and receives, ...
  std::vector<std::string> method = {};   // sentences after the standard ones
  Warnings warnings;                      // all; none is said to be none
};

// The page's text. Errors: a picture that is not there or no PNG; a table whose rows or bars do not
// fit its header (names it); as sun_path_svg.
Result<std::string> report_html(const Report& report);

// Atomically. Errors: as report_html and AtomicFile.
Result<FileWritten> write_report(const std::filesystem::path& path, const Report& report);

}  // namespace gnomon
