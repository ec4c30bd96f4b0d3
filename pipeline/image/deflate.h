#pragma once
// The zlib format (RFC 1950), in which PNG and OpenEXR files store their pixels.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hwsim::pipeline {

/// Appends the compressed bytes to `out`. One level for all pictures: a third of the time of zlib's default,
/// for files that are a tenth larger.
void deflate(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out);

/// False where the stream is damaged, or does not hold just as many bytes as `out` takes.
bool inflate(std::span<const std::uint8_t> stream, std::span<std::uint8_t> out);

/// The check sum of ISO 3309, which PNG's chunks end with.
std::uint32_t crc32_of(std::span<const std::uint8_t> bytes);

}  // namespace hwsim::pipeline
