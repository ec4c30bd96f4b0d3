// The GPU that is found: against a closed form where only the DRAM limits, and against every point of a grid.
#include "lab/studies/optimize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "lab/lab.h"
#include "lab/workbench.h"

namespace hwsim::lab {
namespace {

class OptimizeTest : public ::testing::Test {
 protected:
  std::string prices(const std::string& text) {
    const std::string path = bench_.path("prices.toml");
    std::ofstream(path) << "schema = 1\nkind = \"prices\"\n" << text;
    return path;
  }
  Request request(std::vector<std::string> techniques = {"none"}) const {
    Request request = bench_.request(std::move(techniques));
    request.view.resolution = {1024, 768};
    return request;
  }
  double slowest_ms(const std::vector<KeptFrame>& frames, const GpuConfig& gpu) {
    double slowest = 0.0;
    for (const KeptFrame& frame : frames) slowest = std::max(slowest, time(frame, gpu).frame.time_ms);
    return slowest;
  }
  GpuConfig gpu_with(std::vector<Assignment> sets) {
    return lab_.gpu({.name = "gtx980", .sets = std::move(sets)});
  }
  std::vector<KeptFrame> frames_of(const Request& request) {
    std::vector<KeptFrame> frames;
    for (const std::string& technique : request.techniques) {
      Request one = request;
      one.techniques = {technique};
      std::vector<Diagnostic> problems;
      frames.push_back(lab_.emulate(lab_.plan(one, problems)));
    }
    return frames;
  }
  static std::string code_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const InputError& error) {
      return error.diagnostics().front().code;
    }
    return "";
  }

  test::Workbench bench_;
  Lab lab_;
};

const std::vector<Assignment> kOnlyDramLimits = {{"gpu.core_clock_mhz", "90000"},
                                                 {"gpu.dram_latency_cycles", "0"}};

// With a clock beyond all bounds, time = a / bandwidth + b: what is left of a limit says the bandwidth.
TEST_F(OptimizeTest, BandwidthBoundFrameNeedsTheBandwidthOfTheClosedForm) {
  Request only_dram = request();
  only_dram.sets = kOnlyDramLimits;
  const std::vector<KeptFrame> frames = frames_of(only_dram);
  const auto time_at = [&](double gb_s) {
    std::vector<Assignment> sets = kOnlyDramLimits;
    sets.push_back({"gpu.dram_bandwidth_gb_s", exact(gb_s)});
    return slowest_ms(frames, gpu_with(sets));
  };
  const double slow = time_at(100.0), fast = time_at(400.0);
  const double a = (slow - fast) / (1.0 / 100.0 - 1.0 / 400.0), b = slow - a / 100.0;
  ASSERT_NEAR(time_at(200.0), a / 200.0 + b, 1e-6 * slow) << "the frame is not bound by the bandwidth alone";
  const double limit_ms = a / 150.0 + b;  // exactly met by 150 GB/s
  const std::string priced =
      "[dram_bandwidth_gb_s]\narea = 2\nlow = 50\nhigh = 500\n[crop_units]\narea = 1\nlow = 16\nhigh = 64\n";
  const Optimization found = lab_.optimize(only_dram, {}, prices("base_area = 10\n" + priced),
                                           {.time_ms = limit_ms, .front_points = 0});
  ASSERT_TRUE(found.best && found.met);
  EXPECT_NEAR(found.best->values[0], 150.0, 0.1);
  EXPECT_LE(found.best->time_ms(), limit_ms * (1.0 + 1e-6));
  EXPECT_EQ(found.best->values[1], 16.0) << "ROPs bring nothing here";
  EXPECT_NEAR(found.best->area, 10.0 + 2.0 * found.best->values[0] + 16.0, 1e-9);

  const Optimization fastest =
      lab_.optimize(only_dram, {}, prices("base_area = 10\n" + priced), {.area = 326.0, .front_points = 0});
  EXPECT_NEAR(fastest.best->values[0], 150.0, 0.1) << "what the area leaves after 16 ROPs";
  EXPECT_NEAR(fastest.best->time_ms(), limit_ms, 1e-3 * limit_ms);

  const Optimization steps = lab_.optimize(
      only_dram, {}, prices("[dram_bandwidth_gb_s]\narea = 2\nlow = 50\nhigh = 500\nstep = 32\n"),
      {.time_ms = limit_ms, .front_points = 0});
  EXPECT_EQ(steps.best->values[0], 178.0) << "146 GB/s do not suffice";
  EXPECT_FALSE(to_json(steps)["best"]["bounds"].contains("dram_bandwidth_gb_s"))
      << "210 GB/s would be one more";
}

// Every GPU of the grid, timed: none that keeps the limit is smaller than the answer.
TEST_F(OptimizeTest, NoPointOfTheGridIsBetter) {
  const Request asked = request({"none", "msaa4x"});
  const std::vector<KeptFrame> frames = frames_of(asked);
  const std::string file = prices(
      "base_area = 5\n"
      "[shader_cores]\narea = 4\nlow = 2\nhigh = 16\nstep = 2\nscales = \"tex_bilinear_per_clk\"\n"
      "[dram_bandwidth_gb_s]\narea = 0.25\nlow = 64\nhigh = 256\nstep = 32\n"
      "[raster_engines]\narea = 6\nlow = 1\nhigh = 4\n");
  const PriceList list = read_prices(file, gpu_with({}));
  std::vector<std::pair<double, double>> grid;  // area, ms
  for (double cores = 2; cores <= 16; cores += 2)
    for (double gb_s = 64; gb_s <= 256; gb_s += 32)
      for (double rasterizers = 1; rasterizers <= 4; ++rasterizers) {
        const std::vector<double> values = {cores, gb_s, rasterizers};
        grid.emplace_back(list.area_of(values),
                          slowest_ms(frames, gpu_with(settings_for(gpu_with({}), list, values))));
      }
  const auto [fast, slow] = std::ranges::minmax(grid, {}, [](const auto& point) { return point.second; });
  for (const double share : {0.1, 0.3, 0.5, 0.8}) {
    const double limit_ms = fast.second * std::pow(slow.second / fast.second, share);
    double least = HUGE_VAL;
    for (const auto& [area, ms] : grid)
      if (ms <= limit_ms) least = std::min(least, area);
    const Optimization found = lab_.optimize(asked, {}, file, {.time_ms = limit_ms, .front_points = 0});
    ASSERT_TRUE(found.met) << share;
    EXPECT_NEAR(found.best->area, least, 1e-6) << "limit " << limit_ms << " ms";
    for (const std::size_t whole : {0u, 2u})
      EXPECT_EQ(found.best->values[whole], std::round(found.best->values[whole]));
    double least_ms = HUGE_VAL;
    for (const auto& [area, ms] : grid)
      if (area <= least + 1e-9) least_ms = std::min(least_ms, ms);
    const Optimization fastest = lab_.optimize(asked, {}, file, {.area = least, .front_points = 0});
    EXPECT_NEAR(fastest.best->time_ms(), least_ms, 1e-9 * least_ms) << "area " << least;
  }
}

TEST_F(OptimizeTest, FrontHoldsNoGpuThatAnotherOneBeats) {
  const std::string file = prices(
      "[shader_cores]\narea = 4\nlow = 2\nhigh = 16\n[dram_bandwidth_gb_s]\narea = 0.25\nlow = 64\nhigh = "
      "256\nstep = 16\n");
  const Optimization found = lab_.optimize(request(), {}, file, {.front_points = 6});
  EXPECT_FALSE(found.best);
  ASSERT_GE(found.front.size(), 3u);
  for (std::size_t i = 1; i < found.front.size(); ++i) {
    EXPECT_GT(found.front[i].area, found.front[i - 1].area);
    EXPECT_LT(found.front[i].time_ms(), found.front[i - 1].time_ms());
  }
  for (const OptimizedGpu& gpu : found.front) {
    ASSERT_EQ(gpu.frames.size(), 1u);
    EXPECT_TRUE(gpu.frames[0].interval_ms) << "gtx980 is calibrated";
  }
}

TEST_F(OptimizeTest, LimitThatNobodyKeepsIsMissedByTheNearest) {
  const std::string file = prices("[dram_bandwidth_gb_s]\narea = 1\nlow = 50\nhigh = 100\nstep = 10\n");
  const Optimization slow = lab_.optimize(request(), {}, file, {.time_ms = 1e-4, .front_points = 0});
  EXPECT_FALSE(slow.met);
  EXPECT_EQ(slow.best->values[0], 100.0);
  EXPECT_EQ(to_json(slow)["best"]["bounds"], (nlohmann::ordered_json{{"dram_bandwidth_gb_s", "upper"}}));
  EXPECT_EQ(slow.verdict, "over time");
  EXPECT_NE(answer_of(slow).find("No GPU within the bounds"), std::string::npos) << answer_of(slow);
  const Optimization large = lab_.optimize(request(), {}, file, {.area = 49.0, .front_points = 0});
  EXPECT_FALSE(large.met);
  EXPECT_EQ(large.best->values[0], 50.0);
  EXPECT_NE(to_csv(optimized_keys(large)).find("on its lower bound"), std::string::npos);
  EXPECT_NE(answer_of(large).find("2.0 % more"), std::string::npos) << answer_of(large);
}

TEST_F(OptimizeTest, MistakesInPricesAreToldTogether) {
  const auto refused = [&](const std::string& text, const std::string& code) {
    const std::string file = prices(text);
    EXPECT_EQ(code_of([&] { lab_.optimize(request(), {}, file, {}); }), code) << text;
  };
  refused("", "C026");
  refused("[shader_coers]\narea = 1\nlow = 1\nhigh = 2\n", "C026");
  refused("[shader_cores]\narea = 1\nlow = 3\nhigh = 2\n", "C026");
  refused("[shader_cores]\narea = 1\nlow = 1.5\nhigh = 9\n", "C026");
  refused("[shader_cores]\narea = 0\nlow = 1\nhigh = 9\n", "C026");
  refused("[shader_cores]\narea = 1\nlow = 1\nhigh = 9\nscales = \"vendor\"\n", "C026");
  refused("[shader_cores]\narea = \"much\"\nlow = 1\nhigh = 9\n", "C013");
  refused("[shader_cores]\narea = -1\nlow = 1\nhigh = 9\n", "C014");
  refused("[shader_cores]\nprice = 1\nlow = 1\nhigh = 9\n", "C012");
  refused("schema = 2\n", "C011");  // twice
  EXPECT_EQ(code_of([&] { lab_.optimize(request(), {}, "none.toml", {}); }), "C010");
  EXPECT_EQ(code_of([&] { lab_.optimize(request(), {}, "none", {}); }), "C010");
  const PointSettings hardware(parse_axes({"gpu.core_clock_mhz=1000,2000"}), Combine::grid);
  EXPECT_EQ(code_of([&] { lab_.optimize(request(), hardware, "example", {}); }), "U019");
}

}  // namespace
}  // namespace hwsim::lab
