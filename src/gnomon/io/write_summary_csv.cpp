#include <gnomon/io/write_summary_csv.h>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include <gnomon/profile/hour_classes.h>
#include <gnomon/scene/objects.h>

namespace gnomon {
namespace {

constexpr double kMsPerHour = 3.6e6;

double pixel_area(const View& plan) {
  return std::fabs(plan.right.x * plan.down.y - plan.right.y * plan.down.x);
}

std::string area_text(const View& plan, std::uint64_t samples) {
  return fmt::format("{:.10g}", static_cast<double>(samples) * pixel_area(plan));
}

std::string hours_text(double hours) { return fmt::format("{:.7g}", hours); }

void add(ObjectHours& to, std::uint32_t ticks, std::uint64_t of_class) {
  to.least = to.samples == 0 ? ticks : std::min(to.least, ticks);
  to.most = std::max(to.most, ticks);
  to.ticks += ticks;
  ++to.samples;
  ++to.classes[of_class];
}

}  // namespace

std::vector<ObjectHours> hours_by_object(const Profile& profile, const Receivers& receivers,
                                         const Scene& scene, std::uint64_t step_ms) {
  assert(receivers.triangle.size() == profile.valid.size() && step_ms > 0);
  const std::uint64_t count = classes(profile, step_ms);
  const auto named = [&](std::string name) {
    ObjectHours object;
    object.object = std::move(name);
    object.classes.assign(count, 0);
    return object;
  };
  const Objects whole = whole_objects(scene);
  std::vector<ObjectHours> objects{named("(all)")};
  for (const std::string& name : whole.names) {
    objects.push_back(named(name.empty() ? "(no name)" : name));
  }
  for (std::size_t k = 0; k < profile.valid.size(); ++k) {
    if (profile.valid[k] == 0) continue;
    const std::uint64_t of_class = class_of(profile, k, step_ms, count);
    add(objects[0], profile.shadow_ticks[k], of_class);
    add(objects[1 + whole.of_surface[scene.surface_of[receivers.triangle[k]]]],
        profile.shadow_ticks[k], of_class);
  }
  objects.erase(std::remove_if(objects.begin() + 1, objects.end(),
                               [](const ObjectHours& o) { return o.samples == 0; }),
                objects.end());
  return objects;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

Result<FileWritten> write_summary_csv(const std::filesystem::path& path, const Profile& profile,
                                      const View& plan, const std::vector<ObjectHours>& objects,
                                      std::uint64_t step_ms) {
  std::string text = "object,class_from_h,class_to_h,area_m2,samples\n";
  for (const ObjectHours& o : objects) {
    const std::string name = csv_field(o.object);
    for (std::size_t c = 0; c < o.classes.size(); ++c) {
      const double from = static_cast<double>(c * step_ms) / kMsPerHour;
      const double to = c + 1 < o.classes.size()
                            ? static_cast<double>((c + 1) * step_ms) / kMsPerHour
                            : daylight_hours(profile);
      text += fmt::format("{},{},{},{},{}\n", name, hours_text(from), hours_text(to),
                          area_text(plan, o.classes[c]), o.classes[c]);
    }
  }
  return write_text_file(path, text);
}

Result<FileWritten> write_objects_csv(const std::filesystem::path& path, const Profile& profile,
                                      const View& plan, const std::vector<ObjectHours>& objects) {
  std::string text = "object,area_m2,samples,min_shadow_h,mean_shadow_h,max_shadow_h\n";
  for (const ObjectHours& o : objects) {
    text += fmt::format("{},{},{}", csv_field(o.object), area_text(plan, o.samples), o.samples);
    if (o.samples == 0) {
      text += ",,,\n";
      continue;
    }
    const double mean = static_cast<double>(o.ticks) * profile.tick_ms /
                        (kMsPerHour * profile.days * static_cast<double>(o.samples));
    text += fmt::format(",{},{},{}\n", hours_text(hours_per_day(profile, o.least)),
                        hours_text(mean), hours_text(hours_per_day(profile, o.most)));
  }
  return write_text_file(path, text);
}

}  // namespace gnomon
