#include "hwsim/detailed/surroundings.h"

#include <algorithm>
#include <cmath>

namespace hwsim {
namespace {

const MissCurve& curve_of(const ReuseProfile& reuse, Stream stream) {
  static const MissCurve none;
  switch (stream) {
    case Stream::color:
      return reuse.apart[index_of(ReuseStream::color)];
    case Stream::depth:
      return reuse.apart[index_of(ReuseStream::depth)];
    case Stream::texture:
      return reuse.apart[index_of(ReuseStream::texture)];
    case Stream::storage:
      return reuse.apart[index_of(ReuseStream::storage)];
    case Stream::vertex:
    case Stream::index:
      return reuse.apart[index_of(ReuseStream::geometry)];
    default:
      return none;
  }
}

/// The part of the requests that reach L2 beyond each size. First reads of a cleared target are none of
/// DRAM's business.
Survival beyond_l2(const PassWork& pass, const MissCurve& curve, Stream stream, bool write, double reached) {
  if (write) return survival(curve.write_bytes, curve.requested_write_bytes, reached);
  std::array<std::uint64_t, kCacheSizes> bytes = curve.read_bytes;
  const bool cleared = (stream == Stream::color && pass.color_cleared_before) ||
                       (stream == Stream::depth && pass.depth_cleared_before);
  if (cleared)
    for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] -= std::min(bytes[k], curve.first_read_bytes[k]);
  return survival(bytes, curve.requested_read_bytes, reached);
}

}  // namespace

MemoryClient client_of(Stream stream) {
  switch (stream) {
    case Stream::color:
      return MemoryClient::color;
    case Stream::depth:
      return MemoryClient::depth;
    case Stream::other:
      return MemoryClient::other;
    default:
      return MemoryClient::reads;
  }
}

Surroundings::Surroundings(const PassWork& pass_work, const PacketPlan& packet_plan, const GpuConfig& config,
                           const GpuRates<double>& gpu_rates, std::uint64_t first_seed)
    : pass(pass_work),
      plan(packet_plan),
      gpu(config),
      rates(gpu_rates),
      seed(first_seed),
      memory(config, first_seed),
      random(first_seed ^ 0x5bd1e995) {
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    const auto stream = static_cast<Stream>(i);
    const MissCurve& curve = curve_of(pass.reuse, stream);
    reads[i] = beyond_l2(pass, curve, stream, false, plan.reaches_l2.read[i]);
    writes[i] = beyond_l2(pass, curve, stream, true, plan.reaches_l2.write[i]);
  }
}

double Surroundings::whole(double mean) {
  const double low = std::floor(mean);
  return low + (random.ratio() < mean - low ? 1.0 : 0.0);
}

}  // namespace hwsim
