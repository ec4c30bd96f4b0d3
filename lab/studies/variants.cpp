#include "lab/studies/variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>

#include "hwsim/base/units_of_measure.h"
#include "pipeline/base/parallel.h"

namespace hwsim::lab {
namespace {

constexpr std::size_t kBlock = 1024;      // points between two looks at what went wrong
constexpr std::size_t kReportEvery = 16;  // points between two reports of progress

std::vector<Assignment> joined(std::vector<Assignment> sets, const std::vector<Assignment>& more) {
  sets.insert(sets.end(), more.begin(), more.end());
  return sets;
}

VariantTime numbers_of(const FrameTiming& timing) {
  VariantTime time{.time_ms = timing.time_ns / kNsPerMs, .support = timing.support};
  if (timing.interval_ns)
    time.interval_ms = {(*timing.interval_ns)[0] / kNsPerMs, (*timing.interval_ns)[1] / kNsPerMs};
  time.dram_mb = (timing.dram_bytes.total_read() + timing.dram_bytes.total_write()) / kBytesPerMb;
  return time;
}

/// Each problem once, with the first point that has it: a thousand points may have the same mistake.
void throw_problems(const std::map<std::size_t, InputError>& failed, const PointSettings& each) {
  if (failed.empty()) return;
  std::vector<Diagnostic> problems;
  for (const auto& [point, error] : failed)
    for (Diagnostic problem : error.diagnostics()) {
      const bool known = std::ranges::any_of(problems, [&](const Diagnostic& other) {
        return other.code == problem.code && other.message == problem.message;
      });
      if (known) continue;
      std::string name = fmt::format("point {}:", point + 1);
      for (const Assignment& set : each[point]) name += " " + set.path + "=" + set.value;
      problem.notes.push_back(std::move(name));
      problems.push_back(std::move(problem));
    }
  keep_first(problems);
  throw InputError(std::move(problems));
}

}  // namespace

std::vector<VariantTime> time_variants(const KeptFrame& frame, const GpuVariants& variants, int jobs,
                                       Observer& observer) {
  std::vector<VariantTime> times(variants.each.size());
  std::map<std::size_t, InputError> failed;
  std::mutex mutex;
  std::atomic<std::size_t> done = 0;
  const auto report = [&] {
    observer.progress(static_cast<double>(done) / static_cast<double>(times.size()),
                      fmt::format("{} points", times.size()));
  };
  for (std::size_t first = 0; first < times.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, times.size() - first);
    pipeline::parallel_for(count, jobs, [&](std::size_t index, int) {
      const std::size_t point = first + index;
      try {
        const GpuConfig gpu = variants.files.with(joined(variants.sets, variants.each[point]));
        times[point] = numbers_of(timing_of(frame, gpu));
      } catch (const InputError& error) {
        const std::lock_guard lock(mutex);
        failed.emplace(point, error);
      }
      if (++done % kReportEvery == 0) report();
    });
    throw_problems(failed, variants.each);
  }
  report();
  observer.progress_ended();
  return times;
}

}  // namespace hwsim::lab
