#include "study_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hwsim::benchmarks {
namespace {

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
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

}  // namespace hwsim::benchmarks
