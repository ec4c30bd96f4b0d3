// The loop of parallel.h on plain threads, in place of parallel.cpp (HWSIM_THREADS=plain): the thread
// sanitizer knows how std::thread synchronizes, and does not see it inside of oneTBB.
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "pipeline/base/parallel.h"

namespace hwsim::pipeline {

void parallel_for(std::size_t count, int jobs, const std::function<void(std::size_t, int)>& body) {
  const auto threads = static_cast<int>(std::min(count, static_cast<std::size_t>(std::max(jobs, 1))));
  if (threads <= 1) {
    for (std::size_t i = 0; i < count; ++i) body(i, 0);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr first;
  std::mutex mutex;
  const auto work = [&](int worker) {
    try {
      for (std::size_t i = next++; i < count; i = next++) body(i, worker);
    } catch (...) {
      next = count;  // the others stop at their next index
      const std::lock_guard lock(mutex);
      if (!first) first = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int worker = 1; worker < threads; ++worker) others.emplace_back(work, worker);
    work(0);
  }
  if (first) std::rethrow_exception(first);
}

}  // namespace hwsim::pipeline
