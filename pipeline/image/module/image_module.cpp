#include "pipeline/image/module/image_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace {

int fail(const HwsimImageOutput& output, int status, const std::string& message) {
  const std::size_t last = message.find_last_not_of(" \n\r\t");
  std::snprintf(output.error, output.error_bytes, "%s", message.substr(0, last + 1).c_str());
  return status;
}

// The formats are asked for by name: OIIO would try a hundred plug-ins on bytes that none of them knows.
const char* format_of(const std::uint8_t* bytes, std::size_t count) {
  if (count >= 4 && bytes[0] == 0x89 && bytes[1] == 'P') return "png";
  if (count >= 4 && bytes[0] == 0xFF && bytes[1] == 0xD8) return "jpeg";
  return "openexr";
}

// Deflate expands at most 1032 times, so a small PNG that claims more is damaged: found before 1 GiB is
// allocated.
bool png_could_hold(const OIIO::ImageSpec& spec, std::size_t byte_count) {
  const int bits = spec.get_int_attribute("oiio:BitsPerSample", 8);
  const double stored_bits = static_cast<double>(spec.image_pixels()) * std::min(bits, 8);
  return stored_bits / 8.0 <= 1032.0 * static_cast<double>(byte_count);
}

// Which of the file's channels are red, green, blue and alpha; -1: none.
struct Channels {
  int rgba[4] = {-1, -1, -1, -1};
  bool gray = false;  ///< one channel for red, green and blue
};

// OpenEXR stores channels in the order of the alphabet and layers as "layer.R": their names say what they
// are, their places do not. Returns false where no name tells a color.
bool find_exr_channels(const OIIO::ImageSpec& spec, Channels& out) {
  const auto find = [&](std::string_view wanted) {
    for (int pass = 0; pass < 2; ++pass)  // the plain name before any layer's
      for (int i = 0; i < spec.nchannels; ++i) {
        const std::string& name = spec.channelnames[static_cast<std::size_t>(i)];
        const std::size_t dot = name.rfind('.');
        if (pass == 0 ? name == wanted : dot != std::string::npos && name.substr(dot + 1) == wanted) return i;
      }
    return -1;
  };
  constexpr const char* kNames[4] = {"R", "G", "B", "A"};
  for (int c = 0; c < 4; ++c) out.rgba[c] = find(kNames[c]);
  if (out.rgba[0] >= 0 || out.rgba[1] >= 0 || out.rgba[2] >= 0) return true;
  out.gray = true;
  out.rgba[0] = out.rgba[1] = out.rgba[2] = find("Y");
  return out.rgba[0] >= 0;
}

std::string channel_list(const OIIO::ImageSpec& spec) {
  std::string out;
  for (const std::string& name : spec.channelnames) out += (out.empty() ? "" : ", ") + name;
  return out.substr(0, 200);
}

// Red, green, blue and alpha in this order, or gray, or gray and alpha.
Channels channels_in_order(const OIIO::ImageSpec& spec) {
  Channels out;
  const int read = std::min(spec.nchannels, 4);
  out.gray = read < 3;
  for (int c = 0; c < 3; ++c) out.rgba[c] = out.gray ? 0 : c;
  if (spec.alpha_channel >= 0 && spec.alpha_channel < read) out.rgba[3] = spec.alpha_channel;
  return out;
}

template <class T>
bool read_rgba(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, T one, T* rgba) {
  const Channels channels = channels_in_order(spec);
  if (!input.read_image(0, 0, 0, std::min(spec.nchannels, 4), type, rgba,
                        4 * static_cast<OIIO::stride_t>(sizeof(T))))
    return false;
  const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  for (std::size_t i = 0; i < count; ++i) {
    T* texel = rgba + 4 * i;
    const T alpha = channels.rgba[3] >= 0 ? texel[channels.rgba[3]] : one;
    if (channels.gray) texel[1] = texel[2] = texel[0];
    texel[3] = alpha;
  }
  return true;
}

// One channel into every fourth float. OpenEXR's whole numbers are what they say, as its own library
// converts them; OIIO would take them for fractions of 2^32, which is black.
bool read_channel(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int channel, float* to) {
  constexpr OIIO::stride_t kPixel = 4 * static_cast<OIIO::stride_t>(sizeof(float));
  if (spec.channelformat(channel) != OIIO::TypeDesc::UINT32)
    return input.read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::FLOAT, to, kPixel);
  static_assert(sizeof(std::uint32_t) == sizeof(float));
  if (!input.read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::UINT32, to, kPixel)) return false;
  const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  for (std::size_t i = 0; i < count; ++i)
    to[4 * i] = static_cast<float>(std::bit_cast<std::uint32_t>(to[4 * i]));
  return true;
}

// Each channel from where its name is; missing colors are 0, missing alpha is 1.
bool read_named(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const Channels& channels, float* rgba) {
  const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  for (int c = 0; c < 4; ++c) {
    if (const int from = channels.rgba[c]; from < 0)
      for (std::size_t i = 0; i < count; ++i)
        rgba[4 * i + static_cast<std::size_t>(c)] = c == 3 ? 1.0f : 0.0f;
    else if (!read_channel(input, spec, from, rgba + c))
      return false;
  }
  return true;
}

int decode(const std::uint8_t* bytes, std::size_t byte_count, int as_float, const HwsimImageOutput& output) {
  const std::string format = format_of(bytes, byte_count);
  OIIO::Filesystem::IOMemReader reader(bytes, byte_count);
  const auto input = OIIO::ImageInput::create(format);
  if (!input) return fail(output, kHwsimImageFailed, "OpenImageIO lacks its plug-in for " + format);
  OIIO::ImageSpec config, spec;
  config.attribute("oiio:UnassociatedAlpha", 1);
  if (!input->set_ioproxy(&reader))
    return fail(output, kHwsimImageFailed, format + " cannot be read from memory");
  if (!input->open("image", spec, config)) return fail(output, kHwsimImageDamaged, input->geterror());
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1)
    return fail(output, kHwsimImageDamaged, "its size is zero");
  if (spec.width > kHwsimImageMaxExtentPx || spec.height > kHwsimImageMaxExtentPx)
    return fail(output, kHwsimImageTooLarge,
                "it is " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels");
  if (format == "png" && !png_could_hold(spec, byte_count))
    return fail(output, kHwsimImageDamaged, "it is too short for the size that it claims");
  Channels named;
  const bool by_name = format == "openexr" && as_float != 0;
  if (by_name && !find_exr_channels(spec, named))
    return fail(output, kHwsimImageFailed,
                "none of its channels (" + channel_list(spec) + ") is R, G, B or Y");
  void* pixels = output.allocate(output.user, spec.width, spec.height);
  if (!pixels) return fail(output, kHwsimImageNoMemory, "not enough memory");
  const bool done = by_name ? read_named(*input, spec, named, static_cast<float*>(pixels))
                    : as_float
                        ? read_rgba(*input, spec, OIIO::TypeDesc::FLOAT, 1.0f, static_cast<float*>(pixels))
                        : read_rgba(*input, spec, OIIO::TypeDesc::UINT8, std::uint8_t{255},
                                    static_cast<std::uint8_t*>(pixels));
  return done ? kHwsimImageOk : fail(output, kHwsimImageDamaged, input->geterror());
}

int decode_guarded(const std::uint8_t* bytes, std::size_t byte_count, int as_float,
                   const HwsimImageOutput* output) {
  try {
    return decode(bytes, byte_count, as_float, *output);
  } catch (const std::bad_alloc&) {
    return fail(*output, kHwsimImageNoMemory, "not enough memory");
  } catch (const std::system_error&) {
    return fail(*output, kHwsimImageNoMemory, "the system gives no further thread");
  } catch (const std::exception& error) {
    return fail(*output, kHwsimImageDamaged, error.what());
  } catch (...) {
    return fail(*output, kHwsimImageDamaged, "unknown error");
  }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const HwsimImageModule hwsim_image_module;
extern "C" const HwsimImageModule hwsim_image_module = {kHwsimImageAbiVersion, decode_guarded};
