// Storage buffers of a pass, word by word, lanes in order: shared by fragment and compute contexts. An index
// outside the buffer reads 0 and writes nothing, as robust buffer access has it. Per-target include guard.
#include <cstring>

#include "pipeline/batch/fragment_batch.h"
#include "pipeline/simd/lanes-inl.h"

#if defined(HWSIM_SHADE_BUFFER_ACCESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_BUFFER_ACCESS_INL_H_
#undef HWSIM_SHADE_BUFFER_ACCESS_INL_H_
#else
#define HWSIM_SHADE_BUFFER_ACCESS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

class BufferAccess {
 public:
  BufferAccess(const ResourceView& resources, int slot, int first_lane)
      : words_(resources.buffers[static_cast<std::size_t>(slot)]),
        count_(resources.buffer_words[static_cast<std::size_t>(slot)]),
        tracker_(resources.tracker),
        slot_(slot),
        first_lane_(first_lane) {}

  LaneI load_words(LaneI index, LaneM mask) const {
    HWY_ALIGN std::int32_t at[kVectorLanes], out[kVectorLanes] = {};
    store(index, at);
    for (std::uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      if (!holds(at[lane])) continue;
      out[lane] = static_cast<std::int32_t>(__atomic_load_n(words_ + at[lane], __ATOMIC_RELAXED));
      note(lane, at[lane], 4, 0);
    }
    return load(out);
  }

  /// For counters alone: neither a load of the program nor traffic of the GPU.
  LaneM holds_nonzero(LaneI index, LaneM mask) const {
    HWY_ALIGN std::int32_t at[kVectorLanes], out[kVectorLanes] = {};
    store(index, at);
    for (std::uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      if (holds(at[lane])) out[lane] = words_[at[lane]] != 0 ? 1 : 0;
    }
    return load(out) > LaneI(0);
  }

  void store_words(LaneI index, LaneI value, LaneM mask) const {
    HWY_ALIGN std::int32_t at[kVectorLanes], from[kVectorLanes];
    store(index, at);
    store(value, from);
    for (std::uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      if (!holds(at[lane])) continue;
      __atomic_store_n(words_ + at[lane], static_cast<std::uint32_t>(from[lane]), __ATOMIC_RELAXED);
      note(lane, at[lane], 0, 4);
    }
  }

  /// Returns the words before. Sums do not depend on the order; which lane sees which value does.
  LaneI add_words(LaneI index, LaneI value, LaneM mask) const {
    return change_words(index, value, mask, [](std::uint32_t* word, std::uint32_t by) {
      return __atomic_fetch_add(word, by, __ATOMIC_RELAXED);
    });
  }
  /// One lane's addition to a word that is a float.
  void add_float(std::int32_t index, float value) const {
    if (!holds(index)) return;
    float sum;
    std::memcpy(&sum, words_ + index, sizeof(sum));
    sum += value;
    std::memcpy(words_ + index, &sum, sizeof(sum));
    note(0, index, 4, 4);
    tracker_->count_atomic(slot_, index);
  }
  /// Likewise, putting the values in their place.
  LaneI exchange_words(LaneI index, LaneI value, LaneM mask) const {
    return change_words(index, value, mask, [](std::uint32_t* word, std::uint32_t by) {
      return __atomic_exchange_n(word, by, __ATOMIC_RELAXED);
    });
  }

 private:
  template <class Change>
  LaneI change_words(LaneI index, LaneI value, LaneM mask, Change&& change) const {
    HWY_ALIGN std::int32_t at[kVectorLanes], from[kVectorLanes], out[kVectorLanes] = {};
    store(index, at);
    store(value, from);
    for (std::uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      if (!holds(at[lane])) continue;
      out[lane] =
          static_cast<std::int32_t>(change(words_ + at[lane], static_cast<std::uint32_t>(from[lane])));
      note(lane, at[lane], 4, 4);
      tracker_->count_atomic(slot_, at[lane]);
    }
    return load(out);
  }
  bool holds(std::int32_t index) const { return index >= 0 && static_cast<std::uint64_t>(index) < count_; }

  std::uint32_t* words_;
  std::uint64_t count_;
  void note(int lane, std::int32_t index, std::uint32_t read, std::uint32_t write) const {
    tracker_->use_if_sampled((first_lane_ + lane) / 4, ReuseStream::storage,
                             buffer_line(slot_, static_cast<std::uint32_t>(index)), read, write);
  }

  AccessTracker* tracker_;
  int slot_, first_lane_;
};

inline constexpr std::uint64_t kWordBytes = 4;

/// Bytes of one word for each lane of a mask.
HWY_INLINE std::uint64_t word_bytes(LaneM mask) {
  return kWordBytes * static_cast<std::uint64_t>(__builtin_popcount(mask_bits(mask)));
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
