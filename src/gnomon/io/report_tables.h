// Tables of a report from what the other rooms hand over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gnomon/io/load_scene.h>
#include <gnomon/io/write_report.h>
#include <gnomon/io/write_summary_csv.h>
#include <gnomon/profile/profile.h>

namespace gnomon {

// How many samples are in shadow for how long, as a bar chart: the classes of hour_classes.h, those
// of summary.csv. `sample_area`: square metres of ground that a sample of a plan stands for; 0
// where it has no such area (cameras): shares alone. Samples without a surface are not counted; the
// note says how many. Preconditions: the profile's vectors have width * height elements; step_ms >
// 0.
ReportTable hours_table(const Profile& profile, double sample_area, std::uint64_t step_ms);

// The objects of hours_by_object(), those longest in shadow first, thirty at most.
ReportTable objects_table(const Profile& profile, double sample_area,
                          const std::vector<ObjectHours>& objects);

// "Mean time in shadow", "Longest", ...: the key figures beside it, in hours and minutes.
ReportFacts hours_facts(const Profile& profile);

// The steps' times and sun positions. More rows than print well are thinned on paper, more than a
// page can hold (2000) in the file as well; the note says so. Errors: as utc_to_clock.
Result<ReportTable> steps_table(const std::vector<TimeSample>& steps, const std::string& zone,
                                const Place& place);

// Format, CRS, LoD, objects, polygons and triangles of each file.
ReportTable files_table(const std::vector<FileReport>& files);

// "2 h 05 min", "45 min", "12 min 30 s", "0 h"; rounded to the second.
std::string duration_text(double milliseconds);

// Grid north against true north, in a sentence.
std::string north_text(double true_north);

// "48.20817° N".
std::string latitude_text(double radians);
std::string longitude_text(double radians);

}  // namespace gnomon
