#include "pipeline/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
Channels opponent_channels(const Image& image) {
  Channels channels = {Channel(image.width, image.height), Channel(image.width, image.height),
                       Channel(image.width, image.height)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::vec3 t = xyz_from_linear(glm::vec3(image.pixels[i])) / kWhite;
    channels[0].values[i] = 116.0f * t.y - 16.0f;
    channels[1].values[i] = 500.0f * (t.x - t.y);
    channels[2].values[i] = 200.0f * (t.y - t.z);
  }
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

Channel filtered(const Channel& in, SensitivityTerm term) {
  const std::vector<float> taps = gaussian_taps(sigma_px(term), filter_radius_px());
  return filter_columns(filter_rows(in, taps), taps);
}

// Sum of a term's weights over the window, the share it has in the normalized sum of two terms.
double mass(SensitivityTerm term) {
  double line = 0.0;
  for (int x = -filter_radius_px(); x <= filter_radius_px(); ++x)
    line += std::exp(-x * x / (2.0 * sigma_px(term) * sigma_px(term)));
  return term.a * std::sqrt(std::numbers::pi / term.b) * line * line;
}

Channels filtered_by_sensitivity(const Channels& in) {
  constexpr SensitivityTerm luma{1.0, 0.0047}, red_green{1.0, 0.0053}, blue_1{34.1, 0.04},
      blue_2{13.5, 0.025};
  Channels out = {filtered(in[0], luma), filtered(in[1], red_green), filtered(in[2], blue_1)};
  const Channel second = filtered(in[2], blue_2);
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

struct Features {
  Channel edge, point;
};

void to_magnitude(Channel& x, const Channel& y) {
  for (std::size_t i = 0; i < x.values.size(); ++i)
    x.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
}

Features features(const Channel& luma) {
  const double sigma = 0.5 * kFeatureWidthDegrees * kFlipPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  const std::vector<float> smooth = gaussian_taps(sigma, radius);
  const std::vector<float> first = derivative_taps(1, sigma, radius),
                           second = derivative_taps(2, sigma, radius);
  const Channel smooth_rows = filter_rows(luma, smooth);
  Features found{filter_columns(filter_rows(luma, first), smooth),
                 filter_columns(filter_rows(luma, second), smooth)};
  to_magnitude(found.edge, filter_columns(smooth_rows, first));
  to_magnitude(found.point, filter_columns(smooth_rows, second));
  return found;
}

// Y lies in [0,1] instead of [-16,100]: the filters have no response to the shift, only to the scale.
Channel feature_error(const Channel& test, const Channel& reference) {
  const Features t = features(test), r = features(reference);
  Channel error(test.width, test.height);
  for (std::size_t i = 0; i < error.values.size(); ++i) {
    const float edge = std::abs(t.edge.values[i] - r.edge.values[i]);
    const float point = std::abs(t.point.values[i] - r.point.values[i]);
    const float larger = std::max(edge, point) / 116.0f;
    error.values[i] = std::min(1.0f, std::pow(larger / std::numbers::sqrt2_v<float>, kFeatureExponent));
  }
  return error;
}

}  // namespace

Channel flip_error(const Image& test, const Image& reference) {
  const Channels test_channels = opponent_channels(test), reference_channels = opponent_channels(reference);
  Channel error = feature_error(test_channels[0], reference_channels[0]);
  const Channels t = filtered_by_sensitivity(test_channels), r = filtered_by_sensitivity(reference_channels);
  for (std::size_t i = 0; i < error.values.size(); ++i) {
    const glm::vec3 p = linear_from_opponent(t[0].values[i], t[1].values[i], t[2].values[i]);
    const glm::vec3 q = linear_from_opponent(r[0].values[i], r[1].values[i], r[2].values[i]);
    const float color = remapped(color_distance(hunt_lab_from_linear(p), hunt_lab_from_linear(q)));
    error.values[i] = std::pow(color, 1.0f - error.values[i]);
  }
  return error;
}

}  // namespace hwsim::pipeline
