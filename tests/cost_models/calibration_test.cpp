// What a fit leaves behind, and errors on data that it did not see, on an experiment whose truth is known.
#include "cost_models/calibration.h"
#include "cost_models/intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "cost_models/synthetic.h"
#include "hwsim/gpu/gpu_show.h"
#include "hwsim/timing/time_slopes.h"

namespace hwsim::cost_models::test {
namespace {

Validation validate_quietly(const Experiment& experiment) {
  return validate(experiment, FitOptions{}, [](std::size_t, std::size_t, const std::string&) {});
}

const SplitResult& split_of(const Validation& validation, Split split) {
  return validation.splits.at(static_cast<std::size_t>(split));
}

class CalibrationTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    synthetic_ = std::make_unique<Synthetic>(make_synthetic(3, 4));
    add_noise(synthetic_->experiment, 5.0);
    validation_ = std::make_unique<Validation>(validate_quietly(synthetic_->experiment));
  }
  static void TearDownTestSuite() {
    validation_.reset();
    synthetic_.reset();
  }
  static const Experiment& experiment() { return synthetic_->experiment; }
  static std::unique_ptr<Synthetic> synthetic_;
  static std::unique_ptr<Validation> validation_;
};
std::unique_ptr<Synthetic> CalibrationTest::synthetic_;
std::unique_ptr<Validation> CalibrationTest::validation_;

TEST_F(CalibrationTest, NoiseOfFivePercentLeavesErrorsBelowIt) {
  EXPECT_LT(split_of(*validation_, Split::in_sample).figures.mape_pct, 5.0);
  EXPECT_EQ(split_of(*validation_, Split::in_sample).figures.cells, experiment().cells.size());
  EXPECT_GT(split_of(*validation_, Split::in_sample).figures.kendall, 0.8);
}

TEST_F(CalibrationTest, EveryCellIsHeldOutOnce) {
  for (const Split split : {Split::leave_scene_out, Split::leave_technique_out, Split::leave_gpu_out}) {
    std::vector<std::size_t> seen;
    for (const HeldOut& held : split_of(*validation_, split).cells) seen.push_back(held.cell);
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end()) << split_name(split);
    EXPECT_EQ(seen.size(), experiment().cells.size()) << split_name(split);
  }
  EXPECT_TRUE(split_of(*validation_, Split::rate_extrapolation).cells.empty()) << "all rows have one rate";
}

TEST_F(CalibrationTest, HoldingOutNeverHelps) {
  const double in_sample = split_of(*validation_, Split::in_sample).figures.mape_pct;
  for (const Split split : {Split::leave_scene_out, Split::leave_technique_out, Split::leave_gpu_out})
    EXPECT_GE(split_of(*validation_, split).figures.mape_pct, in_sample) << split_name(split);
}

TEST_F(CalibrationTest, IntervalsCoverAboutNinetyPercentOfHeldOutCells) {
  const Figures& figures = split_of(*validation_, Split::leave_technique_out).figures;
  EXPECT_GE(figures.coverage90_pct, 80.0);
}

TEST_F(CalibrationTest, SimulationBeatsTheSimpleRules) {
  const SplitResult& split = split_of(*validation_, Split::leave_technique_out);
  ASSERT_EQ(split.baselines.size(), 3u);
  for (const auto& [name, figures] : split.baselines) {
    EXPECT_EQ(figures.cells, split.figures.cells) << name;
    EXPECT_LT(split.figures.mape_pct, figures.mape_pct) << name;
  }
}

TEST_F(CalibrationTest, IntervalsOfRatiosHoldAboutNinetyPercentOfThePairs) {
  const SplitResult& split = split_of(*validation_, Split::leave_scene_out);
  ASSERT_EQ(split.ratios.size(), experiment().cells.size() / 4 * 6) << "six pairs of four techniques";
  EXPECT_GE(split.ratio_figures.coverage90_pct, 80.0);
  EXPECT_LE(split.ratio_figures.coverage90_pct, 97.0);
  for (const HeldOutRatio& ratio : split.ratios) {
    const Cell &first = experiment().cells[ratio.first], &second = experiment().cells[ratio.second];
    EXPECT_EQ(rank_group(first), rank_group(second));
    EXPECT_NE(first.run.technique, second.run.technique);
    EXPECT_DOUBLE_EQ(ratio.published, second.published / first.published);
    EXPECT_LT(ratio.low, ratio.predicted);
    EXPECT_GT(ratio.high, ratio.predicted);
  }
}

TEST_F(CalibrationTest, JsonHoldsTheCalibrationToTheBit) {
  const Calibration c = make_calibration(experiment(), *validation_);
  const Calibration back = calibration_from_json(to_json(c), "calibration.json");
  EXPECT_EQ(back.covariance, c.covariance);
  EXPECT_EQ(back.quantile90, c.quantile90);
  EXPECT_EQ(back.ratio_quantile90, c.ratio_quantile90);
  EXPECT_EQ(back.ratio_log_sd, c.ratio_log_sd);
  EXPECT_EQ(back.held_out_ms, c.held_out_ms);
  ASSERT_EQ(back.parameters.size(), c.parameters.size());
  for (std::size_t i = 0; i < c.parameters.size(); ++i)
    EXPECT_EQ(back.parameters[i].value, c.parameters[i].value);
  const std::optional<Fit> fit = fit_of(back, experiment().parameters);
  ASSERT_TRUE(fit);
  for (std::size_t i = 0; i < fit->log_values.size(); ++i)
    EXPECT_NEAR(fit->log_values[i], validation_->fit.log_values[i], 1e-12);
  EXPECT_FALSE(fit_of(back, {}));
}

TEST_F(CalibrationTest, DamagedJsonIsRefused) {
  const std::string text = to_json(make_calibration(experiment(), *validation_));
  EXPECT_THROW(calibration_from_json("", "c.json"), InputError);
  EXPECT_THROW(calibration_from_json(text.substr(0, text.size() / 2), "c.json"), InputError);
  EXPECT_THROW(calibration_from_json("{\"schema_version\": 1}", "c.json"), InputError);
}

TEST_F(CalibrationTest, GpuFilesHoldWhatWasFittedAndExtendTheDocumentedGpu) {
  const Calibration c = make_calibration(experiment(), *validation_);
  const GpuConfig& documented = experiment().gpus.front();
  const GpuConfig fitted = calibrated_gpu(documented, c);
  const std::filesystem::path base = testing::TempDir() + "/documented", own = testing::TempDir() + "/fitted";
  std::filesystem::create_directories(base);
  std::filesystem::create_directories(own);
  std::ofstream(base / "a.toml") << show(documented, false);
  std::ofstream(own / "a.toml") << calibrated_file(documented, c);
  const GpuConfig loaded = load_gpu((own / "a.toml").string(), {}, {}, base.string());
  EXPECT_EQ(content_hash(loaded), content_hash(fitted));
  std::set<std::string> in_file;
  for (const auto& [key, origin] : loaded.origins)
    if (origin.layer == Origin::Layer::file) in_file.insert(key);
  EXPECT_EQ(in_file, (std::set<std::string>{"alu_efficiency_ratio", "dram_efficiency_ratio",
                                            "pass_overhead_us", "setup_drawn_triangles_per_clk"}));
  const Origin& origin = loaded.origins.at("dram_efficiency_ratio");
  EXPECT_EQ(origin.provenance, Provenance::fitted);
  ASSERT_TRUE(origin.interval);
  EXPECT_LE((*origin.interval)[0], loaded.dram_efficiency_ratio);
  EXPECT_GE((*origin.interval)[1], loaded.dram_efficiency_ratio);
  EXPECT_NE(loaded.dram_efficiency_ratio, documented.dram_efficiency_ratio);
}

FrameInterval interval_of(const Calibration& c, const WorkTrace& trace, const GpuConfig& gpu,
                          const std::string& technique) {
  TimeSlopes slopes(gpu, interval_keys(c, gpu.id));
  const double time_ns = time_frame(trace, gpu, Engine::queue, {}, &slopes).time_ns;
  return frame_interval(c, {time_ns, slopes.ns()}, gpu, technique);
}

// A key that hwsim gained since the fit, at the value that the GPU's file or the default gives, is no reason
// to write the calibration anew; a user who sets it has another GPU.
TEST_F(CalibrationTest, KeysThatCameAfterTheFitLeaveSupportAsItWas) {
  Calibration c = make_calibration(experiment(), *validation_);
  const GpuConfig gpu = calibrated_gpu(experiment().gpus.front(), c);
  c.gpu_keys.erase("draw_cycles");
  for (auto& [id, hash] : c.gpu_hashes) hash = content_hash(gpu, c.gpu_keys);
  const auto trace = random_trace(4711);
  const auto support = [&](Origin::Layer layer, double draw_cycles) {
    GpuConfig used = gpu;
    used.draw_cycles = draw_cycles;
    used.origins["draw_cycles"].layer = layer;
    return interval_of(c, *trace, used, "t1").support;
  };
  EXPECT_EQ(support(Origin::Layer::built_in, gpu.draw_cycles), Support::calibrated);
  EXPECT_EQ(support(Origin::Layer::parent, 3.0), Support::calibrated);
  EXPECT_EQ(support(Origin::Layer::overlay, 3.0), Support::extrapolated);
  EXPECT_EQ(support(Origin::Layer::command_line, 3.0), Support::extrapolated);
}

TEST_F(CalibrationTest, FramesCarryIntervalsThatWidenWithDistance) {
  const Calibration c = make_calibration(experiment(), *validation_);
  const GpuConfig gpu = calibrated_gpu(experiment().gpus.front(), c);
  const auto trace = random_trace(4711);
  const auto width = [](const FrameInterval& i) { return (*i.interval_ns)[1] / (*i.interval_ns)[0]; };
  const FrameInterval known = interval_of(c, *trace, gpu, "t1");
  const FrameInterval unknown = interval_of(c, *trace, gpu, "other");
  GpuConfig changed = gpu;
  changed.dram_bandwidth_gb_s *= 2.0;
  const FrameInterval what_if = interval_of(c, *trace, changed, "t1");
  EXPECT_EQ(known.support, Support::calibrated);
  EXPECT_EQ(interval_of(c, *trace, gpu, "t1:x=2").support, Support::interpolated) << "other parameters";
  EXPECT_EQ(unknown.support, Support::extrapolated);
  EXPECT_EQ(what_if.support, Support::extrapolated);
  ASSERT_TRUE(known.interval_ns && unknown.interval_ns && what_if.interval_ns);
  EXPECT_LE(width(known), width(unknown));
  const double time_ns = time_frame(*trace, gpu, Engine::queue).time_ns;
  EXPECT_LT((*known.interval_ns)[0], time_ns);
  EXPECT_GT((*known.interval_ns)[1], time_ns);
  GpuConfig other = gpu;
  other.id = "never seen";
  EXPECT_EQ(interval_of(c, *trace, other, "t1").support, Support::uncalibrated);
}

// "extends" keeps the calibration of what it does not change: the interval is that of changed numbers.
TEST_F(CalibrationTest, AGpuThatExtendsAFittedOneHasItsIntervalsFromIt) {
  const Calibration c = make_calibration(experiment(), *validation_);
  GpuConfig relative = calibrated_gpu(experiment().gpus.front(), c);
  const std::string fitted = relative.id;
  relative.id = "relative";
  relative.shader_cores *= 2.0;
  EXPECT_EQ(calibrated_id(c, relative), "");
  relative.parents = {"somebody", fitted};
  EXPECT_EQ(calibrated_id(c, relative), fitted);
  const auto trace = random_trace(4711);
  TimeSlopes slopes(relative, interval_keys(c, fitted));
  const double time_ns = time_frame(*trace, relative, Engine::queue, {}, &slopes).time_ns;
  const FrameInterval found = frame_interval(c, {time_ns, slopes.ns()}, relative, "t1");
  EXPECT_EQ(found.support, Support::extrapolated);
  ASSERT_TRUE(found.interval_ns);
  EXPECT_LT((*found.interval_ns)[0], time_ns);
}

/// The calibration whose splits all have the quantile 1; the width of an interval is the logarithm over the
/// narrowest one.
class QuantileTest : public CalibrationTest {
 protected:
  void SetUp() override {
    c_ = make_calibration(experiment(), *validation_);
    for (auto& [split, quantile] : c_.quantile90) quantile = 1.0;
    gpu_ = calibrated_gpu(experiment().gpus.front(), c_);
    c_.techniques = {{gpu_.id, {"here"}}, {experiment().gpus.back().id, {"elsewhere"}}};
  }
  double width(const std::string& technique) {
    const FrameInterval i = interval_of(c_, *trace_, gpu_, technique);
    return std::log((*i.interval_ns)[1] / (*i.interval_ns)[0]);
  }
  /// How much wider the interval becomes when one split alone has three times the quantile.
  double widened(const std::string& technique, Split split) {
    const double before = width(technique);
    c_.quantile90[std::string(split_name(split))] = 3.0;
    const double after = width(technique);
    c_.quantile90[std::string(split_name(split))] = 1.0;
    return after / before;
  }
  Calibration c_;
  GpuConfig gpu_;
  std::shared_ptr<const WorkTrace> trace_ = random_trace(4711);
};

TEST_F(QuantileTest, CalibratedIntervalsAreThoseOfScenesThatTheFitDidNotSee) {
  for (const Split split : {Split::in_sample, Split::leave_scene_out})
    EXPECT_NEAR(widened("here", split), 3.0, 1e-9) << split_name(split);
  for (const Split split : {Split::leave_technique_out, Split::rate_extrapolation, Split::leave_gpu_out})
    EXPECT_NEAR(widened("here", split), 1.0, 1e-9) << split_name(split);
}

TEST_F(QuantileTest, InterpolatedIntervalsAreAsWideAsThoseOfGpusThatTheFitDidNotSee) {
  for (const Split split : {Split::in_sample, Split::leave_scene_out, Split::leave_gpu_out})
    EXPECT_NEAR(widened("elsewhere", split), 3.0, 1e-9) << split_name(split);
  for (const Split split : {Split::leave_technique_out, Split::rate_extrapolation})
    EXPECT_NEAR(widened("elsewhere", split), 1.0, 1e-9) << split_name(split);
}

TEST_F(QuantileTest, ExtrapolatedIntervalsAreAsWideAsTheWidestSplit) {
  for (const Split split : {Split::in_sample, Split::leave_scene_out, Split::leave_technique_out,
                            Split::rate_extrapolation, Split::leave_gpu_out})
    EXPECT_NEAR(widened("nowhere", split), 3.0, 1e-9) << split_name(split);
}

}  // namespace
}  // namespace hwsim::cost_models::test
