#pragma once
// Formats of images in GPU memory: what the driver allocates, what the ROP and the texture unit are charged
// for.
#include <array>
#include <cstdint>
#include <string_view>

namespace hwsim {

enum class Format : std::uint8_t {
  none,
  r8_unorm,
  r8_uint,
  rg8_unorm,
  rg8_uint,
  rgba8_unorm,
  rgba8_srgb,
  rgba8_snorm,
  rgba8_uint,
  rgb10a2_unorm,
  r11g11b10_float,
  r16_float,
  r16_uint,
  rg16_float,
  rg16_snorm,
  rg16_uint,
  rgba16_float,
  rgba16_unorm,
  rgba16_snorm,
  r32_float,
  r32_uint,
  rg32_float,
  rg32_uint,
  rgba32_float,
  rgba32_uint,
  d16_unorm,
  d24_unorm_s8,
  d32_float,
  d32_float_s8,
  s8_uint,
};
inline constexpr Format kLastFormat = Format::s8_uint;

/// The class by which ROP, export and texture rates are tabulated (docs/hardware_sources.md#rops).
enum class RateClass : std::uint8_t { bits32, srgb32, half4_64, float1_32, bits64, float4_128, depth };

struct FormatInfo {
  std::string_view name;
  std::uint8_t channels;
  std::uint8_t bytes;  ///< per element, as allocated; d32_float_s8 takes 8 in practice
                       ///< (docs/techniques/conventions.md#formats)
  RateClass rate_class;
  bool is_float;
  bool is_integer;  ///< no blending, no filtering, no resolve
  bool is_depth;
  bool has_stencil;
};

const FormatInfo& info(Format format);

}  // namespace hwsim
