#include "pipeline/access/access_tracker.h"

#include <algorithm>
#include <utility>

#include "pipeline/base/parallel.h"

namespace hwsim::pipeline {

void AccessTracker::halve(ReuseStream stream) {
  std::size_t& count = counts_[index_of(stream)];
  int& shift = kept[index_of(stream)].shift;
  while (count > accesses_max_ && shift < kShiftMax) {
    ++shift;
    count -= std::erase_if(
        accesses, [&](const BlockAccess& a) { return a.stream == stream && !is_sampled(a.block, shift); });
  }
  if (last_.stream == stream) last_is_kept_ = is_sampled(last_.block, shift);
}

// Accesses of equal order come from one worker, which kept their order; the analysis sorts stably.
ReuseProfile make_reuse_profile(std::span<AccessTracker* const> workers, bool exact, int jobs) {
  BlockKinds kinds = workers.front()->kept;
  for (const AccessTracker* worker : workers)
    for (std::size_t s = 0; s < kinds.size(); ++s)
      kinds[s].shift = std::max(kinds[s].shift, worker->kept[s].shift);
  std::vector<BlockAccess> all;
  std::array<std::uint64_t, kCacheSizes + 1> l1_missing{};
  for (AccessTracker* worker : workers) {
    for (const BlockAccess& a : worker->accesses)
      if (is_sampled(a.block, kinds[index_of(a.stream)].shift)) all.push_back(a);
    std::vector<BlockAccess>().swap(worker->accesses);
    for (std::size_t i = 0; i < l1_missing.size(); ++i) l1_missing[i] += worker->l1_missing[i];
  }
  const RunParts side_by_side = [jobs](std::size_t count, const std::function<void(std::size_t)>& part) {
    parallel_for(count, jobs, [&part](std::size_t i, int) { part(i); });
  };
  ReuseProfile profile = analyze_reuse(std::move(all), kinds, exact ? SIZE_MAX : kAccessesMax, side_by_side);
  const int shift = workers.front()->kinds[index_of(ReuseStream::texture)].shift;
  std::uint64_t missed = 0;
  for (std::size_t k = kCacheSizes; k-- > 0;) {
    missed += l1_missing[k + 1];
    profile.texture_l1.read_bytes[k] = (missed << shift) * kLineBytes;
  }
  return profile;
}

}  // namespace hwsim::pipeline
