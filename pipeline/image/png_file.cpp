#include "pipeline/image/png_file.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "pipeline/image/deflate.h"

namespace hwsim::pipeline {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
enum Filter : std::uint8_t { kNone, kLeft, kAbove, kAverage, kPaeth, kFilters };

void append_be32(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t be32(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 |
         bytes[3];
}

/// What a pixel is expected to be from its neighbors: left, above, and left of above.
int paeth(int left, int above, int corner) {
  const int guess = left + above - corner;
  const int to_left = std::abs(guess - left), to_above = std::abs(guess - above),
            to_corner = std::abs(guess - corner);
  if (to_left <= to_above && to_left <= to_corner) return left;
  return to_above <= to_corner ? above : corner;
}

/// Rows of three bytes a pixel, each by the filter that leaves the smallest differences: no average, which
/// seldom wins. In front of the first pixel and above the first row all is 0.
class RowFilters {
 public:
  explicit RowFilters(std::size_t row_bytes) : bytes_(row_bytes) {
    for (Bytes& line : lines_) line.resize(1 + row_bytes);
    for (std::size_t f = 0; f < kTried.size(); ++f) lines_[f][0] = kTried[f];
  }

  const Bytes& best(const std::uint8_t* row, const std::uint8_t* above) {
    constexpr std::size_t kPixel = 3;
    const std::size_t first = std::min(kPixel, bytes_);
    std::copy_n(row, bytes_, lines_[0].begin() + 1);
    for (std::size_t i = 0; i < bytes_; ++i) lines_[2][1 + i] = static_cast<std::uint8_t>(row[i] - above[i]);
    for (std::size_t i = 0; i < first; ++i) {
      lines_[1][1 + i] = row[i];
      lines_[3][1 + i] = lines_[2][1 + i];
    }
    for (std::size_t i = first; i < bytes_; ++i) {
      lines_[1][1 + i] = static_cast<std::uint8_t>(row[i] - row[i - kPixel]);
      lines_[3][1 + i] =
          static_cast<std::uint8_t>(row[i] - paeth(row[i - kPixel], above[i], above[i - kPixel]));
    }
    return *std::min_element(lines_.begin(), lines_.end(),
                             [](const Bytes& a, const Bytes& b) { return cost(a) < cost(b); });
  }

 private:
  static constexpr std::array<std::uint8_t, 4> kTried = {kNone, kLeft, kAbove, kPaeth};

  static std::uint32_t cost(const Bytes& line) {
    std::uint32_t sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i)
      sum += static_cast<std::uint32_t>(std::min<int>(line[i], 256 - line[i]));
    return sum;
  }

  std::size_t bytes_;
  std::array<Bytes, kTried.size()> lines_;
};

/// A filtered row in place; false for a filter that there is none of.
bool unfilter(std::uint8_t filter, std::uint8_t* row, const std::uint8_t* above, std::size_t bytes,
              std::size_t pixel) {
  if (filter >= kFilters) return false;
  const auto add = [](std::uint8_t& to, int value) { to = static_cast<std::uint8_t>(to + value); };
  for (std::size_t i = 0; i < bytes; ++i) {
    const int left = i < pixel ? 0 : row[i - pixel], corner = i < pixel ? 0 : above[i - pixel];
    if (filter == kLeft) add(row[i], left);
    if (filter == kAbove) add(row[i], above[i]);
    if (filter == kAverage) add(row[i], (left + above[i]) / 2);
    if (filter == kPaeth) add(row[i], paeth(left, above[i], corner));
  }
  return true;
}

struct PlainPng {
  std::uint32_t width = 0, height = 0;
  std::size_t channels = 0;
  Bytes stream;
};

/// Chunks that say nothing about the texels' values.
bool is_remark(const std::uint8_t* type) {
  constexpr std::array<std::string_view, 9> kRemarks = {"gAMA", "cHRM", "sRGB", "iCCP", "pHYs",
                                                        "tEXt", "zTXt", "iTXt", "tIME"};
  const std::string_view name(reinterpret_cast<const char*>(type), 4);
  return std::ranges::find(kRemarks, name) != kRemarks.end();
}

bool read_header(const std::uint8_t* data, std::size_t length, PlainPng& png) {
  constexpr std::size_t kLength = 13;
  constexpr std::array<std::size_t, 7> kChannels = {1, 0, 3, 0, 2, 0, 4};  // by color type; palettes: none
  if (length != kLength || data[8] != 8 || data[9] >= kChannels.size()) return false;
  if (data[10] != 0 || data[11] != 0 || data[12] != 0) return false;
  png.width = be32(data);
  png.height = be32(data + 4);
  png.channels = kChannels[data[9]];
  return png.channels != 0 && png.width != 0 && png.height != 0;
}

std::optional<PlainPng> find_plain(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kFraming = 12;  // length, type, checksum
  PlainPng png;
  for (std::size_t at = kSignature.size(); at <= bytes.size() && bytes.size() - at >= kFraming;) {
    const std::uint8_t* chunk = bytes.data() + at;
    const std::size_t length = be32(chunk);
    if (length > bytes.size() - at - kFraming) return {};
    const std::uint8_t *type = chunk + 4, *data = chunk + 8;
    if (std::memcmp(type, "IHDR", 4) == 0) {
      if (png.channels != 0 || !read_header(data, length, png)) return {};
    } else if (std::memcmp(type, "IDAT", 4) == 0) {
      png.stream.insert(png.stream.end(), data, data + length);
    } else if (std::memcmp(type, "IEND", 4) == 0) {
      return png.channels != 0 ? std::optional(std::move(png)) : std::nullopt;
    } else if (!is_remark(type)) {
      return {};
    }
    at += kFraming + length;
  }
  return {};
}

void expand(const std::uint8_t* row, std::size_t width, std::size_t channels, std::uint32_t* texels) {
  const bool gray = channels < 3, alpha = channels % 2 == 0;
  for (std::size_t x = 0; x < width; ++x, row += channels) {
    const std::uint32_t r = row[0], g = gray ? r : row[1], b = gray ? r : row[2];
    texels[x] = r | g << 8 | b << 16 | (alpha ? std::uint32_t{row[channels - 1]} : 255u) << 24;
  }
}

}  // namespace

void append_png_signature(Bytes& out) { out.insert(out.end(), kSignature.begin(), kSignature.end()); }

void append_png_chunk(Bytes& out, std::string_view type, std::span<const std::uint8_t> data) {
  append_be32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append_be32(out, crc32_of(std::span(out).subspan(begin)));
}

Bytes encode_png(int width, int height, std::span<const std::uint8_t> rgb) {
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(width);
  RowFilters filters(row_bytes);
  Bytes rows, nothing(row_bytes, 0), stream, header, out;
  rows.reserve((row_bytes + 1) * static_cast<std::size_t>(height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    const std::uint8_t* row = rgb.data() + y * row_bytes;
    const Bytes& line = filters.best(row, y == 0 ? nothing.data() : row - row_bytes);
    rows.insert(rows.end(), line.begin(), line.end());
  }
  deflate(rows, stream);
  append_be32(header, static_cast<std::uint32_t>(width));
  append_be32(header, static_cast<std::uint32_t>(height));
  header.insert(header.end(), {8, 2, 0, 0, 0});  // 8 bits, RGB, no interlace
  append_png_signature(out);
  append_png_chunk(out, "IHDR", header);
  append_png_chunk(out, "IDAT", stream);
  append_png_chunk(out, "IEND", {});
  return out;
}

std::optional<RawImage> decode_plain_png(std::span<const std::uint8_t> bytes) {
  const std::optional<PlainPng> png = find_plain(bytes);
  if (!png) return {};
  const std::size_t width = png->width, height = png->height, row_bytes = width * png->channels;
  constexpr std::size_t kMostExpansion = 1032;  // deflate's: what claims more is damaged
  if ((row_bytes + 1) * height / kMostExpansion > png->stream.size()) return {};
  Bytes rows((row_bytes + 1) * height);
  if (!inflate(png->stream, rows)) return {};
  RawImage image{static_cast<int>(width), static_cast<int>(height), {}};
  image.texels.resize(width * height);
  const Bytes nothing(row_bytes, 0);
  const std::uint8_t* above = nothing.data();
  for (std::size_t y = 0; y < height; ++y) {
    std::uint8_t* row = rows.data() + y * (row_bytes + 1);
    if (!unfilter(row[0], row + 1, above, row_bytes, png->channels)) return {};
    above = row + 1;
    expand(row + 1, width, png->channels, image.texels.data() + y * width);
  }
  return image;
}

}  // namespace hwsim::pipeline
