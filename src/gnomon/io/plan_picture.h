// plan.png: the hours in shadow as a map, with legend, scale, north arrow and where and when.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/picture.h>
#include <gnomon/io/picture_shading.h>
#include <gnomon/profile/profile.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon {

// The words around the map; UTF-8; empty ones are left out.
struct PlanCaption {
  std::string title;  // place or model names: "Vienna, Neubau"
  std::vector<std::string>
      lines;             // "18 September 2024, 09:00-17:00 Europe/Vienna", "96 steps of 5 min"
  std::string software;  // "gnomon 0.1.0"
  std::string sun = "sun: apparent altitude, with refraction";
  std::string attribution;  // of the model: "Stadt Wien, CC BY 4.0"
  // The legend's word for pixels without a sample: "not evaluated" where some surfaces do not
  // receive.
  std::string without_sample = "no surface";
};

// The map is at most 1600 pixels long, averaged over area where there are more samples, enlarged by
// a whole factor where there are few. `relief` (entries per sample, or empty) adds light relief and
// thin outlines of objects. Views that are no plan get no scale bar and no north arrow.
// Preconditions: profile and view have the same size > 0; relief's vectors are empty or width *
// height long.
Picture draw_plan(const Profile& profile, const View& view, const Frame& frame,
                  const PlanCaption& caption, const PlanRelief& relief = {}, int threads = 0);

// A field of the legend.
struct Swatch {
  Rgb colour;
  std::string words;
};

// The same page around any map of the view: fields of colour take the place of the scale of hours.
// Precondition: `map` shows the whole of `view`, both sides scaled alike.
Picture draw_map_page(const Picture& map, const std::string& legend_title,
                      const std::vector<Swatch>& swatches, const View& view, const Frame& frame,
                      const PlanCaption& caption);

// Draws and writes. Errors: as write_png.
Result<FileWritten> write_plan_picture(const std::filesystem::path& path, const Profile& profile,
                                       const View& view, const Frame& frame,
                                       const PlanCaption& caption, const PlanRelief& relief = {},
                                       int threads = 0);

// Hours between the ticks of a legend that reaches to `hours` > 0: 5, 10, 15, 30 minutes, 1, 2, 3,
// 4, 6 hours, at most 9 steps up to 54 hours.
double tick_hours(double hours);

// 1, 2 or 5 times a power of ten: the longest such length not above `metres` > 0.
double round_length(double metres);

}  // namespace gnomon
