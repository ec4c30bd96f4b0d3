#include "hwsim/trace/reuse.h"

#include <algorithm>

namespace hwsim {
namespace {

/// Sums over prefixes of positions.
class PrefixSums {
 public:
  explicit PrefixSums(std::size_t size) : sums_(size + 1, 0) {}
  void add(std::size_t position, std::int64_t value) {
    for (std::size_t i = position + 1; i < sums_.size(); i += i & (~i + 1)) sums_[i] += value;
  }
  std::int64_t before(std::size_t position) const {
    std::int64_t sum = 0;
    for (std::size_t i = position; i > 0; i -= i & (~i + 1)) sum += sums_[i];
    return sum;
  }

 private:
  std::vector<std::int64_t> sums_;
};

constexpr auto kSizes = static_cast<std::size_t>(kCacheSizes);

/// What a block did since it came into the cache, for each size of cache.
struct Stay {
  std::size_t last = 0;  ///< position of the last access + 1; 0: none yet
  std::array<std::uint32_t, kSizes> read{}, write{};
  std::array<bool, kSizes> first{};
};

class CurveBuilder {
 public:
  CurveBuilder(const BlockKinds& kinds, std::array<MissCurve, kReuseStreams>& curves)
      : kinds_(kinds), curves_(curves) {}

  void access(Stay& stay, const BlockAccess& a, std::size_t missing) {
    if (stay.last != 0) leave(stay, a.stream, missing);
    const bool first = stay.last == 0;
    for (std::size_t k = 0; k < missing; ++k) {
      stay.first[k] = first;
      stay.read[k] = a.read_bytes;
      stay.write[k] = a.write_bytes;
    }
    for (std::size_t k = missing; k < kSizes; ++k) {
      stay.read[k] += a.read_bytes;
      stay.write[k] += a.write_bytes;
    }
  }
  /// The block leaves the caches of the first `sizes` sizes.
  void leave(const Stay& stay, ReuseStream stream, std::size_t sizes) {
    const BlockKind kind = kinds_[index_of(stream)];
    MissCurve& curve = curves_[index_of(stream)];
    for (std::size_t k = 0; k < sizes; ++k) {
      const std::uint64_t read = moved(kind, stay.read[k]) << kind.shift;
      curve.read_bytes[k] += read;
      curve.first_read_bytes[k] += stay.first[k] ? read : 0;
      curve.write_bytes[k] += moved(kind, stay.write[k]) << kind.shift;
      curve.read_stays[k] += std::uint64_t{stay.read[k] > 0} << kind.shift;
      curve.write_stays[k] += std::uint64_t{stay.write[k] > 0} << kind.shift;
    }
  }

 private:
  static std::uint64_t moved(const BlockKind& kind, std::uint32_t bytes) {
    if (bytes == 0) return 0;
    return kind.whole ? kind.bytes : std::min(bytes, kind.bytes);
  }
  const BlockKinds& kinds_;
  std::array<MissCurve, kReuseStreams>& curves_;
};

/// Stays by stream and block: a table that is filled at most by half, so that a look ends soon.
class StayTable {
 public:
  explicit StayTable(std::size_t accesses) {
    std::size_t size = 16;
    while (size < 2 * accesses) size *= 2;
    slots_.assign(size, 0);
  }
  Stay& of(ReuseStream stream, std::uint32_t block) {
    std::size_t slot = (block_hash(block) * kReuseStreams + index_of(stream)) & (slots_.size() - 1);
    while (slots_[slot] != 0 && !is(keys_[slots_[slot] - 1], stream, block))
      slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == 0) {
      keys_.push_back({stream, block});
      stays_.emplace_back();
      slots_[slot] = static_cast<std::uint32_t>(stays_.size());
    }
    return stays_[slots_[slot] - 1];
  }
  template <class Visit>
  void each(Visit&& visit) const {
    for (std::size_t i = 0; i < stays_.size(); ++i) visit(keys_[i].stream, stays_[i]);
  }

 private:
  struct Key {
    ReuseStream stream;
    std::uint32_t block;
  };
  static bool is(const Key& key, ReuseStream stream, std::uint32_t block) {
    return key.stream == stream && key.block == block;
  }
  std::vector<std::uint32_t> slots_;  ///< number of the stay + 1; 0: free
  std::vector<Key> keys_;
  std::vector<Stay> stays_;
};

/// Curves of the streams that `belongs` takes, which share one cache.
template <class Belongs>
void build_curves(std::span<const BlockAccess> accesses, const BlockKinds& kinds, Belongs&& belongs,
                  std::array<MissCurve, kReuseStreams>& curves) {
  CurveBuilder builder(kinds, curves);
  StayTable stays(accesses.size());
  PrefixSums present(accesses.size());
  for (std::size_t i = 0; i < accesses.size(); ++i) {
    const BlockAccess& a = accesses[i];
    if (!belongs(a.stream)) continue;
    const BlockKind& kind = kinds[index_of(a.stream)];
    const auto weight = static_cast<std::int64_t>(kind.bytes) << kind.shift;
    Stay& stay = stays.of(a.stream, a.block);
    std::size_t missing = kSizes;
    if (stay.last != 0) {
      const std::int64_t others = present.before(i) - present.before(stay.last);
      missing = static_cast<std::size_t>(sizes_below(static_cast<std::uint64_t>(others) + kind.bytes));
      present.add(stay.last - 1, -weight);
    }
    builder.access(stay, a, missing);
    present.add(i, weight);
    stay.last = i + 1;
  }
  stays.each([&](ReuseStream stream, const Stay& stay) { builder.leave(stay, stream, kSizes); });
}

/// Fewer blocks of a stream that has too many accesses.
void thin(std::vector<BlockAccess>& accesses, BlockKinds& kinds, std::size_t accesses_max) {
  for (std::size_t s = 0; s < kinds.size(); ++s) {
    const auto stream = static_cast<ReuseStream>(s);
    const auto of_stream = [stream](const BlockAccess& a) { return a.stream == stream; };
    while (kinds[s]
               .shift<kShiftMax&& static_cast<std::size_t>(
                   std::count_if(accesses.begin(), accesses.end(), of_stream))>
                   accesses_max) {
      const int shift = ++kinds[s].shift;
      std::erase_if(accesses,
                    [&](const BlockAccess& a) { return of_stream(a) && !is_sampled(a.block, shift); });
    }
  }
}

void count_requests(std::span<const BlockAccess> accesses, const BlockKinds& kinds, ReuseProfile& profile) {
  for (const BlockAccess& a : accesses) {
    const std::size_t s = index_of(a.stream);
    for (MissCurve* curve : {&profile.shared[s], &profile.apart[s]}) {
      curve->requested_read_bytes += std::uint64_t{a.read_bytes} << kinds[s].shift;
      curve->requested_write_bytes += std::uint64_t{a.write_bytes} << kinds[s].shift;
    }
  }
}

/// Where the value is, or the size. Eight at a time, which compilers put on registers.
std::size_t place_of(std::uint32_t value, std::span<const std::uint32_t> values) {
  constexpr std::size_t kAtOnce = 8;
  std::size_t i = 0;
  for (; i + kAtOnce <= values.size(); i += kAtOnce) {
    std::uint32_t equal = 0;
    for (std::size_t k = 0; k < kAtOnce; ++k) equal |= values[i + k] == value ? 1u : 0u;
    if (equal != 0) break;
  }
  while (i < values.size() && values[i] != value) ++i;
  return i;
}

}  // namespace

int sizes_below(std::uint64_t bytes) {
  int count = 0;
  for (std::uint64_t size = 1024; count < kCacheSizes && size < bytes; size *= 2) ++count;
  return count;
}

void run_in_order(std::size_t count, const std::function<void(std::size_t)>& part) {
  for (std::size_t i = 0; i < count; ++i) part(i);
}

ReuseProfile analyze_reuse(std::vector<BlockAccess> accesses, BlockKinds kinds, std::size_t accesses_max,
                           const RunParts& run_parts) {
  thin(accesses, kinds, accesses_max);
  const auto by_order = [](const BlockAccess& a, const BlockAccess& b) { return a.order < b.order; };
  if (!std::is_sorted(accesses.begin(), accesses.end(), by_order))
    std::stable_sort(accesses.begin(), accesses.end(), by_order);
  ReuseProfile profile;
  count_requests(accesses, kinds, profile);
  const auto build = [&](auto&& belongs, std::array<MissCurve, kReuseStreams>& curves) {
    build_curves(accesses, kinds, belongs, curves);
  };
  run_parts(4, [&](std::size_t part) {  // each writes curves of its own
    if (part == 0) build([](ReuseStream) { return true; }, profile.shared);
    if (part == 1) build([](ReuseStream s) { return s == ReuseStream::color; }, profile.apart);
    if (part == 2) build([](ReuseStream s) { return s == ReuseStream::depth; }, profile.apart);
    if (part == 3)
      build([](ReuseStream s) { return index_of(s) >= index_of(ReuseStream::texture); }, profile.apart);
  });
  return profile;
}

int RecentBlocks::missing_sizes(std::uint32_t block, std::uint32_t block_bytes) {
  if (!latest_.empty() && latest_.front() == block) return sizes_below(block_bytes);  // most often
  const std::size_t place = place_of(block, latest_);
  const bool missing = place == latest_.size();
  if (missing && latest_.size() >= std::max<std::size_t>(4, (kWindowBytes / block_bytes) >> shift_))
    latest_.back() = block;
  else if (missing)
    latest_.push_back(block);
  if (place > 0 && !latest_.empty()) {
    const auto from = missing ? latest_.end() - 1 : latest_.begin() + static_cast<std::ptrdiff_t>(place);
    std::rotate(latest_.begin(), from, from + 1);
  }
  if (missing) return kCacheSizes;
  return sizes_below((static_cast<std::uint64_t>(place) << shift_) * block_bytes + block_bytes);
}

SetAssociativeCache::SetAssociativeCache(std::size_t bytes, std::size_t line_bytes, std::size_t ways)
    : sets_(std::max<std::size_t>(1, bytes / (line_bytes * ways))), ways_(ways), tags_(sets_ * ways_, 0) {}

bool SetAssociativeCache::access(std::uint64_t line) {
  // Sets by a hash, as GPUs do against strides (a plain modulus would put a column of tiles in one set).
  const std::uint64_t mixed = (line ^ line >> 7 ^ line >> 14) * 0x9e3779b97f4a7c15ull;
  const auto first = tags_.begin() + static_cast<std::ptrdiff_t>((mixed >> 20) % sets_ * ways_);
  const auto last = first + static_cast<std::ptrdiff_t>(ways_);
  auto found = std::find(first, last, line + 1);
  const bool hit = found != last;
  if (!hit) {
    found = last - 1;
    *found = line + 1;
  }
  std::rotate(first, found, found + 1);
  return hit;
}

}  // namespace hwsim
