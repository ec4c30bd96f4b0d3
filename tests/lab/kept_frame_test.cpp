// A frame that is emulated once: its times, its derivatives, its variants, and whose work it is.
#include "lab/studies/kept_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lab/lab.h"
#include "lab/workbench.h"

namespace hwsim::lab {
namespace {

using test::Listener;
using test::Workbench;

RunPlan planned(Lab& lab, const Request& request, const std::vector<GpuChoice>& gpus = {{"gtx980"}}) {
  std::vector<Diagnostic> problems;
  RunPlan plan = lab.plan(request, gpus, problems);
  if (!problems.empty()) throw InputError(problems);
  return plan;
}

std::vector<Assignment> sets(const std::string& text) { return {parse_assignment(text)}; }

template <class Question>
std::string mistake(const Question& question) {
  try {
    question();
  } catch (const InputError& error) {
    return error.diagnostics().front().code;
  }
  return "none";
}

TEST(KeptFrame, IsTimedOnAnyGpuAsARunThereIs) {
  const Workbench bench;
  Lab lab;
  const KeptFrame frame = lab.emulate(planned(lab, bench.request({"msaa4x"})));
  const lab::Run run = lab.run(bench.request({"msaa4x"}, {"gtx980", "rtx3060"}));
  for (const Result& result : run.results) {
    const GpuConfig gpu = lab.gpu({result.gpu});
    const Result timed = time(lab.frame_for(frame, gpu), gpu);
    EXPECT_EQ(timed.frame.time_ms, result.frame.time_ms) << result.gpu;
    EXPECT_EQ(timed.frame.interval_ms, result.frame.interval_ms);
    EXPECT_EQ(timed.passes.size(), result.passes.size());
    EXPECT_EQ(timed.passes.front().counters, result.passes.front().counters);
  }
}

TEST(KeptFrame, OutlivesItsLabAndKeepsItsImage) {
  const Workbench bench;
  Request request = bench.request({"none"});
  request.settings.images = true;
  request.settings.reference_samples = 4;
  GpuConfig gpu;
  const KeptFrame frame = [&] {
    Lab lab;
    gpu = lab.gpu({"gtx980"});
    return lab.emulate(planned(lab, request));
  }();
  EXPECT_EQ(frame.emulation->color.width, 64);
  EXPECT_EQ(frame.emulation->shading_heat.height, 48);
  ASSERT_TRUE(frame.image_error && frame.flip_map);
  EXPECT_EQ(frame.flip_map->width, 64);
  EXPECT_EQ(time(frame, gpu).image->flip_mean, frame.image_error->flip_mean);
}

TEST(KeptFrame, IsDrawnAnewOnlyForOtherFeatures) {
  const Workbench bench;
  Lab lab;
  const KeptFrame frame = lab.emulate(planned(lab, bench.request({"msaa4x"})));
  const GpuConfig faster = lab.gpu({"gtx980", {"rops-x2"}, sets("gpu.core_clock_mhz=x1.5")});
  EXPECT_EQ(lab.frame_for(frame, faster).emulation, frame.emulation);
  const GpuConfig other = lab.gpu({"gtx980", {}, sets("gpu.functional.post_transform_cache_entries=16")});
  ASSERT_FALSE(is_work_of(frame, other));
  EXPECT_EQ(mistake([&] { time(frame, other); }), "U040");
  EXPECT_EQ(mistake([&] { gradient(frame, other); }), "U040");
  const KeptFrame drawn = lab.frame_for(frame, other);
  EXPECT_NE(drawn.emulation, frame.emulation);
  EXPECT_GT(time(drawn, other).frame.time_ms, 0.0);
}

TEST(KeptFrame, TakesOneTechniqueAndOneGpu) {
  const Workbench bench;
  Lab lab;
  EXPECT_EQ(mistake([&] { lab.emulate(planned(lab, bench.request({"none", "msaa4x"}))); }), "U004");
  EXPECT_EQ(mistake([&] { lab.emulate(planned(lab, bench.request(), {})); }), "U004");
}

TEST(KeptFrame, GradientIsTheSlopeOfTheTime) {
  const Workbench bench;
  Lab lab;
  for (const char* engine : {"queue", "roofline"}) {
    Request request = bench.request({"msaa8x"});
    request.settings.engine = engine;
    const KeptFrame frame = lab.emulate(planned(lab, request));
    const GpuConfig gpu = lab.gpu({"gtx980"});
    double moving = 0;
    for (const KeySlope& slope : gradient(frame, gpu)) {
      const auto at = [&](double factor) {
        const std::string text = "gpu." + slope.key + "=" + std::to_string(slope.value * factor);
        return time(frame, lab.gpu({"gtx980", {}, sets(text)})).frame.time_ms;
      };
      if (slope.key != "core_clock_mhz" && slope.key != "dram_bandwidth_gb_s") continue;
      constexpr double kStep = 1e-5;
      const double measured = (std::log(at(1 + kStep)) - std::log(at(1 - kStep))) / (2 * kStep);
      EXPECT_NEAR(slope.elasticity, measured, 1e-3) << slope.key << " by " << engine;
      moving += std::abs(slope.elasticity);
    }
    EXPECT_GT(moving, 0.1) << "nothing moved the time by " << engine;
  }
}

TEST(KeptFrame, VariantsAreTimesOfTheirGpusForAnyNumberOfThreads) {
  const Workbench bench;
  const PointSettings each(parse_axes({"gpu.core_clock_mhz=600,1200", "gpu.dram_bandwidth_gb_s=100,200,300"}),
                           Combine::grid);
  std::vector<VariantTime> first;
  for (const int jobs : {1, 3}) {
    Listener listener;
    Lab lab({.jobs = jobs, .observer = &listener});
    const KeptFrame frame = lab.emulate(planned(lab, bench.request({"msaa4x"})));
    const GpuChoice choice{"gtx980", {"rops-x2"}, sets("gpu.l2_size_kib=4096")};
    const std::vector<VariantTime> times = lab.time_variants(frame, choice, each);
    ASSERT_EQ(times.size(), 6u);
    for (std::size_t i = 0; i < times.size(); ++i) {
      GpuChoice one = choice;
      for (const Assignment& set : each[i]) one.sets.push_back(set);
      const Result alone = time(frame, lab.gpu(one));
      EXPECT_EQ(times[i].time_ms, alone.frame.time_ms) << i;
      EXPECT_EQ(times[i].interval_ms, alone.frame.interval_ms) << i;
      EXPECT_EQ(times[i].dram_mb, alone.frame.dram_mb) << i;
    }
    EXPECT_EQ(listener.done.back(), 1.0);
    if (!first.empty()) {
      EXPECT_EQ(times, first) << jobs << " threads";
    }
    first = times;
  }
}

TEST(KeptFrame, VariantsThatAreNoneAreToldEachOnceWithTheirPoint) {
  const Workbench bench;
  Lab lab;
  const KeptFrame frame = lab.emulate(planned(lab, bench.request()));
  const PointSettings each(parse_axes({"gpu.core_clock_mhz=600,-1", "gpu.no_such_key=1,2"}), Combine::grid);
  try {
    lab.time_variants(frame, {"gtx980"}, each);
    FAIL() << "nothing was wrong";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().size(), 2u);
    EXPECT_EQ(error.diagnostics().front().notes.back(), "point 1: gpu.core_clock_mhz=600 gpu.no_such_key=1");
  }
}

struct Impatient : Observer {
  void progress(double, const std::string&) override {
    if (armed) throw std::runtime_error("enough");
  }
  bool armed = true;
};

TEST(KeptFrame, WorkEndsWithAnExceptionOfTheObserverAndTheLabGoesOn) {
  const Workbench bench;
  Impatient observer;
  Lab lab({.jobs = 2, .observer = &observer});
  const RunPlan plan = planned(lab, bench.request());
  EXPECT_THROW(lab.emulate(plan), std::runtime_error);
  observer.armed = false;
  const KeptFrame frame = lab.emulate(plan);
  const PointSettings each(parse_axes({"gpu.core_clock_mhz=600..1200:100"}), Combine::grid);
  observer.armed = true;
  EXPECT_THROW(lab.time_variants(frame, {"gtx980"}, each), std::runtime_error);
  observer.armed = false;
  EXPECT_EQ(lab.time_variants(frame, {"gtx980"}, each).size(), 100u);
}

TEST(Lab, PlanTakesGpusOneByOneAndTellsTheMistakesOfAll) {
  const Workbench bench;
  Lab lab;
  std::vector<Diagnostic> problems;
  Request request = bench.request();
  request.sets = sets("gpu.core_clock_mhz=500");
  const RunPlan plan =
      lab.plan(request, {{"gtx980"}, {"gtx980", {"rops-x2"}, sets("gpu.l2_size_kib=4096")}}, problems);
  EXPECT_TRUE(problems.empty());
  ASSERT_EQ(plan.gpus.size(), 2u);
  EXPECT_EQ(plan.gpus[0].core_clock_mhz, 500.0);
  EXPECT_EQ(plan.gpus[1].core_clock_mhz, 500.0) << "the request's settings are laid over each";
  EXPECT_NE(content_hash(plan.gpus[0]), content_hash(plan.gpus[1]));
  lab.plan(request, {{"no_such"}, {"gtx980", {"no-such-overlay"}, {}}}, problems);
  EXPECT_EQ(problems.size(), 2u);
}

}  // namespace
}  // namespace hwsim::lab
