#include "algos/base/shaders/gbuffer_layouts.h"

namespace hwsim::algos {
namespace {

constexpr GBufferAttachment kLauritzen[] = {{"gbuffer_normal", Format::rgba16_float},
                                            {"gbuffer_albedo", Format::rgba8_srgb},
                                            {"gbuffer_gradient", Format::rg16_float}};
constexpr GBufferAttachment kRecord[] = {{"gbuffer_position", Format::rgba32_float},
                                         {"gbuffer_normal", Format::rg16_snorm},
                                         {"gbuffer_albedo", Format::rgba8_srgb},
                                         {"gbuffer_emissive", Format::r11g11b10_float},
                                         {"gbuffer_gradient", Format::rg16_float}};
constexpr GBufferAttachment kCompact[] = {{"gbuffer_normal", Format::rg16_snorm},
                                          {"gbuffer_albedo", Format::rgba8_srgb},
                                          {"gbuffer_specular", Format::rgba8_srgb}};
constexpr GBufferAttachment kSplit[] = {{"gbuffer_normal", Format::rg16_snorm},
                                        {"gbuffer_surface", Format::rgba8_unorm},
                                        {"gbuffer_albedo", Format::rgba8_srgb},
                                        {"gbuffer_gradient", Format::rg16_float}};

// 40 bytes as 32 + 4 + 4: docs/techniques/deferred.md#g-buffers. 16 bytes with depth:
// docs/techniques/agaa.md#memory.
constexpr GBufferLayout kLayouts[] = {
    {"gb_lauritzen", "16 bytes and depth with stencil a sample, lit color in half floats",
     GBufferEncoding::gradients, kLauritzen, Format::d32_float, Format::d32_float_s8, Format::rgba16_float},
    {"gb_sbaa40", "40 bytes a sample, depth and lit color included: 32 as SBAA's record",
     GBufferEncoding::record, kRecord, Format::d24_unorm_s8, Format::d24_unorm_s8, Format::rgba8_srgb},
    {"gb_agaa16", "16 bytes a sample, depth included", GBufferEncoding::compact, kCompact,
     Format::d24_unorm_s8, Format::d24_unorm_s8, Format::rgba8_srgb},
    {"gb_20", "20 bytes a sample, depth included, as typical for games", GBufferEncoding::gradients,
     kLauritzen, Format::d24_unorm_s8, Format::d24_unorm_s8, Format::rgba8_srgb},
    {"gb_mrt4", "four targets of 32 bits and depth without stencil, lit color in half floats",
     GBufferEncoding::split, kSplit, Format::d32_float, Format::d32_float, Format::rgba16_float},
};

}  // namespace

std::span<const GBufferLayout> gbuffer_layouts() { return kLayouts; }

int gbuffer_sample_bytes(const GBufferLayout& layout, int samples) {
  int bytes = info(samples > 1 ? layout.depth_multisampled : layout.depth).bytes;
  for (const GBufferAttachment& attachment : layout.attachments) bytes += info(attachment.format).bytes;
  return bytes;
}

}  // namespace hwsim::algos
