// SPDX-License-Identifier: Apache-2.0
#include "store/painting/draw_geo.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>

namespace wellspring::store {

namespace {

using GeoKind = GeoFeature::Kind;

constexpr double reach = 3;              // texels around the window that are drawn, too
constexpr double thinnest_stroke = 0.3;  // texels; thinner ones are drawn paler
constexpr double least_shape = 0.06;     // texels; smaller ones are not seen
constexpr double least_dash = 2.5;       // texels of dash and gap; finer ones are drawn paler
constexpr double least_letters = 2;      // texels of an em; smaller ones are drawn as gray lines
constexpr size_t points_a_work = 16;

class GeoPainter {
 public:
  GeoPainter(const GeoDrawing& drawing, const GeoCanvas& canvas, double& work)
      : drawing_(drawing),
        canvas_(canvas),
        work_(work),
        cairo_(canvas.cairo),
        scale_(canvas.to_window.scale()),
        texels_{canvas.origin, canvas.origin + dvec2(canvas.width, canvas.height)} {}

  void draw() {
    if (!(scale_ > 0) || !std::isfinite(scale_)) return;
    cairo_save(cairo_);
    cairo_identity_matrix(cairo_);
    if (!clip_to_frame()) return cairo_restore(cairo_);
    cairo_set_antialias(cairo_, CAIRO_ANTIALIAS_GOOD);
    const GeoBox near = window(0).places;
    drawing_.shape_tree.visit(near, [&](size_t i) {
      if (--work_ > 0) draw_shape(drawing_.shapes[i]);
    });
    drawing_.name_tree.visit(near, [&](size_t i) {
      if (--work_ > 0) draw_name(drawing_.names[i]);
    });
    cairo_new_path(cairo_);
    cairo_restore(cairo_);
  }

 private:
  // Returns the window with room for strokes, in texels of the level.
  GeoWindow window(double width) const {
    const PaintPlacement& to = canvas_.to_window;
    return make_geo_window(to.across, to.down, to.at + canvas_.origin, texels_,
                           reach + 0.5 * width * scale_);
  }
  void set_color(const PaintColor& color, double alpha = 1) {
    cairo_set_source_rgba(cairo_, double(color.red), double(color.green), double(color.blue),
                          double(color.alpha) * alpha);
  }
  void move_to(dvec2 p) { cairo_move_to(cairo_, p.x - canvas_.origin.x, p.y - canvas_.origin.y); }
  void line_to(dvec2 p) { cairo_line_to(cairo_, p.x - canvas_.origin.x, p.y - canvas_.origin.y); }

  // Clips to the frame, unless all of the window lies within. Returns whether something is left.
  bool clip_to_frame() {
    const PaintBox& frame = drawing_.frame;
    const GeoBox near = window(0).places;
    const GeoBox box{frame.low, frame.high};
    if (!box.touches(near)) return false;
    if (box.low.x <= near.low.x && box.low.y <= near.low.y && box.high.x >= near.high.x &&
        box.high.y >= near.high.y)
      return true;
    GeoOutlines outline;
    const dvec2 corners[4] = {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
    outline.add(corners, 4, true);
    clip_ring(outline, outline.lines[0], window(0), corners_);
    cairo_new_path(cairo_);
    add_ring();
    cairo_clip(cairo_);
    return true;
  }

  void add_ring() {
    if (corners_.size() < 3) return;
    for (size_t i = 0; i < corners_.size(); i++)
      i == 0 ? move_to(corners_[i]) : line_to(corners_[i]);
    cairo_close_path(cairo_);
    work_ -= double(corners_.size()) / points_a_work;
  }

  void draw_shape(const GeoShape& shape) {
    const dvec2 size = scale_ * (shape.box.high - shape.box.low);
    if (std::max(size.x, size.y) < least_shape) return;
    const GeoStyle& style = drawing_.styles[size_t(shape.style)];
    if (shape.kind == GeoKind::points) return draw_point(shape, style);
    if (shape.kind == GeoKind::areas && style.fill.alpha > 0) fill(shape, style);
    stroke(shape, style.casing, style.casing_width, {0, 0});
    stroke(shape, style.stroke, style.width, style.dash);
  }

  void draw_point(const GeoShape& shape, const GeoStyle& style) {
    const dvec2 at = canvas_.to_window.apply(shape.point);
    const double radius = style.radius * scale_;
    const auto arc = [&](double r) {
      cairo_new_path(cairo_);
      cairo_arc(cairo_, at.x, at.y, r, 0, 2 * double(pi));
    };
    // A ring outside of the disc has the stroke's colour.
    if (style.stroke.alpha > 0 && style.width > 0) {
      arc(radius + style.width * scale_);
      set_color(style.stroke);
      cairo_fill(cairo_);
    }
    if (style.fill.alpha <= 0 || style.radius <= 0) return;
    arc(radius);
    set_color(style.fill);
    cairo_fill(cairo_);
  }

  void fill(const GeoShape& shape, const GeoStyle& style) {
    const GeoWindow near = window(0);
    cairo_new_path(cairo_);
    for (size_t k = 0; k < shape.lines; k++) {
      clip_ring(drawing_.outlines, drawing_.outlines.lines[shape.first_line + k], near, corners_);
      add_ring();
    }
    set_color(style.fill);
    cairo_set_fill_rule(cairo_, CAIRO_FILL_RULE_EVEN_ODD);
    cairo_fill(cairo_);
    cairo_set_fill_rule(cairo_, CAIRO_FILL_RULE_WINDING);
  }

  void stroke(const GeoShape& shape, const PaintColor& color, double line_width,
              std::array<double, 2> dash) {
    const double width = line_width * scale_;
    if (color.alpha <= 0 || width < 0.01) return;
    const GeoWindow near = window(line_width);
    corners_.clear(), pieces_.clear();
    for (size_t k = 0; k < shape.lines; k++)
      cut_line(drawing_.outlines, drawing_.outlines.lines[shape.first_line + k], near, corners_,
               pieces_);
    work_ -= double(corners_.size()) / points_a_work;
    double alpha = std::min(width / thinnest_stroke, 1.0);
    const double period = dash[0] + dash[1];
    const bool dashed = period * scale_ >= least_dash;
    if (period > 0 && !dashed) alpha *= dash[0] / period;
    set_color(color, alpha);
    cairo_set_line_width(cairo_, std::max(width, thinnest_stroke));
    cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cairo_, dashed ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
    cairo_new_path(cairo_);
    for (const GeoPiece& piece : pieces_) {
      for (size_t i = 0; i < piece.count; i++) {
        const dvec2 corner = corners_[piece.first + i];
        i == 0 ? move_to(corner) : line_to(corner);
      }
      if (!dashed) continue;
      const double parts[2] = {dash[0] * scale_, dash[1] * scale_};
      cairo_set_dash(cairo_, parts, 2, std::fmod(piece.before, period) * scale_);
      cairo_stroke(cairo_);
    }
    if (dashed) cairo_set_dash(cairo_, nullptr, 0, 0);
    else cairo_stroke(cairo_);
    cairo_new_path(cairo_);
  }

  void add_letters(const PaintPath& path) {
    const dvec2* p = path.points.data();
    const PaintPlacement& to = canvas_.to_window;
    cairo_new_path(cairo_);
    for (char step : path.steps) {
      dvec2 q[3];
      const int count = step == 'C' ? 3 : step == 'Z' ? 0 : 1;
      for (int i = 0; i < count; i++) q[i] = to.apply(*p++);
      if (step == 'M') cairo_move_to(cairo_, q[0].x, q[0].y);
      else if (step == 'L') cairo_line_to(cairo_, q[0].x, q[0].y);
      else if (step == 'Z') cairo_close_path(cairo_);
      else cairo_curve_to(cairo_, q[0].x, q[0].y, q[1].x, q[1].y, q[2].x, q[2].y);
    }
    work_ -= double(path.points.size()) / points_a_work;
  }

  void draw_name(const GeoName& name) {
    if (name.size * scale_ < least_letters) {
      cairo_new_path(cairo_);
      for (dvec2 corner : name.corners) {
        const dvec2 p = canvas_.to_window.apply(corner);
        cairo_line_to(cairo_, p.x, p.y);
      }
      cairo_close_path(cairo_);
      set_color(name.halo, double(name.halo_cover));
      cairo_fill_preserve(cairo_);
      set_color(name.fill, double(name.letters_cover));
      cairo_fill(cairo_);
      return;
    }
    add_letters(name.letters);
    if (name.halo.alpha > 0 && name.halo_width > 0) {
      set_color(name.halo);
      cairo_set_line_width(cairo_, 2 * name.halo_width * scale_);
      cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
      cairo_stroke_preserve(cairo_);
    }
    set_color(name.fill);
    cairo_fill(cairo_);
  }

  const GeoDrawing& drawing_;
  const GeoCanvas& canvas_;
  double& work_;
  cairo_t* const cairo_;
  const double scale_;   // texels of a length of 1
  const GeoBox texels_;  // these of the level are drawn
  std::vector<dvec2> corners_;
  std::vector<GeoPiece> pieces_;
};

}  // namespace

void draw_geo(const GeoDrawing& drawing, const GeoCanvas& canvas, double& work) {
  GeoPainter(drawing, canvas, work).draw();
}

}  // namespace wellspring::store
