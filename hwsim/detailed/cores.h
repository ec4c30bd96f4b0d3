#pragma once
// The shader cores: resident subgroups that take turns between pipes and requests to memory.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "hwsim/detailed/surroundings.h"

namespace hwsim {

class Cores {
 public:
  explicit Cores(Surroundings& around);

  /// The core with the fewest residents among those that have room for one more subgroup of the chunk.
  std::optional<std::size_t> pick(const ChunkPackets& chunk) const;
  void dispatch(const ChunkPackets& chunk, std::size_t core, double ns);
  /// A step of a subgroup's life: work, fetch or more.
  void handle(const Event& event);
  const ChunkPackets& chunk_of(std::uint32_t subgroup) const { return *subgroups_[subgroup].chunk; }
  void release(std::uint32_t subgroup);

  /// The part of the texture lines looked up that a core's L1 does not have.
  double l1_missing() const;
  /// Texture lines that each core looks up while nothing is simulated.
  void pass_by(double lookups);

  std::size_t count() const { return cores_.size(); }
  std::vector<int> residents() const;
  double shader_busy_ns() const;
  double tex_busy_ns() const { return tex_busy_ns_ / static_cast<double>(cores_.size()); }

 private:
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
  };
  void work(std::uint32_t index, double now);
  void fetch(std::uint32_t index, double now);
  void ask(Core& core, double now);
  bool ask_lines(Core& core, Subgroup& s, double now);

  Surroundings& around_;
  Survival l1_survival_;
  std::size_t lines_max_;  ///< on their way to a core
  std::vector<Core> cores_;
  std::vector<Subgroup> subgroups_;
  std::vector<std::uint32_t> idle_;
  double atomic_free_ns_ = 0.0;
  double alu_busy_ns_ = 0.0, sfu_busy_ns_ = 0.0, memory_pipe_busy_ns_ = 0.0, tex_busy_ns_ = 0.0,
         atomic_busy_ns_ = 0.0;
};

}  // namespace hwsim
