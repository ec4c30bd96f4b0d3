#pragma once
// The C interface between the project and the image module. No type of the C++ library and no exception
// crosses it, so that the module may be built by another compiler, and only bytes do: the module never opens
// a file.
#include <cstddef>
#include <cstdint>

extern "C" {

enum { kHwsimImageAbiVersion = 2, kHwsimImageMaxExtentPx = 16384 };

enum HwsimImageStatus {
  kHwsimImageOk = 0,
  kHwsimImageDamaged = 1,
  kHwsimImageTooLarge = 2,
  kHwsimImageFailed = 3,
  kHwsimImageNoMemory = 4  ///< or no thread
};

/// Receives what a call produced. `allocate` is called at most once, and not when the call fails before its
/// output's size is known; a null result makes the call fail.
struct HwsimImageOutput {
  void* user;
  void* (*allocate)(void* user, int width, int height);  ///< 4 elements a pixel: bytes or floats
  char* error;                                           ///< a message, always terminated
  std::size_t error_bytes;
};

/// RGBA, alpha not multiplied in, values as stored (no transfer function). `as_float`: floats instead of
/// bytes.
using HwsimImageDecode = int (*)(const std::uint8_t* bytes, std::size_t byte_count, int as_float,
                                 const HwsimImageOutput* output);

/// What the module exports, under the name "hwsim_image_module".
struct HwsimImageModule {
  int abi_version;
  HwsimImageDecode decode;
};

}  // extern "C"
