#pragma once
// G-buffer layouts as data (docs/techniques/deferred.md#g-buffers): what deferred techniques store of each
// sample.
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "hwsim/trace/format.h"

namespace hwsim::algos {

/// How shaders write and read the attachments of a layout (gbuffer-inl.h).
enum class GBufferEncoding : std::uint8_t {
  gradients,  ///< normal, roughness and luminance of emission; base color and metallic; depth gradients
  record,     ///< the 32 bytes that SBAA keeps of a surface: position and colored emission too
  compact,    ///< diffuse and specular color instead of base color and metallic; no gradients
  split       ///< what `gradients` holds, in four targets of 32 bits
};

struct GBufferAttachment {
  std::string_view name;
  Format format = Format::none;
};

struct GBufferLayout {
  std::string_view id;
  std::string_view description;
  GBufferEncoding encoding = GBufferEncoding::gradients;
  std::span<const GBufferAttachment> attachments;
  Format depth = Format::none;               ///< one sample a pixel
  Format depth_multisampled = Format::none;  ///< with stencil, for the masks of simple and complex pixels
  Format lit = Format::none;                 ///< lit color, as many samples as the G-buffer
};

/// Choices of the parameter `layout`, in the order of gbuffer_layouts().
inline constexpr std::string_view kLayoutChoices = "gb_lauritzen|gb_sbaa40|gb_agaa16|gb_20|gb_mrt4";
std::span<const GBufferLayout> gbuffer_layouts();

/// Bytes of a sample: attachments and depth, without lit color.
int gbuffer_sample_bytes(const GBufferLayout& layout, int samples);

}  // namespace hwsim::algos
