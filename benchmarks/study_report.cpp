#include "study_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hwsim::benchmarks {
namespace {

constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

double x_of(double times_as_fast) { return 70.0 + 85.0 * std::log10(std::clamp(times_as_fast, 0.5, 1e6)); }
double y_of(double pct) { return 340.0 - 5.0 * std::min(pct, 60.0); }

void draw_axes(std::ostream& svg) {
  svg << R"(<svg xmlns="http://www.w3.org/2000/svg" width="760" height="400" font-family="sans-serif" font-size="12">)"
      << "\n<text x='70' y='20'>Time error of an engine against the whole event-driven simulation, and its "
         "speed</text>\n<text x='260' y='385'>times as fast (logarithmic)</text>\n"
         "<text x='5' y='30'>% error</text>\n<path d='M70 340H600M70 340V40' stroke='black' fill='none'/>\n";
  for (double ratio = 1.0; ratio < 2e6; ratio *= 10.0)
    svg << "<text x='" << x_of(ratio) - 4 << "' y='358'>" << number("%.0f", ratio) << "</text>\n";
  for (double pct = 0.0; pct <= 60.0; pct += 10.0)
    svg << "<text x='40' y='" << y_of(pct) + 4 << "'>" << number("%.0f", pct) << "</text>\n";
}

/// Dots on a grid of half a pixel, each place once: a plot of thousands of rows stays small.
void draw_dots(const std::vector<StudyRow>& rows, const std::string& engine, const char* color,
               std::ostream& svg) {
  std::map<std::pair<int, int>, int> places;
  for (const StudyRow& row : rows)
    if (row.engine == engine)
      ++places[{static_cast<int>(std::lround(x_of(row.times_as_fast))),
                static_cast<int>(std::lround(y_of(std::abs(row.time_error_pct))))}];
  svg << "<g fill='" << color << "' fill-opacity='0.35'>\n";
  for (const auto& [place, count] : places)
    svg << "<circle cx='" << place.first << "' cy='" << place.second << "' r='2'/>\n";
  svg << "</g>\n";
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) {
    return values[static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.5), at(0.9), values.back()};
}

std::map<std::string, EngineSummary> summarize(const std::vector<StudyRow>& rows) {
  std::map<std::string, std::vector<double>> time, bytes, ratios, walls;
  for (const StudyRow& row : rows) {
    time[row.engine].push_back(std::abs(row.time_error_pct));
    bytes[row.engine].push_back(std::abs(row.byte_error_pct));
    ratios[row.engine].push_back(row.times_as_fast);
    walls[row.engine].push_back(row.wall_ms);
  }
  std::map<std::string, EngineSummary> summary;
  for (const auto& [engine, values] : time)
    summary[engine] = {spread_of(values), spread_of(bytes[engine]), spread_of(ratios[engine]).median,
                       spread_of(walls[engine]).median,
                       *std::min_element(walls[engine].begin(), walls[engine].end())};
  return summary;
}

void write_csv(const std::vector<StudyRow>& rows, std::ostream& out) {
  out << "scene,technique,gpu,engine,time_ms,overhead_ms,dram_mb,wall_ms,time_error_pct,byte_error_pct,"
         "times_as_fast,fragments\n";
  for (const StudyRow& r : rows)
    out << r.scene << ",\"" << r.technique << "\"," << r.gpu << ',' << r.engine << ',' << r.time_ms << ','
        << r.overhead_ms << ',' << r.dram_mb << ',' << r.wall_ms << ',' << r.time_error_pct << ','
        << r.byte_error_pct << ',' << r.times_as_fast << ',' << r.fragments << '\n';
}

void write_table(const std::vector<StudyRow>& rows, std::ostream& out) {
  out << "| engine | time error %: median | p90 | worst | byte error %: median | p90 | worst | times as "
         "fast, "
         "median | ms a frame, median |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [engine, s] : summarize(rows)) {
    out << "| " << engine;
    for (const double value : {s.time_pct.median, s.time_pct.p90, s.time_pct.worst, s.byte_pct.median,
                               s.byte_pct.p90, s.byte_pct.worst})
      out << " | " << number("%.1f", value);
    out << " | " << number("%.1f", s.median_times_as_fast) << " | " << number("%.3f", s.median_wall_ms)
        << " |\n";
  }
  std::vector<double> rates;
  for (const StudyRow& row : rows)
    if (row.engine == "detailed") rates.push_back(row.fragments / row.wall_ms);
  std::sort(rates.begin(), rates.end());
  if (!rates.empty())
    out << "\n`detailed`: " << number("%.0f", rates[rates.size() / 2])
        << " thousand fragments a second in the median, a tenth of the frames below "
        << number("%.0f", rates[rates.size() / 10]) << ", the slowest " << number("%.0f", rates.front())
        << "\n";
}

void write_svg(const std::vector<StudyRow>& rows, std::ostream& svg) {
  draw_axes(svg);
  std::size_t color = 0;
  for (const auto& [engine, s] : summarize(rows)) {
    const char* const paint = kColors[color % std::size(kColors)];
    draw_dots(rows, engine, paint, svg);
    const double x = x_of(s.median_times_as_fast);
    svg << "<circle cx='" << x << "' cy='" << y_of(s.time_pct.median) << "' r='8' fill='none' stroke='"
        << paint << "' stroke-width='2'/>\n<path d='M" << x << " " << y_of(s.time_pct.median) - 8 << "V"
        << y_of(s.time_pct.p90) << "' stroke='" << paint << "' stroke-width='2'/>\n<text x='620' y='"
        << 60 + 18 * color << "' fill='" << paint << "'>" << engine << "</text>\n";
    ++color;
  }
  svg << "</svg>\n";
}

}  // namespace hwsim::benchmarks
