#include "talus/plot/canvas.h"

#include <cairo-svg.h>
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

#include "talus/base/error.h"
#include "talus/output/files.h"

namespace talus::plot {
namespace {

constexpr const char* kEllipsis = "\u2026";

// Unhinted text has the same widths on both surfaces and at every pixel density.
void set_font_options(cairo_t* cr) {
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cr, options);
  cairo_font_options_destroy(options);
}

// A text that is not UTF-8 would stop all further drawing on its context, so it is tried on one of its own.
std::string clean_text(std::string text) {
  const Context trial = make_measuring_context();
  text_width(trial.get(), text);
  const bool valid = cairo_status(trial.get()) == CAIRO_STATUS_SUCCESS;
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = ' ';
    if (!valid && byte >= 0x80) c = '?';
  }
  return text;
}

// Exceptions must not pass through cairo, which is C.
cairo_status_t append_bytes(void* target, const unsigned char* data, unsigned int length) noexcept {
  try {
    static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(cairo_status_to_string(status));
}

// `draw` on a white sheet.
void draw_on(cairo_surface_t* surface, double scale, const std::function<void(cairo_t*)>& draw) {
  const Context context(cairo_create(surface));
  cairo_scale(context.get(), scale, scale);
  set_font_options(context.get());
  cairo_set_source_rgb(context.get(), 1, 1, 1);
  cairo_paint(context.get());
  draw(context.get());
  check(cairo_status(context.get()));
}

}  // namespace

Context make_measuring_context() {
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  Context context(cairo_create(surface.get()));  // keeps the surface alive
  set_font_options(context.get());
  return context;
}

void set_font(cairo_t* cr, double size, bool bold) {
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, size);
}

double text_width(cairo_t* cr, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(cr, text.c_str(), &extents);
  return extents.x_advance;
}

void draw_text(cairo_t* cr, const std::string& text, double x, double y, double anchor) {
  constexpr double kHalfCapital = 0.36;  // of the font size; the same for all texts keeps rows level
  cairo_matrix_t font;
  cairo_get_font_matrix(cr, &font);
  cairo_move_to(cr, x - anchor * text_width(cr, text), y + kHalfCapital * font.xx);
  cairo_show_text(cr, text.c_str());
}

std::string fit_text(cairo_t* cr, const std::string& raw, double available) {
  std::string text = clean_text(raw);
  if (text_width(cr, text) <= available) return text;
  while (!text.empty() && text_width(cr, text + kEllipsis) > available) {
    while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.pop_back();
    text.pop_back();
  }
  return text + kEllipsis;
}

namespace {

std::string svg_bytes(double width, double height, const std::function<void(cairo_t*)>& draw) {
  std::string bytes;
  const Surface surface(cairo_svg_surface_create_for_stream(append_bytes, &bytes, width, height));
  cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
  draw_on(surface.get(), 1, draw);
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  // cairo numbers its surfaces over the whole process: the same picture has the same bytes whatever was drawn before it
  constexpr std::string_view kName = "id=\"surface";
  for (size_t at = bytes.find(kName); at != std::string::npos; at = bytes.find(kName, at + 1)) {
    const size_t digits = at + kName.size();
    bytes.erase(digits, bytes.find('"', digits) - digits);
  }
  return bytes;
}

std::string png_bytes(double width, double height, double density,
                      const std::function<void(cairo_t*)>& draw) {
  const auto pixels = [density](double length) { return static_cast<int>(std::ceil(density * length)); };
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(width), pixels(height)));
  draw_on(surface.get(), density, draw);
  std::string bytes;
  check(cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes));
  return bytes;
}

}  // namespace

std::string picture_svg(double width, double height, const std::function<void(cairo_t*)>& draw) {
  try {
    return svg_bytes(width, height, draw);
  } catch (const std::runtime_error& error) {
    throw FileError(fmt::format("a picture cannot be drawn: {}", error.what()));
  }
}

std::string picture_png(double width, double height, double density,
                        const std::function<void(cairo_t*)>& draw) {
  try {
    return png_bytes(width, height, density, draw);
  } catch (const std::runtime_error& error) {
    throw FileError(fmt::format("a picture cannot be drawn: {}", error.what()));
  }
}

void write_picture(const std::filesystem::path& stem, double width, double height,
                   const std::function<void(cairo_t*)>& draw) {
  std::filesystem::path svg = stem, png = stem;
  svg += ".svg", png += ".png";
  std::string svg_content, png_content;
  try {
    svg_content = svg_bytes(width, height, draw);
    png_content = png_bytes(width, height, kPixelDensity, draw);
  } catch (const std::runtime_error& error) {
    throw FileError(fmt::format("{}: cannot be drawn: {}", stem.string(), error.what()));
  }
  write_file(svg, svg_content);
  write_file(png, png_content);
}

}  // namespace talus::plot
