#pragma once
// Completion times of a chain of servers with finite queues between them and blocking after service.
#include <cstddef>
#include <vector>

namespace hwsim {

/// Services of `chunks` pieces of work at `units` servers, unit by unit within a chunk.
template <class T>
struct ServiceTable {
  std::size_t units = 0;
  std::size_t chunks = 0;
  std::vector<T> ns;  ///< ns[chunk * units + unit]
  const T& at(std::size_t unit, std::size_t chunk) const { return ns[chunk * units + unit]; }
};

template <class T>
struct QueueResult {
  T makespan_ns{0.0};
  std::vector<T> critical_ns;  ///< by unit: service on the critical path; sums to the makespan
};

/// The max-plus recurrence of tandem queues with blocking:
///   done[u][k] = max(done[u-1][k], done[u][k-1], done[u+1][k-depth]) + service[u][k]
/// (a piece starts when it has arrived, its server is free, and the queue after the server has room). Which
/// of the three was last is kept, so that the longest path can be walked back: it says which unit's service
/// the time consists of.
template <class T>
class TandemQueue {
 public:
  TandemQueue(const ServiceTable<T>& services, std::size_t depth)
      : services_(services),
        depth_(depth),
        done_(services.ns.size(), T(0.0)),
        last_(services.ns.size(), Last::start) {}

  QueueResult<T> run() {
    for (std::size_t k = 0; k < services_.chunks; ++k)
      for (std::size_t u = 0; u < services_.units; ++u) advance(u, k);
    return walk_back();
  }

 private:
  enum class Last : unsigned char { start, same_unit, unit_before, unit_after };

  std::size_t index(std::size_t u, std::size_t k) const { return k * services_.units + u; }

  void advance(std::size_t u, std::size_t k) {
    T ready(0.0);
    Last last = Last::start;
    const auto wait = [&](std::size_t other_u, std::size_t other_k, Last from) {
      const T& time = done_[index(other_u, other_k)];
      if (last == Last::start || ready < time) {
        ready = time;
        last = from;
      }
    };
    if (k > 0) wait(u, k - 1, Last::same_unit);  // first: a tie belongs to the unit that was busy
    if (u > 0) wait(u - 1, k, Last::unit_before);
    if (u + 1 < services_.units && k >= depth_) wait(u + 1, k - depth_, Last::unit_after);
    done_[index(u, k)] = ready + services_.at(u, k);
    last_[index(u, k)] = last;
  }

  QueueResult<T> walk_back() const {
    QueueResult<T> result;
    result.critical_ns.assign(services_.units, T(0.0));
    if (services_.units == 0 || services_.chunks == 0) return result;
    std::size_t u = services_.units - 1, k = services_.chunks - 1;
    result.makespan_ns = done_[index(u, k)];
    for (;;) {
      result.critical_ns[u] += services_.at(u, k);
      const Last last = last_[index(u, k)];
      if (last == Last::start) return result;
      if (last == Last::same_unit) --k;
      if (last == Last::unit_before) --u;
      if (last == Last::unit_after) ++u, k -= depth_;
    }
  }

  const ServiceTable<T>& services_;
  std::size_t depth_;
  std::vector<T> done_;
  std::vector<Last> last_;
};

}  // namespace hwsim
