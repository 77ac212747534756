// summary.csv, objects.csv: areas per class of hours, hours per receiving object; for plans.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/profile/profile.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/receivers.h>

namespace gnomon {

// The samples of one receiving object, or of all together.
struct ObjectHours {
  std::string object;                  // see hours_by_object()
  std::vector<std::uint64_t> classes;  // samples per class of hours, see profile/hour_classes.h
  std::uint64_t samples = 0;
  std::uint64_t ticks = 0;            // of all samples together
  std::uint32_t least = 0, most = 0;  // ticks of a sample
};

// First "(all)", then the objects that have samples, in the order in which the scene names them.
// Parts count with their parent (Surface::whole). Surfaces without an object are "(no name)"
// together. Preconditions: receivers are the profile's, step_ms > 0.
std::vector<ObjectHours> hours_by_object(const Profile& profile, const Receivers& receivers,
                                         const Scene& scene, std::uint64_t step_ms);

// summary.csv: object, class_from_h, class_to_h, area_m2, samples; every class of every object,
// hours of shadow per day, from included, to not, but in the last class. Areas are those seen from
// above: samples times the pixel's area. Quotes as in RFC 4180, lines end with \n, UTF-8 as the
// model has it. Precondition: a plan. Errors: as write_text_file.
Result<FileWritten> write_summary_csv(const std::filesystem::path& path, const Profile& profile,
                                      const View& plan, const std::vector<ObjectHours>& objects,
                                      std::uint64_t step_ms);

// objects.csv: object, area_m2, samples, min_shadow_h, mean_shadow_h, max_shadow_h; hours per day,
// empty where there is no sample. The rest as summary.csv.
Result<FileWritten> write_objects_csv(const std::filesystem::path& path, const Profile& profile,
                                      const View& plan, const std::vector<ObjectHours>& objects);

// The field as it stands in a CSV file: quoted where it holds a comma, a quote or a line break.
std::string csv_field(const std::string& text);

}  // namespace gnomon
