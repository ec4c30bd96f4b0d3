#pragma once
// Completion times of packets that flow through a chain of units with finite queues between them. The trace
// is not finer than chunks, so the packets of a chunk are alike: what a unit does to a chunk is a straight
// line from the start of its first packet to the end of its last.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "hwsim/gpu/gpu_rates.h"

namespace hwsim {

template <class T>
struct FlowTable {
  std::size_t units = 0;
  std::size_t chunks = 0;
  std::vector<T> ns;  ///< service of a whole chunk: ns[chunk * units + unit]
  std::vector<T>
      latency_ns;  ///< in the same order: between the end of a packet here and its next unit, or its end
  std::vector<T> room_packets;  ///< in the same order: how far the unit may run ahead of the next one
  std::vector<double> packets;  ///< packets of each chunk, at least 1
};

/// From the start of a unit's first work to the end of its last.
template <class T>
struct FlowSpan {
  T begin_ns{0.0}, end_ns{0.0};
};

template <class T>
struct FlowResult {
  T makespan_ns{0.0};
  std::vector<T> critical_ns;  ///< by unit: its part of the longest path; sums to the makespan
};

/// What the makespan gains for each ns of a service and of a latency, and for each packet of room, in the
/// order of the table. Nearly all are zero: only the terms on the longest paths count.
struct FlowSlopes {
  std::vector<double> ns, latency_ns, room_packets;
};

/// Max-plus recurrence over the first and the last packet of each chunk:
///   start[u][k] = max(end[u][k-1], start[u-1][k] + packet[u-1][k] + latency[u-1][k])
///   end[u][k]   = max(start[u][k] + service[u][k], end[u-1][k] + latency[u-1][k] + packet[u][k],
///                     time at which unit u+1 has done the packet that came room[u][k] packets before
///                       + packet[u][k])
/// with packet = service / packets. Rooms of one packet, where units take turns, are beyond it. Which term
/// was last is kept, so that the longest path can be walked back.
template <class T>
class PacketFlow {
 public:
  explicit PacketFlow(const FlowTable<T>& table)
      : t_(table),
        start_(table.ns.size(), T(0.0)),
        end_(start_),
        start_from_(table.ns.size(), From::nothing),
        end_from_(table.ns.size(), From::nothing),
        unblocked_from_(table.ns.size(), From::nothing),
        blocking_chunk_(table.ns.size(), 0),
        before_(table.chunks + 1, 0.0),
        reached_(table.units, 0) {
    for (std::size_t k = 0; k < table.chunks; ++k) before_[k + 1] = before_[k] + table.packets[k];
  }

  FlowResult<T> run() {
    for (std::size_t k = 0; k < t_.chunks; ++k) {
      for (std::size_t u = 0; u < t_.units; ++u) advance(u, k);
      for (std::size_t u = t_.units; u-- > 1;) block(u - 1, k);
    }
    return walk_back();
  }

  /// The derivatives of the makespan, after run(): the recurrence backwards, each maximum as the term that
  /// was last. At a kink they are those of one side.
  FlowSlopes slopes() const {
    FlowSlopes found;
    for (std::vector<double>* column : {&found.ns, &found.latency_ns, &found.room_packets})
      column->assign(t_.ns.size(), 0.0);
    if (t_.units == 0 || t_.chunks == 0) return found;
    Weights of{std::vector<double>(t_.ns.size(), 0.0), std::vector<double>(t_.ns.size(), 0.0)};
    const Place last = last_place();
    const std::size_t i = index(last.u, last.k);
    of.end[i] = 1.0;
    if (last.u + 1 == t_.units) found.latency_ns[i] = 1.0;
    for (std::size_t k = t_.chunks; k-- > 0;) {
      for (std::size_t u = 0; u + 1 < t_.units; ++u) unblock(u, k, of, found);
      for (std::size_t u = t_.units; u-- > 0;) retreat(u, k, of, found);
    }
    return found;
  }

  /// By unit, after run(). A unit without work has a span of no length.
  std::vector<FlowSpan<T>> spans() const {
    std::vector<FlowSpan<T>> found(t_.units);
    std::vector<bool> begun(t_.units, false);
    for (std::size_t k = 0; k < t_.chunks; ++k)
      for (std::size_t u = 0; u < t_.units; ++u) {
        const std::size_t i = index(u, k);
        if (!(t_.ns[i] > T(0.0))) continue;
        if (!begun[u]) found[u] = {start_[i], end_[i]};
        begun[u] = true;
        if (found[u].end_ns < end_[i]) found[u].end_ns = end_[i];
      }
    return found;
  }

 private:
  enum class From : unsigned char { nothing, same_unit, unit_before, unit_after };

  std::size_t index(std::size_t u, std::size_t k) const { return k * t_.units + u; }
  T packet_ns(std::size_t i, std::size_t k) const { return t_.ns[i] / t_.packets[k]; }

  void advance(std::size_t u, std::size_t k) {
    const std::size_t i = index(u, k);
    if (k > 0) {
      start_[i] = end_[index(u, k - 1)];
      start_from_[i] = From::same_unit;
    }
    if (u > 0) {
      const T arrival = start_[i - 1] + packet_ns(i - 1, k) + t_.latency_ns[i - 1];
      if (k == 0 || start_[i] < arrival) {
        start_[i] = arrival;
        start_from_[i] = From::unit_before;
      }
    }
    end_[i] = start_[i] + t_.ns[i];
    end_from_[i] = From::same_unit;
    if (u == 0) return;
    const T last = end_[i - 1] + t_.latency_ns[i - 1] + packet_ns(i, k);
    if (end_[i] < last) {
      end_[i] = last;
      end_from_[i] = From::unit_before;
    }
  }

  void block(std::size_t u, std::size_t k) {
    const std::size_t i = index(u, k);
    const T position = before_[k + 1] - t_.room_packets[i];
    if (!(position > T(0.0))) return;
    std::size_t& j = reached_[u];  // positions grow, but for rooms that differ from chunk to chunk
    while (j > 0 && !(T(before_[j]) < position)) --j;
    while (j < k && T(before_[j + 1]) < position) ++j;
    const std::size_t after = index(u + 1, j);
    if (j == k && end_from_[after] == From::unit_before) return;  // it waits for this one
    const T part = (position - before_[j]) / t_.packets[j];
    const T done = start_[after] + part * (end_[after] - start_[after]) + packet_ns(i, k);
    if (!(end_[i] < done)) return;
    end_[i] = done;
    unblocked_from_[i] = end_from_[i];
    end_from_[i] = From::unit_after;
    blocking_chunk_[i] = j;
  }

  /// A place on the longest path: the end or the start of a unit's work on a chunk.
  struct Place {
    std::size_t u, k;
    bool end;
  };

  /// The longest path ends here.
  Place last_place() const {
    Place at{t_.units - 1, t_.chunks - 1, true};
    for (std::size_t u = 0; u + 1 < t_.units; ++u)
      if (left(index(at.u, at.k)) < end_[index(u, at.k)]) at.u = u;
    for (std::size_t k = 0; k < t_.chunks; ++k)
      if (left(index(at.u, at.k)) < left(index(t_.units - 1, k))) at = {t_.units - 1, k, true};
    return at;
  }

  /// When what ends here has left the unit.
  T left(std::size_t i) const { return end_[i] + t_.latency_ns[i]; }

  /// What the makespan gains for each ns of a start and of an end.
  struct Weights {
    std::vector<double> start, end;
  };

  /// block() backwards: from an end that another unit caused to that unit's work.
  void unblock(std::size_t u, std::size_t k, Weights& of, FlowSlopes& found) const {
    const std::size_t i = index(u, k);
    if (end_from_[i] != From::unit_after || of.end[i] == 0.0) return;
    const double weight = of.end[i];
    of.end[i] = 0.0;
    const std::size_t j = blocking_chunk_[i], after = index(u + 1, j);
    const double part = (before_[k + 1] - t_.room_packets[i] - before_[j]) / t_.packets[j];
    of.start[after] += weight * (1.0 - part);
    of.end[after] += weight * part;
    found.room_packets[i] -= weight * (end_[after] - start_[after]) / t_.packets[j];
    found.ns[i] += weight / t_.packets[k];
  }

  /// advance() backwards.
  void retreat(std::size_t u, std::size_t k, Weights& of, FlowSlopes& found) const {
    const std::size_t i = index(u, k);
    const From end_from = end_from_[i] == From::unit_after ? unblocked_from_[i] : end_from_[i];
    if (const double weight = of.end[i]; weight != 0.0) {
      const bool waited = end_from == From::unit_before;
      found.ns[i] += waited ? weight / t_.packets[k] : weight;
      if (waited) found.latency_ns[i - 1] += weight;
      (waited ? of.end[i - 1] : of.start[i]) += weight;
    }
    const double weight = of.start[i];
    if (weight == 0.0 || start_from_[i] == From::nothing) return;
    if (start_from_[i] == From::same_unit) {
      of.end[index(u, k - 1)] += weight;
    } else {
      of.start[i - 1] += weight;
      found.ns[i - 1] += weight / t_.packets[k];
      found.latency_ns[i - 1] += weight;
    }
  }

  /// Each step goes to the term that was last; the difference of the two times belongs to the unit that the
  /// step leaves, and to the unit after it where that one blocked it.
  FlowResult<T> walk_back() const {
    FlowResult<T> result;
    result.critical_ns.assign(t_.units, T(0.0));
    if (t_.units == 0 || t_.chunks == 0) return result;
    Place at = last_place();
    const std::size_t last = index(at.u, at.k);
    const bool behind = at.u + 1 == t_.units;  // what leaves the last unit still takes its latency
    result.makespan_ns = behind ? left(last) : end_[last];
    result.critical_ns[at.u] += behind ? t_.latency_ns[last] : T(0.0);
    for (bool more = true; more;) more = step(at, result.critical_ns);
    share(result);
    return result;
  }

  bool step(Place& at, std::vector<T>& critical) const {
    const std::size_t i = index(at.u, at.k);
    const T time = at.end ? end_[i] : start_[i];
    const From from = at.end ? end_from_[i] : start_from_[i];
    std::size_t owner = at.u;
    if (from == From::nothing) {
      critical[owner] += time;
      return false;
    }
    if (at.end && from == From::same_unit) {
      at.end = false;
    } else if (from == From::same_unit) {
      --at.k;
      at.end = true;
    } else if (from == From::unit_before) {
      owner = at.end ? at.u : at.u - 1;
      --at.u;
    } else {
      owner = ++at.u;
      at.k = blocking_chunk_[i];
    }
    const std::size_t to = index(at.u, at.k);
    critical[owner] += time - (at.end ? end_[to] : start_[to]);
    return true;
  }

  /// A blocked unit ends before the one that blocks it, so parts can be slightly negative: they are taken
  /// from the others.
  static void share(FlowResult<T>& result) {
    T sum(0.0);
    for (T& part : result.critical_ns) {
      part = larger(part, T(0.0));
      sum += part;
    }
    if (!(sum > T(0.0))) return;
    for (T& part : result.critical_ns) part *= result.makespan_ns / sum;
  }

  const FlowTable<T>& t_;
  std::vector<T> start_, end_;
  std::vector<From> start_from_, end_from_;
  std::vector<From> unblocked_from_;  ///< what end_from_ was before another unit blocked it
  std::vector<std::size_t> blocking_chunk_;
  std::vector<double> before_;  ///< packets of earlier chunks
  std::vector<std::size_t> reached_;
};

}  // namespace hwsim
