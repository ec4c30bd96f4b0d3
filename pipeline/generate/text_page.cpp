// A page of stroke letters, each stroke a quad: thin lines in every direction.
#include <array>
#include <cmath>
#include <string_view>

#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/registry.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

// Polylines of points xy on a grid of 5 columns (0-4) and 7 rows (0 is the base line, 6 the top), split by
// spaces.
constexpr std::array<std::string_view, 26> kLetters = {"00 04 26 44 40|02 42",
                                                       "00 06 36 45 44 33 03|33 42 41 30 00",
                                                       "45 36 16 05 01 10 30 41",
                                                       "00 06 26 44 42 20 00",
                                                       "40 00 06 46|03 33",
                                                       "00 06 46|03 33",
                                                       "45 36 16 05 01 10 30 41 43 23",
                                                       "00 06|40 46|03 43",
                                                       "10 30|20 26|16 36",
                                                       "01 10 20 31 36",
                                                       "00 06|46 03 40",
                                                       "06 00 40",
                                                       "00 06 23 46 40",
                                                       "00 06 40 46",
                                                       "10 01 05 16 36 45 41 30 10",
                                                       "00 06 36 45 44 33 03",
                                                       "10 01 05 16 36 45 41 30 10|22 40",
                                                       "00 06 36 45 44 33 03|23 40",
                                                       "01 10 30 41 42 33 13 04 05 16 36 45",
                                                       "06 46|26 20",
                                                       "06 01 10 30 41 46",
                                                       "06 20 46",
                                                       "06 10 23 30 46",
                                                       "00 46|06 40",
                                                       "06 23 46|23 20",
                                                       "06 46 00 40"};

struct Pen {
  double cell = 0.0, half_width = 0.0;
};

void add_stroke(MeshSurface& s, const dvec3& from, const dvec3& to, const Pen& pen) {
  const dvec3 along = unit(to - from) * pen.half_width, across(-along.y, along.x, 0.0);
  add_quad(s, from - along - across, to + along - across, to + along + across, from - along + across);
}

void add_letter(MeshSurface& s, std::string_view strokes, const dvec3& origin, const Pen& pen) {
  bool drawing = false;
  dvec3 last(0.0);
  for (std::size_t i = 0; i + 1 < strokes.size(); i += 3) {
    const dvec3 point = origin + dvec3(strokes[i] - '0', strokes[i + 1] - '0', 0.0) * pen.cell;
    if (drawing) add_stroke(s, last, point, pen);
    last = point;
    drawing = i + 2 < strokes.size() && strokes[i + 2] == ' ';
  }
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const int lines = p.count("lines"), columns = p.count("columns");
  const double line_height = 2.0 / lines, letter_width = line_height * 0.55;
  const Pen pen{line_height * 0.1, line_height * 0.5 * p.number("stroke_ratio")};
  const double width = letter_width * columns;
  Blueprint out;
  out.looks = {{.name = "paper", .color = {0.92, 0.92, 0.88}, .unlit = true},
               {.name = "ink", .color = {0.02, 0.02, 0.03}, .unlit = true}};
  Model page{"page", {{MeshSurface{}, 0}, {MeshSurface{}, 1}}};
  add_panel(page.pieces[0].surface, {-0.5 * width - 0.1, -1.1, 0}, {width + 0.2, 0, 0}, {0, 2.2, 0}, 1, 1);
  for (int line = 0; line < lines; ++line) {
    int left = 2 + random.below(8);  // letters to the next gap
    for (int column = 0; column < columns; ++column) {
      if (left-- == 0) {
        left = 2 + random.below(8);
        continue;
      }
      const dvec3 origin(-0.5 * width + letter_width * column, 1.0 - line_height * (line + 0.85), 0.002);
      add_letter(page.pieces[1].surface, kLetters[static_cast<std::size_t>(random.below(26))], origin, pen);
    }
  }
  out.models.push_back(std::move(page));
  out.placements.push_back({});
  const double tilt = p.number("tilt_deg") * kPi / 180.0;
  out.eye = {2.7 * exact_sin(tilt), 0.0, 2.7 * exact_cos(tilt)};
  out.fov_y_rad = 0.9;
  return out;
}

}  // namespace

Generator text_page() {
  return {{"text_page",
           "page of stroke letters, every stroke a quad",
           {{"lines", 40, 1, 500, "lines of text"},
            {"columns", 100, 1, 1000, "letters in a line, gaps counted"},
            {"stroke_ratio", 0.07, 0.005, 0.3, "width of a stroke over the line's height"},
            {"tilt_deg", 12, -80, 80, "angle of the view off the page's normal in degrees"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
