#include "pipeline/base/zeroed_vector.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

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

}  // namespace hwsim::pipeline
