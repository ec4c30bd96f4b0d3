#include "pipeline/access/access_tracker.h"

#include <iterator>
#include <utility>

#include "pipeline/base/parallel.h"

namespace hwsim::pipeline {

// Accesses of equal order come from one worker, which kept their order; the analysis sorts stably.
ReuseProfile make_reuse_profile(std::vector<std::vector<BlockAccess>> by_worker, const BlockKinds& kinds,
                                const std::array<std::uint64_t, kCacheSizes + 1>& l1_missing, bool exact,
                                int jobs) {
  constexpr std::size_t kAccessesMax = 32768;  // a stream; bounds the time that a pass takes to analyze
  std::vector<BlockAccess> all = std::move(by_worker.front());
  for (std::size_t i = 1; i < by_worker.size(); ++i)
    all.insert(all.end(), by_worker[i].begin(), by_worker[i].end());
  const RunParts side_by_side = [jobs](std::size_t count, const std::function<void(std::size_t)>& part) {
    parallel_for(count, jobs, [&part](std::size_t i, int) { part(i); });
  };
  ReuseProfile profile = analyze_reuse(std::move(all), kinds, exact ? SIZE_MAX : kAccessesMax, side_by_side);
  const int shift = kinds[index_of(ReuseStream::texture)].shift;
  std::uint64_t missed = 0;
  for (std::size_t k = kCacheSizes; k-- > 0;) {
    missed += l1_missing[k + 1];
    profile.texture_l1.read_bytes[k] = (missed << shift) * kLineBytes;
  }
  return profile;
}

}  // namespace hwsim::pipeline
