#include "pipeline/base/huge_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace hwsim::pipeline {
namespace {
constexpr std::size_t kLeastBytes = std::size_t{4} << 20;  // two large pages, wherever they begin
}

void prefer_huge_pages(void* memory, std::size_t bytes) {
  if (bytes < kLeastBytes) return;
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t begin = (address + page - 1) / page * page, end = (address + bytes) / page * page;
  // Where the system has no such pages, or wants none, nothing changes.
  (void)madvise(static_cast<char*>(memory) + (begin - address), end - begin, MADV_HUGEPAGE);
}

}  // namespace hwsim::pipeline
