#pragma once
// Bytes of files that hwsim writes for itself and reads back: varints, and a seal that tells a whole file
// from a damaged one.
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hwsim {

/// The bytes are not what a writer of this version wrote. Readers of whole files turn it into "no such
/// entry".
class DamagedBytes : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ByteWriter {
 public:
  /// LEB128: seven bits a byte, the lowest first; the counts of a trace are mostly small.
  void count(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<std::uint8_t>(value | 0x80));
    bytes_.push_back(static_cast<std::uint8_t>(value));
  }
  /// Zigzag: the sign in the lowest bit, so that small negative numbers are short too.
  void integer(std::int64_t value) {
    count((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
  }
  void word(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) bytes_.push_back(static_cast<std::uint8_t>(value >> shift));
  }
  void real(double value) { word(std::bit_cast<std::uint64_t>(value)); }
  void raw(std::span<const std::uint8_t> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  void text(std::string_view value) {
    count(value.size());
    raw({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
  }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Throws DamagedBytes rather than read past the end.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint64_t count() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t byte = take(1).front();
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    throw DamagedBytes("a number has more than 64 bits");
  }
  std::int64_t integer() {
    const std::uint64_t value = count();
    return static_cast<std::int64_t>((value >> 1) ^ (~(value & 1) + 1));
  }
  std::uint64_t word() {
    std::uint64_t value = 0;
    int shift = 0;
    for (const std::uint8_t byte : take(8)) value |= static_cast<std::uint64_t>(byte) << shift, shift += 8;
    return value;
  }
  double real() { return std::bit_cast<double>(word()); }
  std::span<const std::uint8_t> raw(std::uint64_t size) { return take(size); }
  std::string text() {
    const auto bytes = take(count());
    return {bytes.begin(), bytes.end()};
  }
  /// A number of elements that follow: each takes a byte at least, so that a damaged one cannot ask for all
  /// memory.
  std::size_t elements() {
    const std::uint64_t value = count();
    if (value > bytes_.size()) throw DamagedBytes("a list is longer than the file");
    return static_cast<std::size_t>(value);
  }
  std::span<const std::uint8_t> rest() { return take(bytes_.size()); }
  void expect_end() const {
    if (!bytes_.empty()) throw DamagedBytes("bytes follow the end");
  }

 private:
  std::span<const std::uint8_t> take(std::uint64_t size) {
    if (size > bytes_.size()) throw DamagedBytes("it ends too early");
    const auto taken = bytes_.first(static_cast<std::size_t>(size));
    bytes_ = bytes_.subspan(static_cast<std::size_t>(size));
    return taken;
  }
  std::span<const std::uint8_t> bytes_;
};

/// The header that seals `payload`: kind (up to eight characters), version, length and check sum.
std::vector<std::uint8_t> seal_of(std::string_view kind, std::uint64_t version,
                                  std::span<const std::uint8_t> payload);
inline constexpr std::size_t kSealBytes = 40;

/// `payload` behind a header of kind (up to eight characters), version, length and check sum.
std::vector<std::uint8_t> seal(std::string_view kind, std::uint64_t version,
                               std::span<const std::uint8_t> payload);

/// The payload, if `bytes` are whole and of this kind and version; otherwise throws DamagedBytes with the
/// reason.
std::span<const std::uint8_t> open_seal(std::string_view kind, std::uint64_t version,
                                        std::span<const std::uint8_t> bytes);

}  // namespace hwsim
