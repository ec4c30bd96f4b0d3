#pragma once
// Scatter plots as SVG: what a browser shows and prints without a script.
#include <string>
#include <vector>

namespace hwsim::lab {

struct PlotPoint {
  double x = 0.0, y = 0.0;
  double low = 0.0, high = 0.0;  ///< ends of the bar around y; equal: no bar
  std::string series;            ///< a color and an entry of the legend
  std::string label;             ///< shown when the pointer rests on it
  bool hollow = false;
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotPoint> points;
  bool log_x = false, log_y = false;
  bool diagonal = false;  ///< y = x with bands of 10 and 20 %; otherwise y = 0 with the same bands in percent
  std::vector<std::string> x_names;  ///< x counts these from 0; empty: x is a number
};

std::string to_svg(const Plot& plot);

}  // namespace hwsim::lab
