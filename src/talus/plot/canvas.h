#pragma once
// Thin layer over cairo used by the charts: owning handles, text, and drawing into SVG or PNG bytes.
// Not for use outside plot/.

#include <cairo.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace talus::plot {

/// Device pixels per px in PNG files.
constexpr double kPixelDensity = 2;

struct CairoDeleter {
  void operator()(cairo_t* cr) const { cairo_destroy(cr); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Context = std::unique_ptr<cairo_t, CairoDeleter>;
using Surface = std::unique_ptr<cairo_surface_t, CairoDeleter>;

/// A context to measure texts with before a picture exists.
Context make_measuring_context();

/// Selects the sans font of `size` px.
void set_font(cairo_t* cr, double size, bool bold = false);

/// Width of the text [px] in the selected font.
double text_width(cairo_t* cr, const std::string& text);

/// Draws text whose middle height is y [px]; `anchor` 0 puts its left end at x [px], 0.5 its middle, 1 its
/// right end.
void draw_text(cairo_t* cr, const std::string& text, double x, double y, double anchor);

/// The text with what is not UTF-8 replaced and its end cut off as far as needed for `available` px.
std::string fit_text(cairo_t* cr, const std::string& text, double available);

/// The drawing as STEM.svg, width x height px, and as STEM.png, kPixelDensity times finer; a dot in the stem is
/// no ending. Throws FileError when it cannot
/// be drawn, or a file cannot be written.
void write_picture(const std::filesystem::path& stem, double width, double height,
                   const std::function<void(cairo_t*)>& draw);

/// The text of the SVG, the bytes of the PNG. Throws FileError when it cannot be drawn.
std::string picture_svg(double width, double height, const std::function<void(cairo_t*)>& draw);
/// @param density  device pixels per px
std::string picture_png(double width, double height, double density,
                        const std::function<void(cairo_t*)>& draw);

}  // namespace talus::plot
