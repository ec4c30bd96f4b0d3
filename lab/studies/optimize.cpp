#include "lab/studies/optimize.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "hwsim/base/units_of_measure.h"
#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/timing/time_slopes.h"
#include "lab/base/messages.h"
#include "lab/results/results.h"

namespace hwsim::lab {
namespace {

using Values = std::vector<double>;

constexpr double kRelativeStop = 1e-5;  // the solver ends when logarithms of keys change by less
constexpr int kMostEvaluations = 100;
constexpr double kSlack =
    1e-6;  // part of a limit by which it may be missed: more than the solver leaves, less than matters

/// The frames' times as functions of the logarithms of the priced keys.
class FrameTimes {
 public:
  FrameTimes(const std::vector<KeptFrame>& frames, const GpuConfig& gpu, const PriceList& prices)
      : frames_(frames), gpu_(gpu), prices_(prices) {
    for (const PricedKey& price : prices.keys) {
      keys_.push_back(price.key);
      keys_.insert(keys_.end(), price.scales.begin(), price.scales.end());
    }
  }
  std::size_t frames() const { return frames_.size(); }
  std::size_t keys() const { return prices_.keys.size(); }
  std::size_t replays() const { return replays_; }

  /// ln(ms) of a frame; `slopes` receives its derivatives by ln(value), one a priced key.
  double log_ms(std::size_t frame, const Values& values, double* slopes) {
    const GpuConfig gpu = with_values(gpu_, prices_, values);
    const WorkTrace& trace = frames_[frame].emulation->trace;
    ++replays_;
    if (!slopes) return std::log(time_frame(trace, gpu, Engine::queue).time_ns / kNsPerMs);
    TimeSlopes by_key(gpu, keys_);
    const double time_ns = time_frame(trace, gpu, Engine::queue, {}, &by_key).time_ns;
    GpuConfig copy = gpu;
    const std::vector<Key> known = keys_of(static_cast<GpuValues<double>&>(copy));
    std::size_t next = 0;
    for (std::size_t i = 0; i < keys(); ++i) {
      slopes[i] = 0.0;
      for (std::size_t k = 0; k <= prices_.keys[i].scales.size(); ++k, ++next)
        slopes[i] += by_key.ns()[next] * *std::get<double*>(find_key(known, keys_[next])->slot) / time_ns;
    }
    return std::log(time_ns / kNsPerMs);
  }

  /// Milliseconds of the slowest frame. Values that were asked for before are remembered.
  double slowest_ms(const Values& values) {
    const auto known = slowest_.find(values);
    if (known != slowest_.end()) return known->second;
    double slowest = 0.0;
    for (std::size_t f = 0; f < frames(); ++f)
      slowest = std::max(slowest, std::exp(log_ms(f, values, nullptr)));
    return slowest_.emplace(values, slowest).first->second;
  }

 private:
  const std::vector<KeptFrame>& frames_;
  const GpuConfig& gpu_;
  const PriceList& prices_;
  std::vector<std::string> keys_;
  std::map<Values, double> slowest_;
  std::size_t replays_ = 0;
};

/// What is made small: the area under a limit of the time, or the time under a limit of the area.
struct Aim {
  std::optional<double> time_ms{}, area{};
};

/// The problem as NLopt sees it: x = logarithms of the keys, then that of the time of the slowest frame.
class Continuous {
 public:
  Continuous(FrameTimes& times, const PriceList& prices, const Aim& aim)
      : times_(times), prices_(prices), aim_(aim) {}

  /// The best values between the bounds, from a start. `fixed`: keys that go in steps keep the start's value.
  Values solve(const Values& start, bool fixed = false) {
    const std::size_t keys = prices_.keys.size();
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> solver(
        nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(keys + 1)), &nlopt_destroy);
    Values low, high, x;
    for (std::size_t i = 0; i < keys; ++i) {
      const bool stays = fixed && prices_.keys[i].step > 0.0;
      low.push_back(std::log(stays ? start[i] : prices_.keys[i].low));
      high.push_back(std::log(stays ? start[i] : prices_.keys[i].high));
      x.push_back(std::clamp(std::log(start[i]), low.back(), high.back()));
    }
    constexpr double kFarLog = 50.0;
    low.push_back(-kFarLog);
    high.push_back(aim_.time_ms ? std::log(*aim_.time_ms) : kFarLog);
    x.push_back(std::min(high.back(), std::log(times_.slowest_ms(start))));
    nlopt_set_lower_bounds(solver.get(), low.data());
    nlopt_set_upper_bounds(solver.get(), high.data());
    nlopt_set_min_objective(solver.get(), aim_.time_ms ? &area_of : &last_of, this);
    std::vector<FrameLimit> limits;
    for (std::size_t f = 0; f < times_.frames(); ++f) limits.push_back({this, f});
    for (FrameLimit& limit : limits) nlopt_add_inequality_constraint(solver.get(), &time_of, &limit, 1e-7);
    if (aim_.area) nlopt_add_inequality_constraint(solver.get(), &area_over, this, 1e-7);
    nlopt_set_xtol_rel(solver.get(), kRelativeStop);
    nlopt_set_maxeval(solver.get(), kMostEvaluations);
    double least = 0.0;
    nlopt_optimize(solver.get(), x.data(), &least);  // whatever it says, x is the best that it came to
    return values_at(x.data());
  }

 private:
  struct FrameLimit {
    Continuous* problem;
    std::size_t frame;
  };

  Values values_at(const double* x) const {
    Values values;
    for (std::size_t i = 0; i < prices_.keys.size(); ++i) values.push_back(std::exp(x[i]));
    return values;
  }
  /// ln(area) and its slopes.
  double log_area(const double* x, double* slopes, unsigned n) const {
    const Values values = values_at(x);
    const double area = prices_.area_of(values);
    if (slopes) std::fill(slopes, slopes + n, 0.0);
    for (std::size_t i = 0; slopes && i < values.size(); ++i)
      slopes[i] = prices_.keys[i].area * values[i] / area;
    return std::log(area);
  }

  static double area_of(unsigned n, const double* x, double* slopes, void* data) {
    return static_cast<Continuous*>(data)->log_area(x, slopes, n);
  }
  static double area_over(unsigned n, const double* x, double* slopes, void* data) {
    const auto* self = static_cast<Continuous*>(data);
    return self->log_area(x, slopes, n) - std::log(*self->aim_.area);
  }
  static double last_of(unsigned n, const double* x, double* slopes, void*) {
    if (slopes) std::fill(slopes, slopes + n, 0.0);
    if (slopes) slopes[n - 1] = 1.0;
    return x[n - 1];
  }
  static double time_of(unsigned n, const double* x, double* slopes, void* data) {
    const auto* limit = static_cast<FrameLimit*>(data);
    const Continuous& self = *limit->problem;
    if (slopes) slopes[n - 1] = -1.0;
    return self.times_.log_ms(limit->frame, self.values_at(x), slopes) - x[n - 1];
  }

  FrameTimes& times_;
  const PriceList& prices_;
  Aim aim_;
};

/// Keys that go in steps, from what the solver found to a step each, and on to better neighbors.
class Steps {
 public:
  Steps(FrameTimes& times, const PriceList& prices, const Aim& aim)
      : times_(times), prices_(prices), aim_(aim) {}

  /// Rounded to the side that keeps the limit, then by steps of one key, or of one up and another down, while
  /// they bring something.
  Values best(const Values& continuous) {
    return improved(rounded(continuous, aim_.time_ms ? Rounding::up : Rounding::down));
  }

  /// Whether `a` keeps the limit better, or is smaller or faster within it: by more than rounding, and no
  /// worse in what comes first. (Were it a little worse there, better ones could go round in circles.)
  bool is_better(const Values& a, const Values& b) {
    const auto x = rank(a), y = rank(b);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (x[i] > y[i]) return false;
      if (x[i] < y[i] - kSlack * std::max(1.0, std::abs(y[i]))) return true;
    }
    return false;
  }

 private:
  enum class Rounding { down, up };
  double on_step(std::size_t i, double value, Rounding rounding) const {
    const PricedKey& key = prices_.keys[i];
    if (key.step == 0.0) return std::clamp(value, key.low, key.high);
    constexpr double kOnStep = 1e-3;  // part of a step that the solver leaves
    const double most =
        std::floor((key.high - key.low) / key.step + kSlack);  // the last may be short of `high`
    const double at = (value - key.low) / key.step;
    const double step = rounding == Rounding::up ? std::ceil(at - kOnStep) : std::floor(at + kOnStep);
    return key.low + std::clamp(step, 0.0, most) * key.step;
  }
  Values rounded(const Values& values, Rounding rounding) const {
    Values result;
    for (std::size_t i = 0; i < values.size(); ++i) result.push_back(on_step(i, values[i], rounding));
    return result;
  }

  /// How far beyond its limit a GPU is, 0 within, then what is made small, then the other of both.
  std::array<double, 3> rank(const Values& values) {
    const double area = prices_.area_of(values), time_ms = times_.slowest_ms(values);
    const bool by_time = aim_.time_ms.has_value();
    const double limited = by_time ? time_ms : area, limit = by_time ? *aim_.time_ms : *aim_.area;
    const double over = limited <= limit * (1.0 + kSlack) ? 0.0 : limited / limit - 1.0;
    return {over, by_time ? area : time_ms, limited};
  }
  std::optional<Values> moved(const Values& values, std::size_t i, int steps) const {
    const PricedKey& key = prices_.keys[i];
    const double by = key.step > 0.0 ? key.step : 0.01 * values[i];
    Values next = values;
    next[i] = values[i] + steps * by;
    if (next[i] < key.low - kSlack || next[i] > key.high * (1.0 + kSlack)) return std::nullopt;
    return next;
  }

  /// The first neighbor that is better, again and again.
  Values improved(Values values) {
    while (const auto next = better_neighbor(values)) values = *next;
    return values;
  }
  std::optional<Values> better_neighbor(const Values& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      for (const int steps : {-1, 1}) {
        const auto next = moved(values, i, steps);
        if (!next) continue;
        if (is_better(*next, values)) return next;
        for (std::size_t k = 0; k < values.size(); ++k)
          if (const auto both = k == i ? std::nullopt : moved(*next, k, -steps);
              both && is_better(*both, values))
            return both;
      }
    return std::nullopt;
  }

  FrameTimes& times_;
  const PriceList& prices_;
  Aim aim_;
};

class Optimizer {
 public:
  Optimizer(const std::vector<KeptFrame>& frames, const ChangedGpu& gpu, const PriceList& prices)
      : frames_(frames),
        changed_(gpu),
        prices_(prices),
        plain_(gpu.files.with(gpu.sets)),
        times_(frames, plain_, prices) {}

  Optimization run(const OptimizeGoal& goal) {
    Optimization found{.gpu = plain_.id, .prices = prices_.path, .goal = goal, .keys = prices_.keys};
    found.unchanged = gpu_at(values_in(prices_, plain_), plain_);
    if (goal.time_ms || goal.area) {
      const Values values = solve({goal.time_ms, goal.area});
      found.settings = settings_for(plain_, prices_, values);
      found.best = gpu_at(values, checked(values));
      judge(found);
    }
    if (goal.front_points > 0) found.front = front(goal.front_points);
    found.replays = times_.replays();
    return found;
  }

 private:
  /// The GPU as its files and settings make it. Throws InputError where its rules do not hold.
  GpuConfig checked(const Values& values) const {
    std::vector<Assignment> sets = changed_.sets;
    for (Assignment& set : settings_for(plain_, prices_, values)) sets.push_back(std::move(set));
    return changed_.files.with(sets);
  }

  Values corner(double PricedKey::*bound) const {
    Values values;
    for (const PricedKey& key : prices_.keys) values.push_back(key.*bound);
    return values;
  }

  Values middle() const {
    Values values;
    for (const PricedKey& key : prices_.keys) values.push_back(std::sqrt(key.low * key.high));
    return values;
  }

  /// Keys that go in steps have come through a logarithm: back to their steps.
  Values between_bounds(Values values) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const PricedKey& key = prices_.keys[i];
      values[i] = std::clamp(values[i], key.low, key.high);
      if (key.step > 0.0) values[i] = key.low + std::round((values[i] - key.low) / key.step) * key.step;
    }
    return values;
  }

  /// From several starts: slopes lead to the nearest optimum.
  Values solve(const Aim& aim) {
    return solve(aim, {corner(&PricedKey::high), middle(), corner(&PricedKey::low)});
  }
  Values solve(const Aim& aim, const std::vector<Values>& starts) {
    Steps steps(times_, prices_, aim);
    std::optional<Values> best;
    for (const Values& start : starts) {
      Continuous continuous(times_, prices_, aim);
      const Values stepped = steps.best(continuous.solve(start));
      for (const Values& found : {stepped, between_bounds(continuous.solve(stepped, true))})
        if (!best || steps.is_better(found, *best)) best = found;
    }
    return *best;
  }

  OptimizedGpu gpu_at(const Values& values, const GpuConfig& gpu) {
    OptimizedGpu answer{.values = values, .area = prices_.area_of(values)};
    for (const KeptFrame& frame : frames_) {
      const Result result = time(frame, gpu);
      const PassResult* slowest = slowest_pass(result);
      answer.frames.push_back({.name = result.scene + " " + result.technique + " " +
                                       std::to_string(result.resolution.width_px) + "x" +
                                       std::to_string(result.resolution.height_px),
                               .time_ms = result.frame.time_ms,
                               .interval_ms = result.frame.interval_ms,
                               .support = result.frame.support,
                               .limiter = slowest ? slowest->limiter : ""});
      if (answer.frames.back().time_ms > answer.frames[answer.slowest].time_ms)
        answer.slowest = answer.frames.size() - 1;
    }
    return answer;
  }

  void judge(Optimization& found) const {
    const OptimizedGpu& best = *found.best;
    found.met = found.goal.time_ms ? best.time_ms() <= *found.goal.time_ms * (1.0 + kSlack)
                                   : best.area <= *found.goal.area * (1.0 + kSlack);
    if (!found.goal.time_ms) {
      found.verdict = found.met ? "ok" : "over area";
      return;
    }
    found.verdict = "ok";
    for (const OptimizedFrame& frame : best.frames) {
      if (frame.time_ms > *found.goal.time_ms * (1.0 + kSlack)) found.verdict = "over time";
      if (found.verdict == "over time") break;
      if (!frame.interval_ms) found.verdict = "unknown";
      if (frame.interval_ms && (*frame.interval_ms)[1] > *found.goal.time_ms) found.verdict = "at risk";
    }
  }

  /// The fastest GPU of each area, those left out that another one beats.
  std::vector<OptimizedGpu> front(int points) {
    const double least = prices_.area_of(corner(&PricedKey::low));
    const double most = prices_.area_of(corner(&PricedKey::high));
    std::vector<Values> found;
    for (int i = 0; i < points; ++i) {
      const double share = points == 1 ? 0.0 : static_cast<double>(i) / (points - 1);
      const Values start = found.empty() ? corner(&PricedKey::low) : found.back();  // the next smaller one
      found.push_back(solve({.time_ms = std::nullopt, .area = least * std::pow(most / least, share)},
                            {start, middle(), corner(&PricedKey::high)}));
    }
    std::ranges::sort(found, {},
                      [&](const Values& v) { return std::pair(prices_.area_of(v), times_.slowest_ms(v)); });
    std::vector<OptimizedGpu> front;
    for (const Values& values : found) {
      if (!front.empty() && times_.slowest_ms(values) >= front.back().time_ms() * (1.0 - kSlack)) continue;
      front.push_back(gpu_at(values, checked(values)));
    }
    return front;
  }

  const std::vector<KeptFrame>& frames_;
  const ChangedGpu& changed_;
  const PriceList& prices_;
  GpuConfig plain_;
  FrameTimes times_;
};

}  // namespace

Optimization optimize(const std::vector<KeptFrame>& frames, const ChangedGpu& gpu, const PriceList& prices,
                      const OptimizeGoal& goal) {
  if (frames.empty())
    fail_usage("U041", "there is no frame to make a GPU for", "", "a scene and a technique");
  for (const KeptFrame& frame : frames)
    if (frame.plan.engine != Engine::queue)
      fail_usage("U041", "a GPU is optimized by the slopes of the engine `queue`", "", "no --engine");
  return Optimizer(frames, gpu, prices).run(goal);
}

}  // namespace hwsim::lab
