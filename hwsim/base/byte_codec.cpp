#include "hwsim/base/byte_codec.h"

#include <array>

#include "hwsim/base/content_hash.h"

namespace hwsim {
namespace {

constexpr std::size_t kKindBytes = 8;
constexpr std::size_t kHeaderBytes = kSealBytes;
static_assert(kHeaderBytes == kKindBytes + 2 * 8 + 2 * 8);

std::uint64_t kind_word(std::string_view kind) {
  std::uint64_t word = 0;
  std::memcpy(&word, kind.data(), std::min(kind.size(), kKindBytes));
  return word;
}

/// The checksum of everything before and behind it.
std::array<std::uint64_t, 2> check_sum(std::span<const std::uint8_t> start,
                                       std::span<const std::uint8_t> payload) {
  ContentHash hash;
  hash.add(start);
  hash.add(payload);
  return hash.words();
}

}  // namespace

std::vector<std::uint8_t> seal_of(std::string_view kind, std::uint64_t version,
                                  std::span<const std::uint8_t> payload) {
  ByteWriter header;
  header.word(kind_word(kind));
  header.word(version);
  header.word(payload.size());
  std::vector<std::uint8_t> start = header.take();
  ByteWriter file;
  file.raw(start);
  for (const std::uint64_t word : check_sum(start, payload)) file.word(word);
  return file.take();
}

std::vector<std::uint8_t> seal(std::string_view kind, std::uint64_t version,
                               std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> file = seal_of(kind, version, payload);
  file.insert(file.end(), payload.begin(), payload.end());
  return file;
}

std::span<const std::uint8_t> open_seal(std::string_view kind, std::uint64_t version,
                                        std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes) throw DamagedBytes("it ends too early");
  ByteReader header(bytes.first(kHeaderBytes));
  if (header.word() != kind_word(kind)) throw DamagedBytes("it holds something else");
  if (header.word() != version) throw DamagedBytes("it was written by another version");
  const auto payload = bytes.subspan(kHeaderBytes);
  if (header.word() != payload.size()) throw DamagedBytes("it has another length than its header says");
  for (const std::uint64_t word : check_sum(bytes.first(kHeaderBytes - 16), payload))
    if (header.word() != word) throw DamagedBytes("its check sum does not match");
  return payload;
}

}  // namespace hwsim
