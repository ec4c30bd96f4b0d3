#include "hwsim/trace/format.h"

#include <cstddef>

namespace hwsim {
namespace {
using enum RateClass;
constexpr std::array<FormatInfo, 30> kFormats = {{
    // name            ch bytes class       float  int    depth  stencil
    {"none", 0, 0, bits32, false, false, false, false},
    {"r8_unorm", 1, 1, bits32, false, false, false, false},
    {"r8_uint", 1, 1, bits32, false, true, false, false},
    {"rg8_unorm", 2, 2, bits32, false, false, false, false},
    {"rg8_uint", 2, 2, bits32, false, true, false, false},
    {"rgba8_unorm", 4, 4, bits32, false, false, false, false},
    {"rgba8_srgb", 4, 4, srgb32, false, false, false, false},
    {"rgba8_snorm", 4, 4, bits32, false, false, false, false},
    {"rgba8_uint", 4, 4, bits32, false, true, false, false},
    {"rgb10a2_unorm", 4, 4, bits32, false, false, false, false},
    {"r11g11b10_float", 3, 4, bits32, true, false, false, false},
    {"r16_float", 1, 2, bits32, true, false, false, false},
    {"r16_uint", 1, 2, bits32, false, true, false, false},
    {"rg16_float", 2, 4, float1_32, true, false, false, false},
    {"rg16_snorm", 2, 4, bits32, false, false, false, false},
    {"rg16_uint", 2, 4, bits32, false, true, false, false},
    {"rgba16_float", 4, 8, half4_64, true, false, false, false},
    {"rgba16_unorm", 4, 8, half4_64, false, false, false, false},
    {"rgba16_snorm", 4, 8, half4_64, false, false, false, false},
    {"r32_float", 1, 4, float1_32, true, false, false, false},
    {"r32_uint", 1, 4, float1_32, false, true, false, false},
    {"rg32_float", 2, 8, bits64, true, false, false, false},
    {"rg32_uint", 2, 8, bits64, false, true, false, false},
    {"rgba32_float", 4, 16, float4_128, true, false, false, false},
    {"rgba32_uint", 4, 16, float4_128, false, true, false, false},
    {"d16_unorm", 1, 2, depth, false, false, true, false},
    {"d24_unorm_s8", 1, 4, depth, false, false, true, true},
    {"d32_float", 1, 4, depth, true, false, true, false},
    {"d32_float_s8", 1, 8, depth, true, false, true, true},
    {"s8_uint", 1, 1, depth, false, false, true, true},
}};
static_assert(kFormats.size() == static_cast<std::size_t>(kLastFormat) + 1);
}  // namespace

const FormatInfo& info(Format format) { return kFormats[static_cast<std::size_t>(format)]; }

}  // namespace hwsim
