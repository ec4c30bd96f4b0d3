#include "pipeline/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/image/rows.h"

namespace hwsim::pipeline {
namespace {

// The values of the paper: exponent q_c, remapping p_c and p_t, feature width w, exponent q_f.
constexpr float kColorExponent = 0.7f, kRemapKnee = 0.4f, kRemapTarget = 0.95f, kFeatureExponent = 0.5f;
constexpr double kFeatureWidthDegrees = 0.082;
// The white of the sRGB matrix below.
constexpr glm::vec3 kWhite{0.9504559f, 1.0f, 1.0890578f};

glm::vec3 xyz_from_linear(glm::vec3 c) {
  return {0.4124564f * c.x + 0.3575761f * c.y + 0.1804375f * c.z,
          0.2126729f * c.x + 0.7151522f * c.y + 0.0721750f * c.z,
          0.0193339f * c.x + 0.1191920f * c.y + 0.9503041f * c.z};
}

glm::vec3 linear_from_xyz(glm::vec3 c) {
  return {3.2404542f * c.x - 1.5371385f * c.y - 0.4985314f * c.z,
          -0.9692660f * c.x + 1.8760108f * c.y + 0.0415560f * c.z,
          0.0556434f * c.x - 0.2040259f * c.y + 1.0572252f * c.z};
}

using Channels = std::array<Channel, 3>;

// Y, Cx, Cz: linear in XYZ, so that filtering commutes with it.
Channels opponent_channels(const Image& image, int jobs) {
  Channels channels = {Channel(image.width, image.height), Channel(image.width, image.height),
                       Channel(image.width, image.height)};
  for_rows(image.height, jobs, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::vec3 t = xyz_from_linear(glm::vec3(image.at(x, y))) / kWhite;
      channels[0].row(y)[x] = 116.0f * t.y - 16.0f;
      channels[1].row(y)[x] = 500.0f * (t.x - t.y);
      channels[2].row(y)[x] = 200.0f * (t.y - t.z);
    }
  });
  return channels;
}

glm::vec3 linear_from_opponent(float luma, float cx, float cz) {
  const float y = (luma + 16.0f) / 116.0f;
  return glm::clamp(linear_from_xyz(glm::vec3(y + cx / 500.0f, y, y - cz / 200.0f) * kWhite), 0.0f, 1.0f);
}

// A term a sqrt(pi/b) exp(-pi^2 x^2 / b) of a contrast sensitivity function, x in degrees.
struct SensitivityTerm {
  double a, b;
};

double sigma_px(SensitivityTerm term) {
  return std::sqrt(term.b / 2.0) / std::numbers::pi * kFlipPixelsPerDegree;
}

// Every channel's filter has the radius of the widest Gaussian, b = 0.04, at three deviations.
int filter_radius_px() { return static_cast<int>(std::ceil(3.0 * sigma_px({1.0, 0.04}))); }

Channel filtered(const Channel& in, SensitivityTerm term, int jobs) {
  const std::vector<float> taps = gaussian_taps(sigma_px(term), filter_radius_px());
  return filter_columns(filter_rows(in, taps, jobs), taps, jobs);
}

// Sum of a term's weights over the window, the share it has in the normalized sum of two terms.
double mass(SensitivityTerm term) {
  double line = 0.0;
  for (int x = -filter_radius_px(); x <= filter_radius_px(); ++x)
    line += std::exp(-x * x / (2.0 * sigma_px(term) * sigma_px(term)));
  return term.a * std::sqrt(std::numbers::pi / term.b) * line * line;
}

Channels filtered_by_sensitivity(const Channels& in, int jobs) {
  constexpr SensitivityTerm luma{1.0, 0.0047}, red_green{1.0, 0.0053}, blue_1{34.1, 0.04},
      blue_2{13.5, 0.025};
  Channels out = {filtered(in[0], luma, jobs), filtered(in[1], red_green, jobs),
                  filtered(in[2], blue_1, jobs)};
  const Channel second = filtered(in[2], blue_2, jobs);
  const auto share = static_cast<float>(mass(blue_1) / (mass(blue_1) + mass(blue_2)));
  for (std::size_t i = 0; i < second.values.size(); ++i)
    out[2].values[i] = share * out[2].values[i] + (1.0f - share) * second.values[i];
  return out;
}

float lab_curve(float t) {
  constexpr float delta = 6.0f / 29.0f;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
}

// CIELab with chroma scaled by lightness, for the Hunt effect.
glm::vec3 hunt_lab_from_linear(glm::vec3 linear) {
  const glm::vec3 t = xyz_from_linear(linear) / kWhite;
  const float x = lab_curve(t.x), y = lab_curve(t.y), z = lab_curve(t.z);
  const float lightness = 116.0f * y - 16.0f;
  return {lightness, 0.01f * lightness * 500.0f * (x - y), 0.01f * lightness * 200.0f * (y - z)};
}

// HyAB distance to the power q_c.
float color_distance(glm::vec3 p, glm::vec3 q) {
  const float chroma = std::sqrt((p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z));
  return std::pow(std::abs(p.x - q.x) + chroma, kColorExponent);
}

// The largest distance in the sRGB gamut is green to blue; distances up to the knee get most of [0,1].
float remapped(float distance) {
  static const float largest =
      color_distance(hunt_lab_from_linear({0.0f, 1.0f, 0.0f}), hunt_lab_from_linear({0.0f, 0.0f, 1.0f}));
  const float knee = kRemapKnee * largest;
  if (distance < knee) return kRemapTarget / knee * distance;
  return std::min(1.0f, kRemapTarget + (distance - knee) / (largest - knee) * (1.0f - kRemapTarget));
}

// Taps of the first or second derivative of a Gaussian: positive ones sum to 1, negative ones to -1.
std::vector<float> derivative_taps(int order, double sigma, int radius) {
  std::vector<double> taps;
  double positive = 0.0, negative = 0.0;
  for (int x = -radius; x <= radius; ++x) {
    const double factor = order == 1 ? -x : x * x / (sigma * sigma) - 1.0;
    taps.push_back(factor * std::exp(-x * x / (2.0 * sigma * sigma)));
    (taps.back() > 0.0 ? positive : negative) += std::abs(taps.back());
  }
  std::vector<float> out;
  for (const double tap : taps) out.push_back(static_cast<float>(tap / (tap > 0.0 ? positive : negative)));
  return out;
}

void to_magnitude(Channel& x, const Channel& y) {
  for (std::size_t i = 0; i < x.values.size(); ++i)
    x.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
}

/// What the eye sees of the image, in Hunt-adjusted CIELab.
void to_hunt_lab(Channels& opponent, int jobs) {
  for_rows(opponent[0].height, jobs, [&](int y) {
    for (int x = 0; x < opponent[0].width; ++x) {
      const glm::vec3 lab = hunt_lab_from_linear(
          linear_from_opponent(opponent[0].row(y)[x], opponent[1].row(y)[x], opponent[2].row(y)[x]));
      for (std::size_t c = 0; c < opponent.size(); ++c)
        opponent[c].row(y)[x] = lab[static_cast<glm::length_t>(c)];
    }
  });
}

// Y lies in [0,1] instead of [-16,100]: the filters have no response to the shift, only to the scale.
float feature_error(float edge_difference, float point_difference) {
  const float larger = std::max(std::abs(edge_difference), std::abs(point_difference)) / 116.0f;
  return std::min(1.0f, std::pow(larger / std::numbers::sqrt2_v<float>, kFeatureExponent));
}

}  // namespace

FlipSide flip_side(const Image& image, int jobs) {
  const double sigma = 0.5 * kFeatureWidthDegrees * kFlipPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  const std::vector<float> smooth = gaussian_taps(sigma, radius);
  const std::vector<float> first = derivative_taps(1, sigma, radius),
                           second = derivative_taps(2, sigma, radius);
  const Channels opponent = opponent_channels(image, jobs);
  const Channel& luma = opponent[0];
  const Channel smooth_rows = filter_rows(luma, smooth, jobs);
  FlipSide side{filter_columns(filter_rows(luma, first, jobs), smooth, jobs),
                filter_columns(filter_rows(luma, second, jobs), smooth, jobs),
                filtered_by_sensitivity(opponent, jobs)};
  to_magnitude(side.edge, filter_columns(smooth_rows, first, jobs));
  to_magnitude(side.point, filter_columns(smooth_rows, second, jobs));
  to_hunt_lab(side.lab, jobs);
  return side;
}

Channel flip_error(const FlipSide& test, const FlipSide& reference, int jobs) {
  Channel error(test.edge.width, test.edge.height);
  for_rows(error.height, jobs, [&](int y) {
    const auto lab = [y](const FlipSide& side, int x) {
      return glm::vec3(side.lab[0].row(y)[x], side.lab[1].row(y)[x], side.lab[2].row(y)[x]);
    };
    for (int x = 0; x < error.width; ++x) {
      const float features = feature_error(test.edge.row(y)[x] - reference.edge.row(y)[x],
                                           test.point.row(y)[x] - reference.point.row(y)[x]);
      const float color = remapped(color_distance(lab(test, x), lab(reference, x)));
      error.row(y)[x] = std::pow(color, 1.0f - features);
    }
  });
  return error;
}

}  // namespace hwsim::pipeline
