// The loop of parallel.h on oneTBB, whose threads outlive a loop.
#include "pipeline/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

namespace hwsim::pipeline {

// Each thread takes the next index, so that they start in order: a caller that begins with the longest parts
// keeps no thread waiting at the end.
void parallel_for(std::size_t count, int jobs, const std::function<void(std::size_t, int)>& body) {
  if (jobs <= 1 || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) body(i, 0);
    return;
  }
  // Without it TBB starts no more threads than there are processors, and prints a warning.
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(jobs));
  tbb::task_arena arena(jobs);
  std::atomic<std::size_t> next{0};
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, jobs, 1),
        [&](const tbb::blocked_range<int>& /*range*/) {
          const int worker = tbb::this_task_arena::current_thread_index();
          try {
            for (std::size_t i = next++; i < count; i = next++) body(i, worker);
          } catch (...) {
            next = count;  // the others stop at their next index
            throw;
          }
        },
        tbb::simple_partitioner());
  });
}

}  // namespace hwsim::pipeline
