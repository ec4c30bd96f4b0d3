#include "cost_models/kept_traces.h"

#include "hwsim/base/byte_codec.h"
#include "hwsim/trace/trace_file.h"

namespace hwsim::cost_models {
namespace {

constexpr std::string_view kKind = "hwkept";
constexpr std::uint64_t kVersion =
    2;  // raised when the order below changes; passes have the trace file's version

/// The one order of a run's fields, for writing and reading.
template <class Spec, class Text, class Whole>
void describe_run(Spec& run, const Text& text, const Whole& whole) {
  auto& [scene, camera, technique, gpu, width_px, height_px, settings, unlit] = run;
  text(scene);
  text(camera);
  text(technique);
  text(gpu);
  whole(width_px);
  whole(height_px);
  text(settings);
  text(unlit);
}

/// Numbers the different passes of all traces.
class Pool {
 public:
  std::uint64_t number_of(const PassWork& pass) {
    WorkTrace alone;
    alone.passes.push_back(pass);
    const std::vector<std::uint8_t> bytes = encode_trace(alone);
    const auto [known, added] =
        numbers_.emplace(std::string(bytes.begin(), bytes.end()), passes_.passes.size());
    if (added) passes_.passes.push_back(pass);
    return known->second;
  }
  /// Ids of counters are those of the program that made the traces: the same in all.
  void name_counters(const WorkTrace& trace) { passes_.technique_counters = trace.technique_counters; }
  const WorkTrace& passes() const { return passes_; }

 private:
  std::map<std::string, std::uint64_t> numbers_;  ///< by the pass as bytes
  WorkTrace passes_;
};

RunSpec read_run(ByteReader& in) {
  RunSpec run;
  describe_run(
      run, [&](std::string& text) { text = in.text(); },
      [&](int& whole) { whole = static_cast<int>(in.integer()); });
  return run;
}

}  // namespace

std::vector<std::uint8_t> encode_kept(const KeptTraces& kept) {
  Pool pool;
  ByteWriter out;
  out.text(kept.sources);
  out.count(kept.traces.size());
  for (const auto& [run, trace] : kept.traces) {
    describe_run(
        run, [&](const std::string& text) { out.text(text); }, [&](int whole) { out.integer(whole); });
    pool.name_counters(*trace);
    out.text(trace->scene);
    out.text(trace->technique);
    out.count(trace->peak_memory_bytes);
    out.count(trace->allocated_memory_bytes);
    out.count(trace->passes.size());
    for (const PassWork& pass : trace->passes) out.count(pool.number_of(pass));
  }
  out.raw(encode_trace(pool.passes()));
  return seal(kKind, kVersion, out.take());
}

KeptTraces decode_kept(std::span<const std::uint8_t> bytes) {
  ByteReader in(open_seal(kKind, kVersion, bytes));
  KeptTraces kept;
  kept.sources = in.text();
  std::vector<std::pair<WorkTrace*, std::vector<std::uint64_t>>> passes_of;
  for (std::size_t runs = in.elements(); runs > 0; --runs) {
    const RunSpec run = read_run(in);
    auto trace = std::make_shared<WorkTrace>();
    trace->scene = in.text();
    trace->technique = in.text();
    trace->width_px = run.width_px;
    trace->height_px = run.height_px;
    trace->peak_memory_bytes = in.count();
    trace->allocated_memory_bytes = in.count();
    std::vector<std::uint64_t> numbers(in.elements());
    for (std::uint64_t& number : numbers) number = in.count();
    passes_of.emplace_back(trace.get(), std::move(numbers));
    if (!kept.traces.emplace(run, std::move(trace)).second) throw DamagedBytes("a run is there twice");
  }
  const DecodedTrace pool = decode_trace(in.rest());
  if (!pool.trace) throw DamagedBytes(pool.damage);
  for (const auto& [trace, numbers] : passes_of) {
    trace->technique_counters = pool.trace->technique_counters;
    for (const std::uint64_t number : numbers) {
      if (number >= pool.trace->passes.size()) throw DamagedBytes("a run names a pass that is not there");
      trace->passes.push_back(pool.trace->passes[number]);
    }
  }
  return kept;
}

TraceSource source_of(KeptTraces kept) {
  return [kept = std::move(kept)](const RunSpec& run, const GpuConfig&) {
    const auto found = kept.traces.find(run);
    if (found != kept.traces.end()) return found->second;
    Diagnostic problem;
    problem.code = "M008";
    problem.message = "no trace of " + run.to_string() + " is kept";
    problem.help = "`scripts/keep_traces.sh` emulates every published run anew";
    throw InputError(problem);
  };
}

TraceSource keeping(TraceSource traces, KeptTraces& kept) {
  return [traces = std::move(traces), &kept](const RunSpec& run, const GpuConfig& gpu) {
    return kept.traces[run] = traces(run, gpu);
  };
}

}  // namespace hwsim::cost_models
