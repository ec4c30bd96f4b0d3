#pragma once
// A PNG writer for tests: uncompressed deflate blocks, any header, so that damaged and absurd files can be
// made.
#include <cstdint>
#include <string>
#include <vector>

namespace hwsim::pipeline::testing {

struct PngHeader {
  std::uint32_t width = 1, height = 1;
  std::uint8_t bit_depth = 8;
  std::uint8_t color_type = 6;  ///< 0 gray, 2 RGB, 4 gray + alpha, 6 RGBA
};

/// `rows`: all rows' bytes as PNG stores them (16-bit values big-endian), without the filter bytes.
std::vector<std::uint8_t> make_png(const PngHeader& header, const std::vector<std::uint8_t>& rows);

/// A JPEG of 16 x 8 pixels: the left half near (200, 100, 20), the right half near (40, 100, 220).
std::vector<std::uint8_t> two_color_jpeg();

/// An empty folder of this test alone, removed by nobody: its name holds the process number.
std::string scratch_folder(const std::string& name);

}  // namespace hwsim::pipeline::testing
