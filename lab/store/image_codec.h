#pragma once
// Images in files of the cache: every bit of every channel.
#include "hwsim/base/byte_codec.h"
#include "pipeline/image/image.h"

namespace hwsim::lab {

/// Channel by channel; one that is the same everywhere (alpha, unused ones of the heat map) takes one value.
void encode_image(ByteWriter& out, const pipeline::Image& image);

/// Throws DamagedBytes.
pipeline::Image decode_image(ByteReader& in);

}  // namespace hwsim::lab
