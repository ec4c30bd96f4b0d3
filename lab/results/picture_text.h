#pragma once
// Words and scales in pictures.
#include <string_view>

#include "pipeline/image/image.h"

namespace hwsim::lab {

inline constexpr int kTextHeightPx = 15;
inline constexpr glm::vec4 kPaper{0.9f, 0.9f, 0.9f, 1.0f};

int text_width_px(std::string_view text);

/// The upper left corner of the first letter is at (x, y). Letters of any case look alike; what has no glyph
/// is a gap.
void draw_text(pipeline::Image& image, int x, int y, std::string_view text);

/// The picture with a strip below it: the colors of an error map from 0 to `full_scale`, with numbers and,
/// where there is room, what they count. A strip that is wider than the picture makes it wider.
pipeline::Image with_scale(const pipeline::Image& picture, double full_scale, std::string_view what);

}  // namespace hwsim::lab
