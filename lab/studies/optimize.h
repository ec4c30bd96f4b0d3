#pragma once
// The cheapest GPU that draws some frames in a time, or the fastest that an area allows. NLopt goes down the
// exact slopes of the queue engine to the best numbers; numbers of units, and others that go in steps, end on
// steps.
#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/base/table.h"
#include "lab/studies/kept_frame.h"
#include "lab/studies/prices.h"

namespace hwsim::lab {

/// One of both limits; without one, only the front is asked for.
struct OptimizeGoal {
  std::optional<double> time_ms{};  ///< the least area whose slowest frame takes no longer
  std::optional<double> area{};     ///< the least time of the slowest frame with no more area
  int front_points = 9;             ///< areas between the smallest and the largest GPU; 0: no front
};

/// A frame on a GPU that was chosen.
struct OptimizedFrame {
  std::string name{};  ///< "sponza_hall msaa4x 1280x720"
  double time_ms = 0.0;
  std::optional<std::array<double, 2>> interval_ms{};  ///< 90 %
  std::string support{}, limiter{};
};

struct OptimizedGpu {
  std::vector<double> values{};  ///< one a priced key
  double area = 0.0;
  std::size_t slowest = 0;  ///< index into frames
  std::vector<OptimizedFrame> frames{};
  double time_ms() const { return frames.at(slowest).time_ms; }
};

struct Optimization {
  std::string gpu{}, prices{};
  OptimizeGoal goal{};
  std::vector<PricedKey> keys{};
  OptimizedGpu unchanged{};
  std::optional<OptimizedGpu> best{};  ///< none where only the front was asked for
  bool met = true;                     ///< whether the best one keeps the limit; else it comes nearest
  std::string verdict{};               ///< "ok", "at risk", "unknown", as a budget's
  std::vector<OptimizedGpu> front{};   ///< nobody is smaller and faster; by area
  std::vector<Assignment> settings{};  ///< that make the best GPU
  std::size_t replays = 0;             ///< frames that were timed
};

/// The GPU that is changed: its files, and settings that stay.
struct ChangedGpu {
  GpuFiles files;
  std::vector<Assignment> sets{};
};

/// All frames must be work of the GPU's features. Its files make every GPU that is answered, so that their
/// rules hold. Throws InputError U041 without frames, or for an engine without slopes.
Optimization optimize(const std::vector<KeptFrame>& frames, const ChangedGpu& gpu, const PriceList& prices,
                      const OptimizeGoal& goal);

/// What was found, in a sentence: the GPU, or how near it comes.
std::string answer_of(const Optimization& found);

/// The unchanged and the best GPU, key by key; the front, a row a GPU; the frames on the best GPU.
Table optimized_keys(const Optimization& found);
Table optimized_front(const Optimization& found);
Table optimized_frames(const Optimization& found);
nlohmann::ordered_json to_json(const Optimization& found);

}  // namespace hwsim::lab
