#include "experiments/statics/path_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tress::experiments::statics {
namespace {

constexpr double plot_left = 86, plot_top = 46, plot_width = 440, plot_height = 330;
constexpr double shapes_left = 566, shapes_width = 320;
constexpr std::string_view stable_colour = "#1f5fa8", unstable_colour = "#c0562f";
constexpr int shapes_drawn = 9;

/// An interval of numbers and the pixels where it is drawn.
struct Axis {
  double least = 0, most = 1, begin = 0, end = 1;
  double pixel(double x) const {
    return begin + (x - least) / (most - least) * (end - begin);
  }
};

Axis axis_over(const std::vector<double>& values, double begin, double end) {
  Axis axis{0, 1, begin, end};
  if (!values.empty()) {
    const auto [least, most] = std::ranges::minmax(values);
    const double margin = most > least ? 0.04 * (most - least) : 1;
    axis.least = least - margin;
    axis.most = most + margin;
  }
  return axis;
}

/// Distance of ticks: 1, 2 or 5 times a power of ten.
double tick_of(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 4)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (range / (factor * power) <= 6) return factor * power;
  }
  return 10 * power;
}

std::string text_at(double x, double y, std::string_view anchor, std::string_view text,
                    std::string_view more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n",
                     x, y, anchor, more, text);
}

std::string line_of(double x0, double y0, double x1, double y1, std::string_view style) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x0, y0, x1,
      y1, style);
}

std::string escaped(std::string_view text) {
  std::string all;
  for (const char c : text) {
    if (c == '<') {
      all += "&lt;";
    } else if (c == '&') {
      all += "&amp;";
    } else {
      all += c;
    }
  }
  return all;
}

std::string ticks(const Axis& axis, bool across) {
  constexpr std::string_view grid = "stroke=\"#dddddd\" stroke-width=\"1\"";
  const double step = tick_of(axis.most - axis.least);
  std::string all;
  for (double k = std::ceil(axis.least / step); k * step <= axis.most; ++k) {
    const double at = axis.pixel(k * step);
    const std::string label = fmt::format("{:.6g}", k == 0 ? 0.0 : k * step);
    if (across) {
      all += line_of(at, plot_top, at, plot_top + plot_height, grid);
      all += text_at(at, plot_top + plot_height + 18, "middle", label);
    } else {
      all += line_of(plot_left, at, plot_left + plot_width, at, grid);
      all += text_at(plot_left - 8, at + 4, "end", label);
    }
  }
  return all;
}

bool is_stable(const PathPoint& point) {
  return point.stability.negative == 0 && !point.stability.oscillates;
}

/// A polyline in pixels.
std::string polyline(const std::vector<std::pair<double, double>>& points,
                     std::string_view style) {
  std::string all = "<polyline fill=\"none\" points=\"";
  for (const auto& [x, y] : points) all += fmt::format("{:.2f},{:.2f} ", x, y);
  return all + fmt::format("\" {}/>\n", style);
}

std::string stroke(bool stable, double width) {
  return fmt::format("stroke=\"{}\" stroke-width=\"{}\"{}",
                     stable ? stable_colour : unstable_colour, width,
                     stable ? "" : " stroke-dasharray=\"5 3\"");
}

/// Points of the path that were found.
std::vector<const PathPoint*> found_points(const std::vector<PathPoint>& path) {
  std::vector<const PathPoint*> all;
  for (const PathPoint& point : path) {
    if (!point.x.empty()) all.push_back(&point);
  }
  return all;
}

/// The curve in parts of one stability, which meet at the points between them.
std::string curve(const std::vector<const PathPoint*>& points,
                  const std::vector<std::pair<double, double>>& pixels) {
  std::string all;
  std::vector<std::pair<double, double>> part;
  const auto critical = [&](std::size_t k) {
    return points[k]->event == Event::limit_point ||
           points[k]->event == Event::bifurcation;
  };
  bool stable = true;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const bool now = critical(k) ? stable : is_stable(*points[k]);
    if (!part.empty() && now != stable) {
      all += polyline(part, stroke(stable, 2));
      part = {part.back()};
    }
    stable = now;
    part.push_back(pixels[k]);
  }
  return all + polyline(part, stroke(stable, 2));
}

std::string marks(const std::vector<const PathPoint*>& points,
                  const std::vector<std::pair<double, double>>& pixels) {
  std::string all;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [x, y] = pixels[k];
    if (points[k]->event == Event::limit_point) {
      all += fmt::format(
          "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"5\" fill=\"#222222\"/>\n", x, y);
    }
    if (points[k]->event == Event::bifurcation) {
      all += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"9\" height=\"9\" fill=\"#ffffff\" "
          "stroke=\"#222222\" stroke-width=\"2\"/>\n",
          x - 4.5, y - 4.5);
    }
  }
  return all;
}

std::string key() {
  const double y = plot_top + plot_height + 62;
  std::string all = line_of(plot_left, y, plot_left + 26, y, stroke(true, 2));
  all += text_at(plot_left + 32, y + 4, "start", "stable");
  all += line_of(plot_left + 92, y, plot_left + 118, y, stroke(false, 2));
  all += text_at(plot_left + 124, y + 4, "start", "unstable");
  all += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"#222222\"/>\n",
                     plot_left + 206, y);
  all += text_at(plot_left + 216, y + 4, "start", "limit point");
  all += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"9\" height=\"9\" fill=\"#ffffff\" "
      "stroke=\"#222222\" stroke-width=\"2\"/>\n",
      plot_left + 300, y - 4.5);
  return all + text_at(plot_left + 314, y + 4, "start", "bifurcation");
}

/// The world's z and whichever of x and y extends farther; places in pixels.
std::string shapes(const std::vector<const PathPoint*>& points) {
  double least[3], most[3];
  for (std::size_t c = 0; c < 3; ++c) {
    least[c] = most[c] = points.front()->x[c];
    for (const PathPoint* point : points) {
      for (std::size_t i = c; i < point->x.size(); i += 3) {
        least[c] = std::min(least[c], point->x[i]);
        most[c] = std::max(most[c], point->x[i]);
      }
    }
  }
  const std::size_t across = most[0] - least[0] >= most[1] - least[1] ? 0 : 1;
  const double wide = most[across] - least[across], high = most[2] - least[2];
  const double scale = std::min(shapes_width / std::max(wide, 1e-300),
                                plot_height / std::max(high, 1e-300));
  const double x0 = shapes_left + (shapes_width - scale * wide) / 2;
  const double y0 = plot_top + (plot_height - scale * high) / 2;
  const double last = points.back()->arclength;
  std::string all;
  int drawn = 0;
  for (const PathPoint* point : points) {
    const bool special = point->event != Event::none;
    const bool due =
        last > 0 && point->arclength >= last * drawn / (shapes_drawn - 1) * (1 - 1e-9);
    if (!special && !due) continue;
    if (due) ++drawn;
    std::vector<std::pair<double, double>> line;
    for (std::size_t i = 0; i < point->x.size(); i += 3) {
      line.emplace_back(x0 + scale * (point->x[i + across] - least[across]),
                        y0 + scale * (most[2] - point->x[i + 2]));
    }
    all += polyline(line, stroke(is_stable(*point), special ? 2 : 1));
  }
  all += text_at(shapes_left + shapes_width / 2, plot_top + plot_height + 18, "middle",
                 fmt::format("shapes along the path, {} to the right, z up",
                             across == 0 ? 'x' : 'y'));
  return all;
}

}  // namespace

std::string path_picture(const std::vector<PathPoint>& path, const Gauge& gauge,
                         const Varied& varied, const std::string& title) {
  const std::vector<const PathPoint*> points = found_points(path);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"910\" height=\"460\" "
      "viewBox=\"0 0 910 460\" font-family=\"sans-serif\" font-size=\"12\" "
      "fill=\"#222222\">\n<rect width=\"910\" height=\"460\" fill=\"#ffffff\"/>\n";
  svg += text_at(plot_left, 24, "start", escaped(title), "font-size=\"14\"");
  if (points.empty()) return svg + "</svg>\n";
  const bool force = std::isfinite(gauge.force_at(*points.front()));
  std::vector<double> moved, load;
  for (const PathPoint* point : points) {
    moved.push_back(gauge.displacement(*points.front(), *point));
    load.push_back(force ? gauge.force_at(*point) : point->at.value);
  }
  const Axis x = axis_over(moved, plot_left, plot_left + plot_width);
  const Axis y = axis_over(load, plot_top + plot_height, plot_top);
  std::vector<std::pair<double, double>> pixels;
  for (std::size_t k = 0; k < points.size(); ++k) {
    pixels.emplace_back(x.pixel(moved[k]), y.pixel(load[k]));
  }
  svg += ticks(x, true) + ticks(y, false) + curve(points, pixels) + marks(points, pixels);
  svg += text_at(plot_left + plot_width / 2, plot_top + plot_height + 38, "middle",
                 fmt::format("displacement of {} (m)", escaped(gauge.place)));
  const std::string unit =
      varied.unit == "1" ? "factor" : fmt::format("{}", escaped(varied.unit));
  const double middle = plot_top + plot_height / 2;
  svg += text_at(22, middle, "middle",
                 force ? "force (N)" : fmt::format("{} ({})", escaped(varied.name), unit),
                 fmt::format("transform=\"rotate(-90 22 {:.1f})\"", middle));
  return svg + key() + shapes(points) + "</svg>\n";
}

}  // namespace tress::experiments::statics
