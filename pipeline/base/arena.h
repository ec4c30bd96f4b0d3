#pragma once
// Memory that is taken piece by piece and given back all at once, to be taken again: what would be asked for
// and returned in every pass costs page faults.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

namespace hwsim::pipeline {

class Arena {
 public:
  /// Room for `count` elements, without values.
  template <class T>
  T* take(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kAlignment);
    return reinterpret_cast<T*>(take_bytes(count * sizeof(T)));
  }
  /// All that was taken becomes free; of the memory, `kept_bytes` or a little more stay here.
  void clear(std::size_t kept_bytes) {
    std::size_t kept = 0, blocks = 0;
    while (blocks < blocks_.size() && kept < kept_bytes) kept += blocks_[blocks++].bytes;
    blocks_.resize(blocks);
    block_ = used_ = 0;
  }
  std::size_t held_bytes() const {
    std::size_t bytes = 0;
    for (const Block& block : blocks_) bytes += block.bytes;
    return bytes;
  }

 private:
  static constexpr std::size_t kAlignment = 16, kBlockBytes = std::size_t{1} << 20;
  struct Block {
    std::unique_ptr<std::byte[]> memory;
    std::size_t bytes = 0;
  };

  std::byte* take_bytes(std::size_t bytes) {
    bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    while (block_ < blocks_.size() && used_ + bytes > blocks_[block_].bytes) {
      ++block_;
      used_ = 0;
    }
    if (block_ == blocks_.size()) {
      const std::size_t size = std::max(bytes, kBlockBytes);
      blocks_.push_back({std::make_unique_for_overwrite<std::byte[]>(size), size});
    }
    std::byte* const at = blocks_[block_].memory.get() + used_;
    used_ += bytes;
    return at;
  }

  std::vector<Block> blocks_;
  std::size_t block_ = 0, used_ = 0;  ///< where the next piece begins
};

}  // namespace hwsim::pipeline
