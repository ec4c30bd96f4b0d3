#include "pipeline/image/deflate.h"

#include <zlib.h>

#include <new>
#include <stdexcept>

namespace hwsim::pipeline {
namespace {

constexpr int kLevel = 1, kWindowBits = 15, kMemory = 9;

}  // namespace

void deflate(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out) {
  z_stream z{};
  if (deflateInit2(&z, kLevel, Z_DEFLATED, kWindowBits, kMemory, Z_FILTERED) != Z_OK) throw std::bad_alloc();
  const std::size_t before = out.size();
  out.resize(before + deflateBound(&z, bytes.size()));
  z.next_in = const_cast<Bytef*>(bytes.data());  // zlib's interface predates const
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = out.data() + before;
  z.avail_out = static_cast<uInt>(out.size() - before);
  const int status = ::deflate(&z, Z_FINISH);
  out.resize(before + z.total_out);
  deflateEnd(&z);
  if (status != Z_STREAM_END) throw std::logic_error("zlib wants more room than it said");
}

bool inflate(std::span<const std::uint8_t> stream, std::span<std::uint8_t> out) {
  z_stream z{};
  if (inflateInit(&z) != Z_OK) throw std::bad_alloc();
  z.next_in = const_cast<Bytef*>(stream.data());
  z.avail_in = static_cast<uInt>(stream.size());
  z.next_out = out.data();
  z.avail_out = static_cast<uInt>(out.size());
  const int status = ::inflate(&z, Z_FINISH);
  inflateEnd(&z);
  return status == Z_STREAM_END && z.avail_out == 0;
}

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, bytes.data(), bytes.size()));
}

}  // namespace hwsim::pipeline
