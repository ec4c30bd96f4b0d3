#include "pipeline/image/exr_file.h"

#include <algorithm>
#include <bit>
#include <string_view>

#include "pipeline/image/deflate.h"

namespace hwsim::pipeline {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kRowsAtOnce = 16;  // as the compression "ZIP" has it
constexpr std::size_t kChannels = 3;

void append(Bytes& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
void append32(Bytes& out, int value) { append(out, static_cast<std::uint32_t>(value), 4); }

void append_text(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
  out.push_back(0);
}

void append_attribute(Bytes& out, std::string_view name, std::string_view type, const Bytes& value) {
  append_text(out, name);
  append_text(out, type);
  append32(out, static_cast<int>(value.size()));
  out.insert(out.end(), value.begin(), value.end());
}

Bytes channel_list() {
  Bytes out;
  for (const char* name : {"B", "G", "R"}) {
    append_text(out, name);
    append32(out, 1);  // half
    append32(out, 0);  // not for perception, and three bytes that are not used
    append32(out, 1);
    append32(out, 1);  // a value for every pixel
  }
  out.push_back(0);
  return out;
}

Bytes header(int width, int height) {
  Bytes out, window, one, zeros(8, 0);
  for (const int edge : {0, 0, width - 1, height - 1}) append32(window, edge);
  append(one, std::bit_cast<std::uint32_t>(1.0f), 4);
  append32(out, 20000630);
  append32(out, 2);
  append_attribute(out, "channels", "chlist", channel_list());
  append_attribute(out, "compression", "compression", {3});  // ZIP
  append_attribute(out, "dataWindow", "box2i", window);
  append_attribute(out, "displayWindow", "box2i", window);
  append_attribute(out, "lineOrder", "lineOrder", {0});
  append_attribute(out, "pixelAspectRatio", "float", one);
  append_attribute(out, "screenWindowCenter", "v2f", zeros);
  append_attribute(out, "screenWindowWidth", "float", one);
  out.push_back(0);
  return out;
}

/// Rows of b, g and r.
Bytes planes(int width, int first_row, int rows, std::span<const std::uint16_t> rgb) {
  const auto w = static_cast<std::size_t>(width);
  Bytes out;
  out.reserve(2 * kChannels * w * static_cast<std::size_t>(rows));
  for (int y = first_row; y < first_row + rows; ++y)
    for (std::size_t c = kChannels; c-- > 0;)
      for (std::size_t x = 0; x < w; ++x)
        append(out, rgb[(static_cast<std::size_t>(y) * w + x) * kChannels + c], 2);
  return out;
}

/// Low bytes before high ones, and each as the difference to the one before it.
Bytes differences(const Bytes& raw) {
  Bytes split(raw.size());
  const std::size_t half = (raw.size() + 1) / 2;
  for (std::size_t i = 0; i < raw.size(); ++i) split[i / 2 + (i % 2 == 0 ? 0 : half)] = raw[i];
  for (std::size_t i = split.size(); i-- > 1;)
    split[i] = static_cast<std::uint8_t>(split[i] - split[i - 1] + 128);
  return split;
}

}  // namespace

std::uint16_t half_from_float(float value) {
  constexpr std::uint32_t kInfinity = 0x7F800000u, kSmallestNormal = 0x38800000u, kBeyond = 0x477FF000u;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7FFFFFFFu;
  if (magnitude > kInfinity)  // not a number, which must not become infinity
    return static_cast<std::uint16_t>(sign | 0x7C00u | std::max(1u, magnitude >> 13 & 0x3FFu));
  if (magnitude >= kBeyond) return static_cast<std::uint16_t>(sign | 0x7C00u);
  if (magnitude >= kSmallestNormal) {
    const std::uint32_t odd = magnitude >> 13 & 1u;
    return static_cast<std::uint16_t>(sign | ((magnitude - 0x38000000u + 0xFFFu + odd) >> 13));
  }
  const std::uint32_t shift = 126u - (magnitude >> 23);  // into a subnormal half
  if (shift > 24) return static_cast<std::uint16_t>(sign);
  const std::uint32_t digits = (magnitude & 0x7FFFFFu) | 0x800000u;
  const std::uint32_t odd = digits >> shift & 1u, half = 1u << (shift - 1);
  return static_cast<std::uint16_t>(sign | ((digits + half - 1u + odd) >> shift));
}

Bytes encode_exr_halves(int width, int height, std::span<const std::uint16_t> rgb) {
  Bytes out = header(width, height);
  const int chunks = (height + kRowsAtOnce - 1) / kRowsAtOnce;
  const std::size_t table = out.size();
  out.resize(table + 8 * static_cast<std::size_t>(chunks));
  for (int chunk = 0; chunk < chunks; ++chunk) {
    Bytes place;
    append(place, out.size(), 8);
    std::ranges::copy(place, out.begin() + static_cast<std::ptrdiff_t>(table) + 8 * chunk);
    const int first = chunk * kRowsAtOnce, rows = std::min(kRowsAtOnce, height - first);
    const Bytes raw = planes(width, first, rows, rgb);
    Bytes packed;
    deflate(differences(raw), packed);
    const Bytes& stored = packed.size() < raw.size() ? packed : raw;  // as readers tell them apart
    append32(out, first);
    append32(out, static_cast<int>(stored.size()));
    out.insert(out.end(), stored.begin(), stored.end());
  }
  return out;
}

}  // namespace hwsim::pipeline
