#pragma once
// DRAM as channels of banks with open rows: what the queue engine's one efficiency stands for.
#include <cstdint>
#include <vector>

#include "hwsim/detailed/calendar.h"
#include "hwsim/gpu/gpu_config.h"

namespace hwsim {

class Dram {
 public:
  explicit Dram(const GpuConfig& gpu);
  /// When the line's data are there, or the write is taken over: later than now where more writes wait than
  /// the channel has room for.
  double access(std::uint64_t line, bool write, double now_ns);
  /// Busy time of the channels so far, as if spread evenly; waiting writes included.
  double busy_ns() const;
  double free_ns() const;  ///< when the last channel has done all that it was given
  double line_ns() const { return line_ns_; }
  double channel_count() const { return static_cast<double>(channels_.size()); }
  /// Lines whose rows the banks' queues hold: within so many the order of requests opens no further rows.
  double reordered_lines() const;
  std::uint64_t row_misses() const { return row_misses_; }

 private:
  struct Bank {
    /// Rows that requests in the controller's queue are for: it serves all of one row together (first ready,
    /// first come, first served), so returning to one of these opens none.
    std::vector<std::uint64_t> rows;
    std::size_t oldest = 0;
    explicit Bank(int queue_rows) : rows(static_cast<std::size_t>(queue_rows), ~std::uint64_t{0}) {}
    double ready_ns = 0.0;        ///< when the open row is ready
    Calendar activations{512.0};  ///< one takes a row cycle
  };
  struct Channel {
    Calendar bus{128.0};
    double busy_ns = 0.0;
    bool writing = false;
    std::vector<std::uint64_t> writes;  ///< waiting: they go in groups, a change of direction costs time
    std::vector<Bank> banks;
  };
  double transfer(Channel& channel, std::uint64_t line, double now_ns);
  void turn(Channel& channel, bool writing, double now_ns);

  double line_ns_, row_miss_ns_, row_cycle_ns_, turn_ns_, latency_ns_, write_room_ns_;
  std::uint64_t lines_a_row_, interleave_lines_;
  std::size_t write_lines_;
  std::uint64_t row_misses_ = 0;
  std::vector<Channel> channels_;
};

}  // namespace hwsim
