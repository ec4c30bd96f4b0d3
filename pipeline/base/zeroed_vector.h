#pragma once
// A vector of zeros whose memory the system gives when it is first touched.
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace hwsim::pipeline {

/// Gives the whole pages among the bytes back to the system: they read as zeros until they are written again.
/// Returns how many bytes went.
std::size_t give_back_pages(void* memory, std::size_t bytes);

/// Copies to memory that is zero.
void copy_but_zeros(const void* from, void* to, std::size_t bytes);

/// Memory of `calloc`: for large sizes these are pages that the kernel makes when they are written. Elements
/// that are made without a value are not written.
template <class T>
struct ZeroedAllocator {
  static_assert(std::is_trivially_copyable_v<T>);
  using value_type = T;

  ZeroedAllocator() = default;
  template <class U>
  explicit(false) ZeroedAllocator(const ZeroedAllocator<U>& /*other*/) {}

  T* allocate(std::size_t count) {
    void* memory = std::calloc(count, sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t /*count*/) { std::free(memory); }

  template <class U>
  void construct(U* /*at*/) {}
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
  }
  bool operator==(const ZeroedAllocator& /*other*/) const { return true; }
};

/// For sizes that are set once: an element that was removed and made again keeps its old value. A copy takes
/// no memory for pages of zeros either.
template <class T>
class ZeroedVector : public std::vector<T, ZeroedAllocator<T>> {
 public:
  using Base = std::vector<T, ZeroedAllocator<T>>;
  using Base::Base;
  ZeroedVector() = default;
  ~ZeroedVector() = default;
  ZeroedVector(ZeroedVector&&) noexcept = default;
  ZeroedVector& operator=(ZeroedVector&&) noexcept = default;
  ZeroedVector(const ZeroedVector& other) : Base(other.size()) {
    copy_but_zeros(other.data(), this->data(), other.size() * sizeof(T));
  }
  ZeroedVector& operator=(const ZeroedVector& other) {
    if (this != &other) *this = ZeroedVector(other);
    return *this;
  }
};

/// The same for elements.
template <class T>
std::size_t give_back_pages(T* first, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  return give_back_pages(static_cast<void*>(first), count * sizeof(T));
}

}  // namespace hwsim::pipeline
