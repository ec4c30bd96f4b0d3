#include "pipeline/generate/spline_body.h"

#include <algorithm>
#include <cmath>

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec2;
using glm::dvec3;

// One section of the car: heights and half widths in meters.
struct Station {
  double x, sill_y, sill_z, waist_z, belt_y, belt_z, edge_y, edge_z, top_y;
};

// A sedan of 4.47 m: rear lid, rear window, roof, windshield, hood. The ends close on the center line.
constexpr Station kStationTable[] = {{-2.19, 0.34, 0.00, 0.00, 0.90, 0.00, 0.93, 0.00, 0.95},
                                     {-2.24, 0.28, 0.46, 0.50, 0.95, 0.44, 0.99, 0.30, 1.00},
                                     {-2.19, 0.25, 0.74, 0.79, 0.98, 0.67, 1.02, 0.50, 1.04},
                                     {-2.02, 0.22, 0.80, 0.85, 0.99, 0.72, 1.035, 0.55, 1.055},
                                     {-1.80, 0.21, 0.81, 0.875, 0.985, 0.74, 1.035, 0.59, 1.06},
                                     {-1.62, 0.20, 0.82, 0.88, 0.975, 0.75, 1.05, 0.62, 1.075},
                                     {-1.20, 0.20, 0.82, 0.88, 0.965, 0.76, 1.24, 0.585, 1.29},
                                     {-0.85, 0.20, 0.82, 0.88, 0.955, 0.77, 1.345, 0.545, 1.405},
                                     {-0.42, 0.20, 0.82, 0.88, 0.945, 0.77, 1.365, 0.55, 1.43},
                                     {0.00, 0.20, 0.82, 0.88, 0.935, 0.77, 1.36, 0.55, 1.425},
                                     {0.30, 0.20, 0.82, 0.88, 0.925, 0.77, 1.32, 0.545, 1.385},
                                     {0.68, 0.20, 0.82, 0.88, 0.915, 0.765, 1.115, 0.60, 1.15},
                                     {0.98, 0.20, 0.82, 0.88, 0.905, 0.76, 0.965, 0.62, 0.975},
                                     {1.16, 0.20, 0.82, 0.88, 0.895, 0.755, 0.94, 0.58, 0.955},
                                     {1.60, 0.21, 0.81, 0.87, 0.86, 0.74, 0.90, 0.54, 0.92},
                                     {1.94, 0.22, 0.79, 0.84, 0.80, 0.70, 0.835, 0.50, 0.855},
                                     {2.12, 0.23, 0.70, 0.75, 0.74, 0.62, 0.76, 0.45, 0.775},
                                     {2.23, 0.24, 0.43, 0.47, 0.68, 0.41, 0.69, 0.28, 0.70},
                                     {2.25, 0.27, 0.00, 0.00, 0.64, 0.00, 0.65, 0.00, 0.66}};
constexpr int kStationCount = 19, kSectionCount = 10;

dvec3 control(int i, int j) {
  const Station& t = kStationTable[i];
  switch (j) {
    case 0:
      return {t.x, t.sill_y, 0.9 * t.sill_z};
    case 1:
      return {t.x, t.sill_y + 0.02, t.sill_z};
    case 2:
      return {t.x, 0.44, t.waist_z};
    // Two close rows bend the flank sharply: the line on which a long highlight runs.
    case 3:
      return {t.x, 0.60, 1.018 * t.waist_z};
    case 4:
      return {t.x, 0.64, 0.995 * t.waist_z};
    case 5:
      return {t.x, t.belt_y - 0.05, t.belt_z + 0.055 * (t.belt_z > 0.0 ? 1.0 : 0.0)};
    case 6:
      return {t.x, t.belt_y, t.belt_z};
    case 7:
      return {t.x, t.edge_y, t.edge_z};
    case 8:
      return {t.x, t.top_y - 0.004, 0.55 * t.edge_z};
    default:
      return {t.x, t.top_y, 0.0};
  }
}

// Rows past the ends: a straight continuation, and the mirror image beyond the center line.
dvec3 control_or_beyond(int i, int j) {
  if (i < 0) return control_or_beyond(0, j) * 2.0 - control_or_beyond(1, j);
  if (i >= kStationCount)
    return control_or_beyond(kStationCount - 1, j) * 2.0 - control_or_beyond(kStationCount - 2, j);
  if (j < 0) return control(i, 0) * 2.0 - control(i, 1);
  if (j >= kSectionCount) return control(i, 2 * kSectionCount - 2 - j) * dvec3(1, 1, -1);
  return control(i, j);
}

struct Net {
  dvec3 points[kStationCount + 2][kSectionCount + 2];
  Net() {
    for (int i = -1; i <= kStationCount; ++i)
      for (int j = -1; j <= kSectionCount; ++j) points[i + 1][j + 1] = control_or_beyond(i, j);
  }
};

void spline_weights(double t, double w[4]) {
  const double u = 1.0 - t;
  w[0] = u * u * u / 6.0;
  w[1] = (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0;
  w[2] = (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0;
  w[3] = t * t * t / 6.0;
}

// The section at which the skin passes the height `y`; heights rise with c here.
double section_at(double s, double y, double low, double high) {
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (body_point(s, middle).y < y ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// The lower edge at a station: c0, or the arch above a wheel.
double lower_edge(const Panel& p, double s) {
  const dvec3 at = body_point(s, p.c0);
  if (p.reach != Panel::Reach::arched_side) return p.c0;
  for (const double axle : kAxleX) {
    const double dx = at.x - axle, square = kArchRadius * kArchRadius - dx * dx;
    if (square <= 0.0) continue;
    const double y = kWheelRadius + std::sqrt(square);
    if (y > at.y) return section_at(s, y, p.c0, p.c1);
  }
  return p.c0;
}

// Along one direction of a panel: where a row lies, and how far its edge is rolled in (0 to 1).
struct Row {
  double at, roll;
};

std::vector<Row> rows_across(int quads, double edge_share) {
  const int rolled = std::clamp(quads / 8, 1, 6);
  std::vector<Row> rows;
  for (int i = 0; i <= quads; ++i) {
    const int from_edge = std::min(i, quads - i);
    if (from_edge < rolled) {
      const double angle = 0.5 * kPi * (rolled - from_edge) / rolled;
      const double at = edge_share * (1.0 - exact_sin(angle));
      rows.push_back({i < quads - i ? at : 1.0 - at, 1.0 - exact_cos(angle)});
    } else {
      const double t = static_cast<double>(i - rolled) / (quads - 2 * rolled);
      rows.push_back({edge_share + (1.0 - 2.0 * edge_share) * t, 0.0});
    }
  }
  return rows;
}

double distance(const dvec3& a, const dvec3& b) { return std::sqrt(glm::dot(a - b, a - b)); }

// Lengths along s and along c through the panel's middle.
dvec2 panel_size(const Panel& p) {
  constexpr int kSteps = 12;
  dvec2 size(0.0);
  const double s = 0.5 * (p.s0 + p.s1), c = 0.5 * (p.c0 + p.c1);
  for (int i = 0; i < kSteps; ++i) {
    const double a = static_cast<double>(i) / kSteps, b = static_cast<double>(i + 1) / kSteps;
    size.x += distance(body_point(p.s0 + a * (p.s1 - p.s0), c), body_point(p.s0 + b * (p.s1 - p.s0), c));
    size.y += distance(body_point(s, p.c0 + a * (p.c1 - p.c0)), body_point(s, p.c0 + b * (p.c1 - p.c0)));
  }
  if (p.reach == Panel::Reach::whole_width) size.y *= 2.0;
  return size;
}

}  // namespace

dvec3 body_point(double s, double c) {
  static const Net net;  // constant data
  const double side = c > kSections ? -1.0 : 1.0;
  if (c > kSections) c = 2.0 * kSections - c;
  const int i = std::clamp(static_cast<int>(std::floor(s)), 0, kStationCount - 2);
  const int j = std::clamp(static_cast<int>(std::floor(c)), 0, kSectionCount - 2);
  double ws[4], wc[4];
  spline_weights(s - i, ws);
  spline_weights(c - j, wc);
  dvec3 sum(0.0);
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) sum += net.points[i + a][j + b] * (ws[a] * wc[b]);
  return {sum.x, sum.y, side * sum.z};
}

dvec3 body_normal(double s, double c) {
  constexpr double kStep = 1.0 / 512;
  const double s0 = std::max(s - kStep, 0.0), s1 = std::min(s + kStep, kStations);
  return unit(
      glm::cross(body_point(s1, c) - body_point(s0, c), body_point(s, c + kStep) - body_point(s, c - kStep)));
}

double panel_area(const Panel& panel) {
  const dvec2 size = panel_size(panel);
  return size.x * size.y;
}

void add_body_panel(MeshSurface& surface, const Panel& panel, bool mirrored, double quads) {
  constexpr double kRollRadius = 0.004;
  const dvec2 size = panel_size(panel);
  const int nu = std::max(4, static_cast<int>(std::sqrt(quads * size.x / size.y) + 0.5));
  const int nv = std::max(4, static_cast<int>(quads / nu + 0.5));
  const double roll = panel.inset_m > 0.0 ? 0.0 : kRollRadius;
  const std::vector<Row> along = rows_across(nu, std::min(0.1, kRollRadius / size.x));
  const std::vector<Row> up = rows_across(nv, std::min(0.1, kRollRadius / size.y));
  std::vector<double> low;
  for (const Row& row : along) low.push_back(lower_edge(panel, panel.s0 + row.at * (panel.s1 - panel.s0)));
  add_grid(surface, nu, nv, false, false, [&](double u, double v) {
    const auto column = static_cast<std::size_t>((mirrored ? 1.0 - u : u) * nu + 0.5);
    const Row &a = along[column], &b = up[static_cast<std::size_t>(v * nv + 0.5)];
    const double s = panel.s0 + a.at * (panel.s1 - panel.s0), c0 = low[column];
    const double c1 = panel.reach == Panel::Reach::whole_width ? 2.0 * kSections - c0 : panel.c1;
    const double c = c0 + b.at * (c1 - c0);
    const dvec3 p = body_point(s, c) - body_normal(s, c) * (panel.inset_m + roll * (a.roll + b.roll));
    return mirrored ? p * dvec3(1, 1, -1) : p;
  });
}

}  // namespace hwsim::pipeline::generate
