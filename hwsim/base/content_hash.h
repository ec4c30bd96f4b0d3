#pragma once
// Hashes that name what is kept on disk.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace hwsim {

/// FNV-1a over bytes, 64 bits: the same number in every build, which std::hash is not.
inline constexpr std::uint64_t kFnvStart = 0xcbf29ce484222325u;
std::uint64_t fnv1a(std::span<const std::uint8_t> bytes, std::uint64_t before = kFnvStart);
std::uint64_t fnv1a(std::string_view text);

/// Two 64-bit FNV-1a sums over 8-byte little-endian words, from different bases, the second fed with
/// byte-swapped words: a key for caches, not a defense against forgers. By words, since by bytes 4 GiB would
/// take ten seconds.
class ContentHash {
 public:
  void add(std::span<const std::uint8_t> bytes);
  std::array<std::uint64_t, 2> words() const { return {a_, b_}; }
  std::string hex() const;  ///< 32 digits

 private:
  void add_word(std::uint64_t word);
  std::uint64_t a_ = kFnvStart;
  std::uint64_t b_ = 0x84222325cbf29ce4u;
};

}  // namespace hwsim
