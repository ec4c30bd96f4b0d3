#include "hwsim/base/content_hash.h"

#include <bit>
#include <cstddef>
#include <cstring>

namespace hwsim {
static_assert(std::endian::native == std::endian::little,
              "files and keys are little-endian and read by memcpy");

namespace {
constexpr std::uint64_t kPrime = 0x100000001b3u;
}  // namespace

std::uint64_t fnv1a(std::span<const std::uint8_t> bytes, std::uint64_t before) {
  for (const std::uint8_t byte : bytes) before = (before ^ byte) * kPrime;
  return before;
}

std::uint64_t fnv1a(std::string_view text) {
  return fnv1a({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void ContentHash::add_word(std::uint64_t word) {
  a_ = (a_ ^ word) * kPrime;
  a_ ^= a_ >> 32;  // the product carries only upward: without this the high bytes of a word would not reach
                   // the low bits
  b_ = (b_ ^ __builtin_bswap64(word)) * kPrime;
  b_ ^= b_ >> 29;
}

void ContentHash::add(std::span<const std::uint8_t> bytes) {
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + at, 8);
    add_word(word);
  }
  std::uint64_t tail = 0;
  if (at < bytes.size()) std::memcpy(&tail, bytes.data() + at, bytes.size() - at);
  add_word(tail);
  add_word(
      bytes.size());  // files that differ in trailing zeros, or in where one file ends and the next begins
}

std::string ContentHash::hex() const {
  std::string out;
  for (const std::uint64_t part : {a_, b_})
    for (int shift = 60; shift >= 0; shift -= 4) out += "0123456789abcdef"[(part >> shift) & 15];
  return out;
}

}  // namespace hwsim
