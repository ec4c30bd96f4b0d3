#pragma once
// The units of a GPU as servers with queues between them, resident subgroups that wait for pipes and for
// memory, caches and DRAM: events in the order of their time.
#include <deque>
#include <queue>
#include <stdexcept>
#include <vector>

#include "hwsim/detailed/memory.h"
#include "hwsim/detailed/packets.h"

namespace hwsim {

/// Nothing moves any more: an error of the simulator, with the pass, the unit and the state of the queues.
class StallError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The units that a packet goes through before it is dispatched to the cores, in order.
inline constexpr std::array kFrontUnits = {Unit::fe,     Unit::ia,  Unit::vs,  Unit::setup,
                                           Unit::raster, Unit::hiz, Unit::zrop};

class Machine {
 public:
  Machine(const PassWork& pass, const PacketPlan& plan, const GpuConfig& gpu, const GpuRates<double>& rates,
          std::uint64_t events_without_progress_max, std::uint64_t seed);

  /// What was simulated so far: until when, and what was moved and done by then.
  struct Progress {
    double ns = 0.0;
    StreamBytesOf<double> bytes;
    std::array<double, kUnitCount> busy_ns{};
  };
  /// Simulates the next packets up to `last`; returns how it stands when the last of them is dispatched.
  Progress enter_until(std::uint64_t last);
  /// The next packet is `packet`: those between leave what the caches would remember of them, and no more.
  void skip_to(std::uint64_t packet);
  /// Everything that entered leaves.
  Progress drain();
  const MemorySystem& memory() const { return memory_; }

 private:
  enum class Step : unsigned char { work, fetch, more, leave, release };
  struct Event {
    double ns;
    std::uint64_t number;  ///< ties in the order in which they were made
    std::uint32_t subgroup;
    Step step;
    bool operator<(const Event& b) const { return ns != b.ns ? ns > b.ns : number > b.number; }
  };
  struct Subgroup {
    const ChunkPackets* chunk = nullptr;
    std::size_t core = 0;
    int phase = 0, phases = 0;
    double textures = 0.0, loads = 0.0;  ///< lines still to be asked for
    double asks_from_ns = 0.0, ready_ns = 0.0;
  };
  struct Core {
    Core(std::size_t l1_lines, int l1_ways, std::uint64_t seed)
        : l1(l1_lines, static_cast<std::size_t>(l1_ways)), reads(0, 2 * l1_lines, seed) {}
    double alu_ns = 0.0, sfu_ns = 0.0, memory_pipe_ns = 0.0, tex_ns = 0.0;  ///< when each pipe is free
    double resident = 0.0;
    LineCache l1;
    AddressSource reads;
    std::deque<double> misses;           ///< when the lines that are on their way arrive
    std::deque<std::uint32_t> fetching;  ///< subgroups with lines still to be asked for, in turn
    double l1_has() const { return static_cast<double>(std::min(l1.lines(), reads.lines())); }
    void pass_by(double lines) {
      for (double i = std::min(lines, static_cast<double>(l1.lines())); i >= 1.0; i -= 1.0)
        l1.access(reads.fresh(), false);
    }
  };
  struct Leaving {
    double accepted_ns, done_ns;
  };
  using Ring = std::vector<double>;

  void handle_next();
  Progress progress(double ns) const;
  std::array<double, kUnitCount> busy_ns() const;
  bool enter(std::uint64_t packet);
  double front(const ChunkPackets& chunk);
  void dispatch(const ChunkPackets& chunk, std::size_t core, double ns);
  std::size_t pick_core(const ChunkPackets& chunk) const;
  void handle(const Event& event);
  void work(std::uint32_t index, double now);
  void fetch(std::uint32_t index, double now);
  void ask(Core& core, double now);
  bool ask_lines(Core& core, Subgroup& s, double now);
  void leave(std::uint32_t index, double now);
  void release(std::uint32_t index);
  Leaving finish(const ChunkPackets& chunk, double now);
  double serve(double& free_ns, double now, double service_ns, Unit unit);
  double move(const ChunkPackets& chunk, std::initializer_list<Stream> streams, double packets, double now,
              std::deque<double>& outstanding);
  double move_lines(double bytes, Stream stream, bool write, bool bypass, double now,
                    std::deque<double>& outstanding);
  void push(double ns, std::uint32_t subgroup, Step step);
  double whole(double mean);  ///< a whole number, that on average
  [[noreturn]] void stall(std::uint64_t packet) const;

  const PassWork& pass_;
  const PacketPlan& plan_;
  const GpuRates<double>& rates_;
  std::uint64_t events_max_, events_since_progress_ = 0;
  std::size_t unit_lines_max_;
  std::size_t fifo_packets_;  ///< between two units
  std::size_t core_lines_max_;
  MemorySystem memory_;
  Random random_;
  std::array<Survival, kStreamCount> reads_, writes_;
  Survival l1_survival_;

  std::array<double, kFrontUnits.size()> front_free_{};
  std::array<Ring, kFrontUnits.size() + 1>
      front_done_{};  ///< when the last packets left each unit; the last ring: when they were dispatched
  Ring leave_done_{};
  std::uint64_t next_ = 0;  ///< packet
  std::uint64_t entered_ = 0, finished_ = 0;
  std::deque<double> ia_lines_, depth_lines_, color_lines_;
  double crop_free_ = 0.0, resolve_free_ = 0.0, atomic_free_ = 0.0;
  std::vector<Core> cores_;
  std::vector<Subgroup> subgroups_;
  std::vector<std::uint32_t> idle_;
  std::priority_queue<Event> events_;
  std::uint64_t event_number_ = 0;
  double now_ns_ = 0.0, dispatched_ns_ = 0.0, last_ns_ = 0.0;
  double alu_busy_ = 0.0, sfu_busy_ = 0.0, memory_pipe_busy_ = 0.0, tex_busy_ = 0.0, atomic_busy_ = 0.0;
  std::array<double, kUnitCount> busy_ns_{};
};

}  // namespace hwsim
