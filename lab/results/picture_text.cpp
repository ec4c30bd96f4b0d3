#include "lab/results/picture_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "pipeline/image/metrics.h"

namespace hwsim::lab {
namespace {

constexpr int kTextScale = 3;
constexpr int kGlyphWidth = 3, kGlyphHeight = kTextHeightPx / kTextScale;
constexpr glm::vec4 kInk{0.02f, 0.02f, 0.02f, 1.0f};
constexpr int kGapPx = 6, kRampHeightPx = 12, kRampWidthMinPx = 120;

/// Five rows of three dots, the top row first, the left dot in the highest bit: enough for ids of techniques.
const std::map<char, std::array<int, 5>>& glyphs() {
  static const std::map<char, std::array<int, 5>> font = {
      {'a', {2, 5, 7, 5, 5}}, {'b', {6, 5, 6, 5, 6}}, {'c', {3, 4, 4, 4, 3}}, {'d', {6, 5, 5, 5, 6}},
      {'e', {7, 4, 6, 4, 7}}, {'f', {7, 4, 6, 4, 4}}, {'g', {3, 4, 5, 5, 3}}, {'h', {5, 5, 7, 5, 5}},
      {'i', {7, 2, 2, 2, 7}}, {'j', {1, 1, 1, 5, 2}}, {'k', {5, 5, 6, 5, 5}}, {'l', {4, 4, 4, 4, 7}},
      {'m', {5, 7, 7, 5, 5}}, {'n', {6, 5, 5, 5, 5}}, {'o', {2, 5, 5, 5, 2}}, {'p', {6, 5, 6, 4, 4}},
      {'q', {2, 5, 5, 6, 3}}, {'r', {6, 5, 6, 5, 5}}, {'s', {3, 4, 2, 1, 6}}, {'t', {7, 2, 2, 2, 2}},
      {'u', {5, 5, 5, 5, 7}}, {'v', {5, 5, 5, 5, 2}}, {'w', {5, 5, 7, 7, 5}}, {'x', {5, 5, 2, 5, 5}},
      {'y', {5, 5, 2, 2, 2}}, {'z', {7, 1, 2, 4, 7}}, {'0', {7, 5, 5, 5, 7}}, {'1', {2, 6, 2, 2, 7}},
      {'2', {7, 1, 7, 4, 7}}, {'3', {7, 1, 3, 1, 7}}, {'4', {5, 5, 7, 1, 1}}, {'5', {7, 4, 7, 1, 7}},
      {'6', {7, 4, 7, 5, 7}}, {'7', {7, 1, 2, 2, 2}}, {'8', {7, 5, 7, 5, 7}}, {'9', {7, 5, 7, 1, 7}},
      {'_', {0, 0, 0, 0, 7}}, {'-', {0, 0, 7, 0, 0}}, {'+', {0, 2, 7, 2, 0}}, {'=', {0, 7, 0, 7, 0}},
      {':', {0, 2, 0, 2, 0}}, {'.', {0, 0, 0, 0, 2}}, {',', {0, 0, 0, 2, 4}}, {'%', {5, 1, 2, 4, 5}},
      {'(', {1, 2, 2, 2, 1}}, {')', {4, 2, 2, 2, 4}}, {'/', {1, 1, 2, 4, 4}}};
  return font;
}

}  // namespace

int text_width_px(std::string_view text) {
  return static_cast<int>(text.size()) * (kGlyphWidth + 1) * kTextScale;
}

void draw_text(pipeline::Image& image, int x, int y, std::string_view text) {
  for (const char c : text) {
    const auto glyph = glyphs().find(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
    for (int row = 0; glyph != glyphs().end() && row < kGlyphHeight * kTextScale; ++row)
      for (int column = 0; column < kGlyphWidth * kTextScale; ++column)
        if ((glyph->second[static_cast<size_t>(row / kTextScale)] >>
             (kGlyphWidth - 1 - column / kTextScale)) &
            1)
          if (x + column < image.width && y + row < image.height) image.at(x + column, y + row) = kInk;
    x += (kGlyphWidth + 1) * kTextScale;
  }
}

pipeline::Image with_scale(const pipeline::Image& picture, double full_scale, std::string_view what) {
  const std::string end = fmt::format("{:.3g}", full_scale), middle = fmt::format("{:.3g}", full_scale / 2.0);
  const int width = std::max(picture.width, kRampWidthMinPx + text_width_px(end) + 3 * kGapPx);
  const int strip = kRampHeightPx + kTextHeightPx + 3 * kGapPx, top = picture.height + kGapPx;
  const int ramp = std::min(width - text_width_px(end) - 3 * kGapPx, 3 * kRampWidthMinPx);
  pipeline::Image scaled(width, picture.height + strip, kPaper);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) scaled.at(x, y) = picture.at(x, y);
  for (int x = 0; x < ramp; ++x) {
    const glm::vec3 shown = pipeline::magma(static_cast<float>(x) / static_cast<float>(ramp - 1));
    for (int y = 0; y < kRampHeightPx; ++y)
      scaled.at(kGapPx + x, top + y) = {pipeline::linear_from_srgb(shown.x),
                                        pipeline::linear_from_srgb(shown.y),
                                        pipeline::linear_from_srgb(shown.z), 1.0f};
  }
  const int line = top + kRampHeightPx + kGapPx;
  draw_text(scaled, kGapPx, line, "0");
  draw_text(scaled, kGapPx + (ramp - text_width_px(middle)) / 2, line, middle);
  draw_text(scaled, kGapPx + ramp - text_width_px("0") / 2, line, end);
  const int words = kGapPx + ramp + text_width_px(end) + kGapPx;
  if (words + text_width_px(what) <= width) draw_text(scaled, words, line, what);
  return scaled;
}

}  // namespace hwsim::lab
