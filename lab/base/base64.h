#pragma once
// Bytes as text (RFC 4648), for data URIs.
#include <cstdint>
#include <span>
#include <string>

namespace hwsim::lab {

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace hwsim::lab
