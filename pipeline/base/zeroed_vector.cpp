#include "pipeline/base/zeroed_vector.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace hwsim::pipeline {

std::size_t give_back_pages(void* memory, std::size_t bytes) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t begin = (address + page - 1) / page * page, end = (address + bytes) / page * page;
  if (begin >= end) return 0;
  return madvise(static_cast<char*>(memory) + (begin - address), end - begin, MADV_DONTNEED) == 0
             ? end - begin
             : 0;
}

void copy_but_zeros(const void* from, void* to, std::size_t bytes) {
  constexpr std::size_t kPage = 4096;
  static constexpr std::array<char, kPage> kZeros{};
  const char* source = static_cast<const char*>(from);
  char* target = static_cast<char*>(to);
  for (std::size_t at = 0; at < bytes; at += kPage) {
    const std::size_t count = std::min(kPage, bytes - at);
    if (std::memcmp(source + at, kZeros.data(), count) != 0) std::memcpy(target + at, source + at, count);
  }
}

}  // namespace hwsim::pipeline
