#include "pipeline/emulate/pass_reuse.h"

#include <algorithm>

namespace hwsim::pipeline {
namespace {

std::uint64_t scaled(std::uint64_t value, std::uint64_t part, std::uint64_t whole) {
  return static_cast<std::uint64_t>(static_cast<__uint128_t>(std::min(value, whole)) * part / whole);
}

}  // namespace

std::array<std::uint32_t, kMaxImageSlots> image_lines(const FrameGraph& graph, const Pass& pass,
                                                      std::uint64_t texture_lines) {
  std::array<std::uint32_t, kMaxImageSlots> first{};
  std::uint64_t next = texture_lines;
  for (std::size_t i = 0; i < pass.sampled.size(); ++i) {
    first[i] = static_cast<std::uint32_t>(next);
    next += allocated_bytes(graph.image(pass.sampled[i])) / kLineBytes + kBlockLanes;
  }
  return first;
}

BlockKinds block_kinds(const FrameGraph& graph, const Pass& pass, const PassContext& c,
                       std::uint64_t texture_lines, bool exact) {
  const int shift_max = exact ? 0 : kReuseShiftMax;
  BlockKinds kinds;
  std::uint64_t lines = pass.kind == PassKind::draw ? texture_lines : 0, stored = 0, tiles = 0;
  for (const ImageId id : pass.sampled) lines += allocated_bytes(graph.image(id)) / kLineBytes;
  for (const BufferId id : pass.storage) stored += 4 * graph.buffer(id).words / kLineBytes;
  for (const ImageId id : pass.targets) stored += allocated_bytes(graph.image(id)) / kLineBytes;
  for (const GpuImage* target : c.color) {
    tiles += target->touched_chunk.size();
    const auto bytes = static_cast<std::uint32_t>(kBlockLanes * target->samples * info(target->format).bytes);
    kinds[index_of(ReuseStream::color)].bytes = std::max(kinds[index_of(ReuseStream::color)].bytes, bytes);
  }
  kinds[index_of(ReuseStream::texture)].shift = sample_shift(lines, shift_max);
  kinds[index_of(ReuseStream::storage)].shift = sample_shift(stored, shift_max);
  kinds[index_of(ReuseStream::geometry)].shift = shift_max;
  kinds[index_of(ReuseStream::color)].whole = kinds[index_of(ReuseStream::depth)].whole = false;
  kinds[index_of(ReuseStream::color)].shift = sample_shift(tiles, shift_max);
  if (c.depth == nullptr) return kinds;
  kinds[index_of(ReuseStream::depth)].bytes =
      static_cast<std::uint32_t>(kBlockLanes * c.depth->samples * c.depth_bytes);
  kinds[index_of(ReuseStream::depth)].shift = sample_shift(c.depth->touched_chunk.size(), shift_max);
  return kinds;
}

// Requests of tiles are those of the sample: their ratio varies less than either. Those of lines are known.
ReuseProfile merge_reuse(std::span<BinWorker> workers, const PassWork& work, bool exact, int jobs) {
  std::vector<AccessTracker*> trackers;
  for (BinWorker& worker : workers) trackers.push_back(&worker.tracker);
  ReuseProfile profile = make_reuse_profile(trackers, exact, jobs);
  const MemCounters mem = total(work).mem;
  const auto request = [&profile](ReuseStream stream, std::uint64_t read, std::uint64_t write) {
    for (MissCurve* curve : {&profile.shared[index_of(stream)], &profile.apart[index_of(stream)]}) {
      curve->requested_read_bytes = read;
      curve->requested_write_bytes = write;
    }
  };
  request(ReuseStream::texture, mem.texture_read_bytes, 0);
  request(ReuseStream::storage, mem.storage_read_bytes, mem.storage_write_bytes);
  request(ReuseStream::geometry, mem.vertex_read_bytes + mem.index_read_bytes, 0);
  profile.texture_l1.requested_read_bytes = mem.texture_read_bytes;
  return profile;
}

void share_same_address(std::span<const BinWorker> workers, PassWork& work) {
  std::vector<std::uint64_t> sums(AccessTracker::kAtomicSlots, 0);
  for (const BinWorker& worker : workers)
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += worker.tracker.atomics[i];
  const std::uint64_t hottest = *std::max_element(sums.begin(), sums.end());
  const std::uint64_t all = total(work).shader.atomic_lane_ops;
  if (all == 0) return;
  std::uint64_t before = 0;
  for (PassCounters& n : work.chunks) {
    const std::uint64_t after = before + n.shader.atomic_lane_ops;
    n.shader.same_address_atomic_lane_ops = scaled(hottest, after, all) - scaled(hottest, before, all);
    before = after;
  }
}

}  // namespace hwsim::pipeline
