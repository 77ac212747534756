#include <gnomon/io/plan_picture.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <utility>

#include <glm/geometric.hpp>

#include <gnomon/io/colour_map.h>
#include <gnomon/io/picture_map.h>
#include <gnomon/io/png.h>
#include <gnomon/io/write_geotiff.h>

namespace gnomon {
namespace {

constexpr Rgb kPaper{255, 255, 255};
constexpr Rgb kInk{33, 31, 38};
constexpr Rgb kQuiet{104, 102, 112};  // secondary text
constexpr Rgb kHairline{188, 188, 194};

// All lengths follow from the size of the type, so that every picture has the same proportions.
struct Layout {
  double em = 16;                 // pixels of body text
  bool beside = true;             // legend beside the map, else below it
  double left = 0, top = 0;       // of the map
  double width = 0, height = 0;   // of the map
  double side_x = 0, side_y = 0;  // of the legend's area
  double side_width = 0;
  int canvas_width = 0, canvas_height = 0;
  double footer_y = 0;
};

// What stands beside the map, or below it.
struct Legend {
  double beside = 0, below = 0;  // em: least height of a map that has it beside; its height below
  std::function<void(Canvas&, const Layout&)> draw;
};

std::string hours_label(double hours) {
  return hours == std::floor(hours) ? fmt::format("{:.0f}", hours) : fmt::format("{:.3g}", hours);
}

// Ticks from 0 to the longest time; its own label takes the place of a tick that would touch it.
std::vector<double> legend_ticks(double hours, bool upright) {
  const double room = upright ? 0.45 : 0.95;  // steps; labels side by side need more
  const double step = tick_hours(hours);
  std::vector<double> ticks;
  for (int k = 0; k * step <= hours - room * step; ++k) ticks.push_back(k * step);
  ticks.push_back(hours);
  return ticks;
}

void draw_bar(Canvas& canvas, double x, double y, double width, double height, bool upright) {
  // One strip per colour, snapped to pixels, so that no seams show; 0 hours at the bottom or left.
  const int length = static_cast<int>(upright ? height : width);
  for (int k = 0; k < length; ++k) {
    const Rgb colour = hours_colour(length > 1 ? static_cast<double>(k) / (length - 1) : 0.0);
    if (upright) {
      canvas.rectangle(x, y + height - 1 - k, width, 1, colour);
    } else {
      canvas.rectangle(x + k, y, 1, height, colour);
    }
  }
  canvas.frame(x - 1, y - 1, width + 2, height + 2, kHairline, 1);
}

bool any_without_sample(const Profile& p) {
  return std::find(p.valid.begin(), p.valid.end(), std::uint8_t{0}) != p.valid.end();
}

constexpr double kSwatchStep = 1.9;  // em from one field to the next

void draw_swatch(Canvas& canvas, double x, double y, const Swatch& swatch, double em) {
  const TextStyle label{.size = 0.85 * em, .colour = kInk};
  const double thick = std::round(1.3 * em), box = std::round(em);
  canvas.rectangle(x, y, thick, box, swatch.colour);
  canvas.frame(x, y, thick, box, kHairline, 1);
  canvas.text(x + thick + 0.6 * em, y + (box - canvas.measure(swatch.words, label).height) / 2,
              swatch.words, label);
}

// Returns the height used.
double draw_legend(Canvas& canvas, const Layout& at, const Profile& profile,
                   const std::string& without_sample, double length) {
  const double em = at.em, hours = daylight_hours(profile);
  const double x = std::round(at.side_x);
  double y = at.side_y;
  y += canvas.text(x, y, "Hours in shadow", {.size = em, .colour = kInk, .bold = true}).height;
  const std::string of =
      hours > 0 ? fmt::format("of {} h with the sun up", hours_label(std::round(hours * 100) / 100))
                : std::string("the sun is down all the while");
  y += canvas.text(x, y, of, {.size = 0.8 * em, .colour = kQuiet}).height;
  if (profile.days > 1) {
    const std::string mean = fmt::format("mean per day over {} days", profile.days);
    y += canvas.text(x, y, mean, {.size = 0.8 * em, .colour = kQuiet}).height;
  }
  const double thick = std::round(1.3 * em);
  const TextStyle label{.size = 0.85 * em, .colour = kInk};
  y = std::round(y + 0.7 * em);
  if (hours > 0) {
    length = std::round(length);
    draw_bar(canvas, x, y, at.beside ? thick : length, at.beside ? length : thick, at.beside);
    for (const double tick : legend_ticks(hours, at.beside)) {
      const double along = std::round(tick / hours * (length - 1)) + 0.5;
      const std::string words = hours_label(std::round(tick * 100) / 100) + " h";
      if (at.beside) {
        const double line = y + length - along;
        canvas.line({x + thick, line}, {x + thick + 0.35 * em, line}, kQuiet, 1);
        canvas.text(x + thick + 0.6 * em, line - canvas.measure(words, label).height / 2, words,
                    label);
      } else {
        TextStyle centred = label;
        centred.align = tick > 0 ? Align::centre : Align::left;  // flush with the map's edge
        canvas.line({x + along, y + thick}, {x + along, y + thick + 0.35 * em}, kQuiet, 1);
        canvas.text(x + along, y + thick + 0.4 * em, words, centred);
      }
    }
    y += at.beside ? length : thick + 1.8 * em;
  }
  if (any_without_sample(profile)) {
    y = std::round(y + 0.9 * em);
    draw_swatch(canvas, x, y, {kNoDataColour, without_sample}, em);
    y += std::round(em);
  }
  return y - at.side_y;
}

// An arrow in a ring, `north` the unit vector on the picture (y down).
void draw_north(Canvas& canvas, Vec2 centre, double radius, Vec2 north, double em) {
  const Vec2 east(-north.y, north.x);
  canvas.circle(centre, radius, kHairline, std::max(1.0, 0.07 * em));
  const Vec2 tip = centre + radius * 0.98 * north, tail = centre - 0.62 * radius * north;
  const Vec2 notch = centre - 0.3 * radius * north;
  const std::array<Vec2, 3> left{tip, tail - 0.5 * radius * east, notch};
  const std::array<Vec2, 3> right{tip, tail + 0.5 * radius * east, notch};
  canvas.polygon(left, kInk);
  canvas.polygon(right, {168, 166, 176});
  const TextStyle style{.size = 0.9 * em, .colour = kInk, .bold = true, .align = Align::centre};
  const TextSize size = canvas.measure("N", style);
  const Vec2 at = centre + (radius + 0.75 * em) * north;
  canvas.text(at.x, at.y - size.height / 2, "N", style);
}

std::string length_label(double metres) {
  return metres >= 1000 ? fmt::format("{:g} km", metres / 1000) : fmt::format("{:g} m", metres);
}

// Four fields, two of them half as long; `pixels` per metre. (x, y) is the upper left of the bar's
// labels.
void draw_scale(Canvas& canvas, double x, double y, double metres, double pixels, double em) {
  const double length = metres * pixels, thick = std::round(0.42 * em);
  const TextStyle label{.size = 0.85 * em, .colour = kInk, .align = Align::centre};
  const double bar = std::round(y + 1.35 * em);
  const std::array<double, 4> ends{0, 0.25, 0.5, 1};
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    canvas.rectangle(x + ends[k] * length, bar, (ends[k + 1] - ends[k]) * length, thick,
                     k % 2 == 0 ? kInk : kPaper);
  }
  canvas.frame(x, bar, length, thick, kInk, 1);
  TextStyle first = label, last = label;
  first.align = Align::left;
  last.align = Align::right;
  canvas.text(x, y, "0", first);
  canvas.text(x + length, y, length_label(metres), last);
}

std::string degrees_label(double radians, char positive, char negative) {
  return fmt::format("{:.4f}\u00b0 {}", std::abs(radians) / kDegree,
                     radians < 0 ? negative : positive);
}

std::string footer(const View& view, const Frame& frame, const PlanCaption& caption) {
  std::vector<std::string> parts;
  if (!caption.software.empty()) parts.push_back(caption.software);
  constexpr std::size_t kLongestName = 40;  // longer ones are WKT
  if (!frame.crs.empty()) {
    parts.push_back(frame.crs.size() <= kLongestName ? frame.crs : "CRS as WKT in the GeoTIFF");
  }
  if (frame.place) {
    parts.push_back(degrees_label(frame.place->latitude, 'N', 'S') + ", " +
                    degrees_label(frame.place->longitude, 'E', 'W'));
  }
  if (is_plan(view)) parts.push_back(fmt::format("pixel {:.4g} m", glm::length(view.right)));
  if (!caption.sun.empty()) parts.push_back(caption.sun);
  if (!caption.attribution.empty()) parts.push_back("model: " + caption.attribution);
  std::string line;
  for (const std::string& part : parts) line += (line.empty() ? "" : "  \u00b7  ") + part;
  return line;
}

void draw_swatches(Canvas& canvas, const Layout& at, const std::string& title,
                   const std::vector<Swatch>& swatches) {
  const double em = at.em, x = std::round(at.side_x);
  double y = at.side_y;
  y += canvas.text(x, y, title, {.size = em, .colour = kInk, .bold = true}).height + 0.7 * em;
  for (const Swatch& swatch : swatches) {
    draw_swatch(canvas, x, std::round(y), swatch, em);
    y += kSwatchStep * em;
  }
}

}  // namespace

double tick_hours(double hours) {
  constexpr std::array<double, 9> kSteps{1.0 / 12, 1.0 / 6, 0.25, 0.5, 1, 2, 3, 4, 6};
  constexpr double kMostSteps = 9;
  for (const double step : kSteps) {
    if (hours <= kMostSteps * step) return step;
  }
  return 6;
}

double round_length(double metres) {
  const double power = std::pow(10.0, std::floor(std::log10(metres)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= metres) return factor * power;
  }
  return power;
}

namespace {

Picture draw_page(const Picture& map, const View& view, const Frame& frame,
                  const PlanCaption& caption, const Legend& legend) {
  const bool plan = is_plan(view);

  Layout at;
  at.width = map.width;
  at.height = map.height;
  at.em = std::clamp(std::max(map.width, map.height) / 66.0, 14.0, 24.0);
  const double em = at.em, margin = std::round(2.4 * em), gap = std::round(1.8 * em);
  constexpr double kNorthHeight = 5.6, kScaleHeight = 3;  // em
  at.beside = at.height >= (legend.beside + (plan ? kNorthHeight + kScaleHeight : 0)) * em;
  at.side_width = std::round(10.5 * em);
  constexpr double kNarrowest = 32;  // em, so that titles have room beside a narrow map
  double content = at.width + (at.beside ? gap + at.side_width : 0);
  content = std::max(content, kNarrowest * em);
  at.canvas_width = static_cast<int>(std::lround(content + 2 * margin));

  // Heights of texts are known once they are set: measured on a canvas of one pixel.
  const Canvas ruler(1, 1, kPaper);
  const TextStyle title{.size = 1.75 * em, .colour = kInk, .bold = true, .wrap = content};
  const TextStyle line{.size = em, .colour = kQuiet, .wrap = content};
  const TextStyle small{.size = 0.75 * em, .colour = kQuiet, .wrap = content};
  at.left = margin;
  at.top = margin;
  if (!caption.title.empty()) at.top += ruler.measure(caption.title, title).height + 0.25 * em;
  for (const std::string& words : caption.lines)
    at.top += ruler.measure(words, line).height + 0.1 * em;
  at.top = std::round(at.top + (at.top > margin ? 1.1 * em : 0));
  at.side_x = at.beside ? at.left + at.width + gap : at.left;
  at.side_y = at.beside ? at.top : at.top + at.height + gap;
  const double below = at.beside ? at.top + at.height : at.side_y + legend.below * em;
  at.footer_y = std::round(below + (at.beside ? 1.4 : 0.6) * em);
  const std::string foot = footer(view, frame, caption);
  at.canvas_height = static_cast<int>(
      std::lround(at.footer_y + ruler.measure(foot, small).height + 0.65 * margin));

  Canvas canvas(at.canvas_width, at.canvas_height, kPaper);
  double y = margin;
  if (!caption.title.empty()) y += canvas.text(at.left, y, caption.title, title).height + 0.25 * em;
  for (const std::string& words : caption.lines)
    y += canvas.text(at.left, y, words, line).height + 0.1 * em;
  canvas.image(static_cast<int>(at.left), static_cast<int>(at.top), map);
  canvas.frame(at.left - 1, at.top - 1, at.width + 2, at.height + 2, kHairline, 1);

  legend.draw(canvas, at);
  if (plan) {
    const double metres_per_pixel = glm::length(view.right) * view.width / at.width;
    const double longest = (at.beside ? at.side_width : 12 * em) * metres_per_pixel;
    const double metres = round_length(longest);
    const double length = metres / metres_per_pixel;
    // True north in the scene is `true_north` clockwise of +y; on the picture it has these parts
    // along right and down.
    const Vec4 true_north(std::sin(frame.true_north), std::cos(frame.true_north), 0, 0);
    const Vec2 north =
        glm::normalize(Vec2(glm::dot(true_north, view.right), glm::dot(true_north, view.down)));
    const double radius = 1.5 * em;
    if (at.beside) {
      const double scale_y = at.top + at.height - 1.9 * em;
      draw_scale(canvas, std::round(at.side_x), scale_y, metres, 1 / metres_per_pixel, em);
      draw_north(canvas, {at.side_x + radius, scale_y - 1.0 * em - radius}, radius, north, em);
    } else {
      const double right = at.left + content;
      draw_north(canvas, {right - radius, at.side_y + radius + 1.2 * em}, radius, north, em);
      draw_scale(canvas, std::round(right - 2 * radius - 2 * em - length),
                 at.side_y + radius + 0.2 * em, metres, 1 / metres_per_pixel, em);
    }
  }
  canvas.text(at.left, at.footer_y, foot, small);
  return canvas.picture();
}

}  // namespace

Picture draw_plan(const Profile& profile, const View& view, const Frame& frame,
                  const PlanCaption& caption, const PlanRelief& relief, int threads) {
  assert(profile.width == view.width && profile.height == view.height);
  assert(relief.shade.empty() || relief.shade.size() == profile.valid.size());
  assert(relief.object.empty() || relief.object.size() == profile.valid.size());
  const Legend legend{20, (any_without_sample(profile) ? 8.6 : 5.8) + (profile.days > 1 ? 1.1 : 0),
                      [&](Canvas& canvas, const Layout& at) {
                        const double bar =
                            at.beside ? std::clamp(0.42 * at.height, 12 * at.em, 20 * at.em)
                                      : 22 * at.em;
                        draw_legend(canvas, at, profile, caption.without_sample, bar);
                      }};
  return draw_page(draw_hours(profile, relief, threads), view, frame, caption, legend);
}

Picture draw_map_page(const Picture& map, const std::string& legend_title,
                      const std::vector<Swatch>& swatches, const View& view, const Frame& frame,
                      const PlanCaption& caption) {
  const double height = 2.2 + kSwatchStep * static_cast<double>(swatches.size());  // em
  const Legend legend{height + 2, height, [&](Canvas& canvas, const Layout& at) {
                        draw_swatches(canvas, at, legend_title, swatches);
                      }};
  return draw_page(map, view, frame, caption, legend);
}

Result<FileWritten> write_plan_picture(const std::filesystem::path& path, const Profile& profile,
                                       const View& view, const Frame& frame,
                                       const PlanCaption& caption, const PlanRelief& relief,
                                       int threads) {
  return write_png(path, draw_plan(profile, view, frame, caption, relief, threads), threads);
}

}  // namespace gnomon
