#include "lab/results/scatter_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hwsim::lab {
namespace {

constexpr double kWidth = 860.0, kHeight = 640.0, kLeft = 80.0, kRight = 200.0, kTop = 50.0, kBottom = 110.0;
// Okabe and Ito's palette: told apart by color-blind people too.
constexpr std::array<const char*, 8> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#e69f00", "#56b4e9", "#000000", "#8c6d31"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

class Axis {
 public:
  Axis(double low, double high, bool log, double from_px, double to_px)
      : low_(log ? std::log10(low) : low),
        high_(log ? std::log10(high) : high),
        log_(log),
        from_(from_px),
        to_(to_px) {}
  double px(double value) const {
    const double v = log_ ? std::log10(std::max(value, 1e-12)) : value;
    return from_ + (v - low_) / (high_ - low_) * (to_ - from_);
  }
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    if (log_) {
      for (double decade = std::floor(low_); decade <= high_; decade += 1.0)
        for (const double digit : {1.0, 2.0, 5.0})
          if (const double v = digit * std::pow(10.0, decade);
              std::log10(v) >= low_ && std::log10(v) <= high_)
            ticks.push_back(v);
      return ticks;
    }
    const double raw = (high_ - low_) / 6.0, power = std::pow(10.0, std::floor(std::log10(raw)));
    const double step = raw / power < 2.0 ? 2.0 * power : raw / power < 5.0 ? 5.0 * power : 10.0 * power;
    for (double v = std::ceil(low_ / step) * step; v <= high_; v += step) ticks.push_back(v);
    return ticks;
  }

 private:
  double low_, high_;
  bool log_;
  double from_, to_;
};

class Painter {
 public:
  explicit Painter(const Plot& plot) : plot_(plot), x_(make_x()), y_(make_y()) {
    for (const PlotPoint& p : plot.points)
      if (std::find(series_.begin(), series_.end(), p.series) == series_.end()) series_.push_back(p.series);
  }

  std::string paint() {
    text_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
        "fill=\"white\"/>\n",
        kWidth, kHeight);
    label(kWidth / 2, 26, plot_.title, "middle", 15);
    axes();
    guides();
    for (const PlotPoint& p : plot_.points) point(p);
    legend();
    return text_ + "</svg>\n";
  }

 private:
  Axis make_x() const {
    if (!plot_.x_names.empty())
      return {-0.5, static_cast<double>(plot_.x_names.size()) - 0.5, false, kLeft, kWidth - kRight};
    const auto [low, high] = range();
    return {low, high, plot_.log_x, kLeft, kWidth - kRight};
  }
  Axis make_y() const {
    if (plot_.diagonal) {
      const auto [low, high] = range();
      return {low, high, plot_.log_y, kHeight - kBottom, kTop};
    }
    double extent = 25.0;
    for (const PlotPoint& p : plot_.points) extent = std::max(extent, std::abs(p.y) * 1.05);
    return {-extent, extent, false, kHeight - kBottom, kTop};
  }
  /// The same for both axes of a diagonal plot.
  std::pair<double, double> range() const {
    double low = 1e300, high = 0.0;
    for (const PlotPoint& p : plot_.points)
      for (const double v : {p.x, p.y}) low = std::min(low, v), high = std::max(high, v);
    if (low > high) return {0.1, 10.0};
    return {low / 1.3, high * 1.3};
  }

  void line(double x1, double y1, double x2, double y2, const char* stroke, const char* extra = "") {
    text_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" {}/>\n",
                         x1, y1, x2, y2, stroke, extra);
  }
  void label(double x, double y, const std::string& words, const char* anchor, int size,
             const std::string& extra = "") {
    text_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\" {}>{}</text>\n",
                         x, y, anchor, size, extra, escaped(words));
  }

  void axes() {
    const double bottom = kHeight - kBottom, right = kWidth - kRight;
    text_ +=
        fmt::format("<clipPath id=\"area\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
                    kLeft, kTop, right - kLeft, bottom - kTop);
    for (const double tick : y_.ticks()) {
      line(kLeft, y_.px(tick), right, y_.px(tick), "#e5e5e5");
      label(kLeft - 6, y_.px(tick) + 4, fmt::format("{:g}", tick), "end", 11);
    }
    if (plot_.x_names.empty()) {
      for (const double tick : x_.ticks()) {
        line(x_.px(tick), kTop, x_.px(tick), bottom, "#e5e5e5");
        label(x_.px(tick), bottom + 16, fmt::format("{:g}", tick), "middle", 11);
      }
    }
    for (std::size_t i = 0; i < plot_.x_names.size(); ++i) {
      const double x = x_.px(static_cast<double>(i));
      label(x, bottom + 14, plot_.x_names[i], "end", 10,
            fmt::format("transform=\"rotate(-35 {:.1f} {:.1f})\"", x, bottom + 14));
    }
    line(kLeft, bottom, right, bottom, "black");
    line(kLeft, kTop, kLeft, bottom, "black");
    label((kLeft + right) / 2, kHeight - 14, plot_.x_label, "middle", 12);
    label(22, (kTop + bottom) / 2, plot_.y_label, "middle", 12,
          fmt::format("transform=\"rotate(-90 22 {:.1f})\"", (kTop + bottom) / 2));
  }

  void guides() {
    if (!plot_.diagonal) {
      for (const double y : {-20.0, -10.0, 0.0, 10.0, 20.0})
        line(kLeft, y_.px(y), kWidth - kRight, y_.px(y), "#777777",
             y == 0.0 ? "" : "stroke-dasharray=\"4 4\"");
      return;
    }
    const auto [low, high] = range();
    for (const double factor : {0.8, 0.9, 1.0, 1.1, 1.2})
      line(x_.px(low), y_.px(low * factor), x_.px(high), y_.px(high * factor), "#777777",
           factor == 1.0 ? "clip-path=\"url(#area)\"" : "stroke-dasharray=\"4 4\" clip-path=\"url(#area)\"");
  }

  const char* color(const std::string& series) const {
    const auto at =
        static_cast<std::size_t>(std::find(series_.begin(), series_.end(), series) - series_.begin());
    return kColors[at % kColors.size()];
  }

  void point(const PlotPoint& p) {
    if (p.low < p.high)
      line(x_.px(p.x), y_.px(p.low), x_.px(p.x), y_.px(p.high), color(p.series),
           "stroke-opacity=\"0.35\" clip-path=\"url(#area)\"");
    text_ += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" stroke=\"{}\" "
        "fill=\"{}\"><title>{}</title></circle>\n",
        x_.px(p.x), y_.px(p.y), color(p.series), p.hollow ? "none" : color(p.series), escaped(p.label));
  }

  void legend() {
    double y = kTop + 10;
    for (const std::string& series : series_) {
      text_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"4\" fill=\"{}\"/>\n", kWidth - kRight + 18, y - 4,
                           color(series));
      label(kWidth - kRight + 28, y, series, "start", 11);
      y += 18;
    }
  }

  const Plot& plot_;
  Axis x_, y_;
  std::vector<std::string> series_;
  std::string text_;
};

}  // namespace

std::string to_svg(const Plot& plot) { return Painter(plot).paint(); }

}  // namespace hwsim::lab
