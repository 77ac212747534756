#include <gnomon/io/picture.h>

#include <cairo.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cassert>
#include <cstring>

namespace gnomon {

namespace {
[[maybe_unused]] constexpr int kLargestSide = 32767;  // of a Cairo image surface

struct FreeLayout {
  void operator()(PangoLayout* layout) const { g_object_unref(layout); }
};
using Layout = std::unique_ptr<PangoLayout, FreeLayout>;
}  // namespace

struct Canvas::Cairo {
  cairo_surface_t* surface = nullptr;
  cairo_t* context = nullptr;
  int width = 0, height = 0;

  void ink(Rgb c) const { cairo_set_source_rgb(context, c.r / 255.0, c.g / 255.0, c.b / 255.0); }

  Layout layout(const std::string& words, const TextStyle& style) const {
    Layout made(pango_cairo_create_layout(context));
    PangoFontDescription* font = pango_font_description_new();
    pango_font_description_set_family_static(font, "sans-serif");
    pango_font_description_set_weight(font, style.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
    pango_layout_set_font_description(made.get(), font);
    pango_font_description_free(font);
    pango_layout_set_text(made.get(), words.data(), static_cast<int>(words.size()));
    if (style.wrap > 0) {
      pango_layout_set_width(made.get(), static_cast<int>(style.wrap * PANGO_SCALE));
      pango_layout_set_wrap(made.get(), PANGO_WRAP_WORD_CHAR);
      pango_layout_set_alignment(made.get(), style.align == Align::centre  ? PANGO_ALIGN_CENTER
                                             : style.align == Align::right ? PANGO_ALIGN_RIGHT
                                                                           : PANGO_ALIGN_LEFT);
    }
    return made;
  }
};

Canvas::Canvas(int width, int height, Rgb background) : cairo_(std::make_unique<Cairo>()) {
  assert(0 < width && width <= kLargestSide && 0 < height && height <= kLargestSide);
  cairo_->width = width;
  cairo_->height = height;
  cairo_->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  cairo_->context = cairo_create(cairo_->surface);
  rectangle(0, 0, width, height, background);
}

Canvas::~Canvas() {
  cairo_destroy(cairo_->context);
  cairo_surface_destroy(cairo_->surface);
}

void Canvas::rectangle(double x, double y, double width, double height, Rgb fill) {
  cairo_->ink(fill);
  cairo_rectangle(cairo_->context, x, y, width, height);
  cairo_fill(cairo_->context);
}

void Canvas::frame(double x, double y, double width, double height, Rgb stroke, double line) {
  cairo_->ink(stroke);
  cairo_set_line_width(cairo_->context, line);
  cairo_rectangle(cairo_->context, x + line / 2, y + line / 2, width - line, height - line);
  cairo_stroke(cairo_->context);
}

void Canvas::polygon(std::span<const Vec2> corners, Rgb fill) {
  cairo_->ink(fill);
  for (const Vec2& corner : corners) cairo_line_to(cairo_->context, corner.x, corner.y);
  cairo_close_path(cairo_->context);
  cairo_fill(cairo_->context);
}

void Canvas::line(Vec2 from, Vec2 to, Rgb stroke, double width) {
  cairo_->ink(stroke);
  cairo_set_line_width(cairo_->context, width);
  cairo_move_to(cairo_->context, from.x, from.y);
  cairo_line_to(cairo_->context, to.x, to.y);
  cairo_stroke(cairo_->context);
}

void Canvas::circle(Vec2 centre, double radius, Rgb stroke, double line) {
  cairo_->ink(stroke);
  cairo_set_line_width(cairo_->context, line);
  cairo_new_sub_path(cairo_->context);
  cairo_arc(cairo_->context, centre.x, centre.y, radius, 0.0, 6.283185307179586);
  cairo_stroke(cairo_->context);
}

void Canvas::image(int x, int y, const Picture& picture) {
  cairo_surface_flush(cairo_->surface);
  unsigned char* data = cairo_image_surface_get_data(cairo_->surface);
  const int stride = cairo_image_surface_get_stride(cairo_->surface);
  const int first = std::max(0, -x);
  const int last = std::min(picture.width, cairo_->width - x);
  for (int row = std::max(0, -y); row < std::min(picture.height, cairo_->height - y); ++row) {
    unsigned char* out = data + static_cast<std::ptrdiff_t>(row + y) * stride;
    for (int column = first; column < last; ++column) {
      const Rgb c = at(picture, column, row);
      const std::uint32_t packed =
          static_cast<std::uint32_t>(c.r) << 16 | static_cast<std::uint32_t>(c.g) << 8 | c.b;
      std::memcpy(out + 4 * static_cast<std::ptrdiff_t>(column + x), &packed, 4);
    }
  }
  cairo_surface_mark_dirty(cairo_->surface);
}

TextSize Canvas::measure(const std::string& words, const TextStyle& style) const {
  const Layout layout = cairo_->layout(words, style);
  PangoRectangle logical;
  pango_layout_get_extents(layout.get(), nullptr, &logical);
  return {static_cast<double>(logical.width) / PANGO_SCALE,
          static_cast<double>(logical.height) / PANGO_SCALE};
}

TextSize Canvas::text(double x, double y, const std::string& words, const TextStyle& style) {
  const Layout layout = cairo_->layout(words, style);
  PangoRectangle logical;
  pango_layout_get_extents(layout.get(), nullptr, &logical);
  const TextSize size{static_cast<double>(logical.width) / PANGO_SCALE,
                      static_cast<double>(logical.height) / PANGO_SCALE};
  double left = x - static_cast<double>(logical.x) / PANGO_SCALE;
  if (style.align == Align::centre) left -= size.width / 2;
  if (style.align == Align::right) left -= size.width;
  cairo_->ink(style.colour);
  cairo_move_to(cairo_->context, left, y);
  pango_cairo_show_layout(cairo_->context, layout.get());
  return size;
}

Picture Canvas::picture() const {
  cairo_surface_flush(cairo_->surface);
  const unsigned char* data = cairo_image_surface_get_data(cairo_->surface);
  const int stride = cairo_image_surface_get_stride(cairo_->surface);
  Picture out{cairo_->width, cairo_->height, {}};
  out.pixels.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  for (int row = 0; row < out.height; ++row) {
    const unsigned char* in = data + static_cast<std::ptrdiff_t>(row) * stride;
    for (int column = 0; column < out.width; ++column) {
      std::uint32_t packed = 0;
      std::memcpy(&packed, in + 4 * static_cast<std::ptrdiff_t>(column), 4);
      at(out, column, row) = {static_cast<std::uint8_t>(packed >> 16 & 255),
                              static_cast<std::uint8_t>(packed >> 8 & 255),
                              static_cast<std::uint8_t>(packed & 255)};
    }
  }
  return out;
}

}  // namespace gnomon
