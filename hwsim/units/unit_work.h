#pragma once
// What every unit is made of: a description, the streams of bytes that it moves, and the work of a chunk that
// it is asked to serve.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hwsim/trace/work_trace.h"

namespace hwsim {

enum class Stream : std::uint8_t { depth, color, texture, storage, vertex, index, constant, shader, other };
inline constexpr int kStreamCount = 9;
std::string_view stream_name(Stream stream);
constexpr std::size_t index_of(Stream stream) { return static_cast<std::size_t>(stream); }

/// A set of streams, a bit each.
using StreamSet = unsigned;
constexpr StreamSet set_of() { return 0; }
template <class... More>
constexpr StreamSet set_of(Stream first, More... more) {
  return 1u << index_of(first) | set_of(more...);
}
constexpr bool holds(StreamSet set, std::size_t stream) { return (set >> stream & 1u) != 0; }

/// Where a unit stands in the chain.
enum class UnitPlace : std::uint8_t {
  front,   ///< every packet goes through it before the cores take it
  cores,   ///< it is a pipe of the shader cores: subgroups live in it
  rops,    ///< packets go through it when they leave the cores
  memory,  ///< lines go through it, of all units
};

struct UnitInfo {
  std::string_view id;
  UnitPlace place = UnitPlace::front;
  StreamSet streams = 0;     ///< that it moves itself, through L2 or past it
  std::string_view service;  ///< its service time in words: the row of docs/hardware_model.md
};

/// Bytes by stream, for any scalar type.
template <class T>
struct StreamBytesOf {
  std::array<T, kStreamCount> read, write;
  StreamBytesOf() {
    read.fill(T(0.0));
    write.fill(T(0.0));
  }
  StreamBytesOf& operator+=(const StreamBytesOf& other) {
    for (std::size_t i = 0; i < kStreamCount; ++i) {
      read[i] += other.read[i];
      write[i] += other.write[i];
    }
    return *this;
  }
  T total() const {
    T sum(0.0);
    for (std::size_t i = 0; i < kStreamCount; ++i) sum += read[i] + write[i];
    return sum;
  }
};

inline constexpr double kTilePixels = 64.0;        // the trace's tiles are 8x8 pixels
inline constexpr double kTextureLineBytes = 64.0;  // the trace's lines are 64 bytes

/// Bytes that a chunk moves through L2 and DRAM.
template <class T>
struct ChunkTraffic {
  StreamBytesOf<T> dram;
  T l2_bytes{0.0};
  T l1_fill_bytes{0.0};
  T storage_read_bytes{0.0};
  /// Lines that a subgroup waits for: textures beyond L1, storage always.
  T l1_missed_lines() const { return (l1_fill_bytes + storage_read_bytes) / kTextureLineBytes; }
  T l2_missed_lines() const {
    return (dram.read[index_of(Stream::texture)] + dram.read[index_of(Stream::storage)]) / kTextureLineBytes;
  }
};

/// What a unit is asked to serve: a chunk of a pass, and the bytes that it moves.
template <class T>
struct UnitWork {
  const PassCounters& counters;
  const PassWork& pass;
  const ChunkTraffic<T>& traffic;
};

}  // namespace hwsim
