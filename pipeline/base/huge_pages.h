#pragma once
// Large pages for memory that is written from end to end: a fault for each 2 MiB in place of one for each 4
// KiB.
#include <cstddef>
#include <type_traits>

namespace hwsim::pipeline {

/// A hint to the system, for large sizes alone. Memory that is touched here and there would take more of it.
void prefer_huge_pages(void* memory, std::size_t bytes);

/// The same for elements.
template <class T>
void prefer_huge_pages(T* first, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  prefer_huge_pages(static_cast<void*>(first), count * sizeof(T));
}

}  // namespace hwsim::pipeline
