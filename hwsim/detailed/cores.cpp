#include "hwsim/detailed/cores.h"

#include <algorithm>

namespace hwsim {
namespace {

std::size_t l1_lines(const GpuRates<double>& r) {
  constexpr std::size_t kLinesMin = 16;
  return std::max(kLinesMin, static_cast<std::size_t>(r.l1_bytes / kTextureLineBytes));
}

}  // namespace

Cores::Cores(Surroundings& around)
    : around_(around),
      l1_survival_(survival(around.pass.reuse.texture_l1.read_bytes,
                            around.pass.reuse.texture_l1.requested_read_bytes, around.plan.l1_asked)),
      lines_max_(static_cast<std::size_t>(around.gpu.core_lines_max)) {
  const auto count = static_cast<std::size_t>(around.rates.shader_cores);
  cores_.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    cores_.emplace_back(l1_lines(around.rates), around.gpu.l1_ways, around.seed + 100 + i);
}

std::optional<std::size_t> Cores::pick(const ChunkPackets& chunk) const {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < cores_.size(); ++i)
    if (cores_[i].resident + 1.0 <= chunk.resident && (!best || cores_[i].resident < cores_[*best].resident))
      best = i;
  return best;
}

void Cores::dispatch(const ChunkPackets& chunk, std::size_t core, double ns) {
  if (idle_.empty()) {
    idle_.push_back(static_cast<std::uint32_t>(subgroups_.size()));
    subgroups_.emplace_back();
  }
  const std::uint32_t index = idle_.back();
  idle_.pop_back();
  const bool fetches = chunk.work.l1_lines > 0.0 || chunk.work.storage_lines > 0.0 || chunk.work.tex_ns > 0.0;
  const int phases = std::max(fetches ? 1 : 0, static_cast<int>(around_.whole(chunk.work.memory_phases)));
  subgroups_[index] = {&chunk, core, 0, phases, 0.0, 0.0, 0.0, 0.0};
  cores_[core].resident += 1.0;
  around_.events.push(ns, index, Step::work);
}

void Cores::handle(const Event& event) {
  if (event.step == Step::work) work(event.subgroup, event.ns);
  if (event.step == Step::fetch) fetch(event.subgroup, event.ns);
  if (event.step == Step::more) ask(cores_[subgroups_[event.subgroup].core], event.ns);
}

// Between two requests to memory a subgroup has an equal part of its operations. Pipes take whole parts in
// the order in which they come.
void Cores::work(std::uint32_t index, double now) {
  const Subgroup& s = subgroups_[index];
  const SubgroupWork& w = s.chunk->work;
  Core& core = cores_[s.core];
  const double part = 1.0 / (s.phases + 1);
  double end = now + w.alu_chain_ns * part;
  const auto pipe = [&](double& free_ns, double work_ns, double& busy) {
    if (work_ns <= 0.0) return;
    free_ns = std::max(free_ns, now) + work_ns * part;
    busy += work_ns * part;
    end = std::max(end, free_ns);
  };
  pipe(core.alu_ns, w.alu_ns, alu_busy_ns_);
  pipe(core.sfu_ns, w.sfu_ns, sfu_busy_ns_);
  pipe(core.memory_pipe_ns, w.memory_pipe_ns, memory_pipe_busy_ns_);
  pipe(atomic_free_ns_, w.atomic_ns, atomic_busy_ns_);
  around_.events.push(end, index, s.phase < s.phases ? Step::fetch : Step::leave);
}

void Cores::fetch(std::uint32_t index, double now) {
  Subgroup& s = subgroups_[index];
  const SubgroupWork& w = s.chunk->work;
  Core& core = cores_[s.core];
  const double part = 1.0 / s.phases;
  core.tex_ns = std::max(core.tex_ns, now) + w.tex_ns * part;
  tex_busy_ns_ += w.tex_ns * part;
  s.ready_ns = s.asks_from_ns = core.tex_ns;
  s.loads = around_.whole(w.storage_lines * part);
  s.textures = 0.0;
  for (double i = around_.whole(w.l1_lines * part); i > 0.0; i -= 1.0)
    if (!core.l1.access(core.reads.next(l1_survival_, false, 1.0, 0.0), false).hit) s.textures += 1.0;
  core.fetching.push_back(index);
  if (core.fetching.size() == 1) ask(core, now);
}

// A core has a limited number of lines on their way. What it cannot ask for yet it asks for when some have
// come: asking ahead of time would take DRAM's place from requests of other units that come before.
void Cores::ask(Core& core, double now) {
  constexpr std::size_t kTogether = 16;
  while (!core.fetching.empty()) {
    const std::uint32_t index = core.fetching.front();
    Subgroup& s = subgroups_[index];
    if (!ask_lines(core, s, now))
      return around_.events.push(std::max(core.misses.front(), core.misses[kTogether - 1]), index,
                                 Step::more);
    ++s.phase;
    around_.events.push(s.ready_ns + around_.rates.tex_latency_ns, index, Step::work);
    core.fetching.pop_front();
  }
}

bool Cores::ask_lines(Core& core, Subgroup& s, double now) {
  const double start = std::max(now, s.asks_from_ns);
  while (s.textures > 0.0 || s.loads > 0.0) {
    while (!core.misses.empty() && core.misses.front() <= start) core.misses.pop_front();
    if (core.misses.size() >= lines_max_) return false;
    const bool texture = s.textures > 0.0;
    const Stream stream = texture ? Stream::texture : Stream::storage;
    const double arrives = around_.memory.access(
        MemoryClient::reads, stream, around_.survival_of(index_of(stream), false), 1.0, false, false, start);
    core.misses.push_back(arrives);
    s.ready_ns = std::max(s.ready_ns, arrives);
    (texture ? s.textures : s.loads) -= 1.0;
  }
  return true;
}

void Cores::release(std::uint32_t subgroup) {
  cores_[subgroups_[subgroup].core].resident -= 1.0;
  idle_.push_back(subgroup);
}

double Cores::l1_missing() const {
  return missing(l1_survival_, static_cast<double>(cores_.front().l1.lines()));
}

void Cores::pass_by(double lookups) {
  for (Core& core : cores_) {
    const std::size_t held = std::min(core.l1.lines(), core.reads.lines());
    const double lines = lookups * missing(l1_survival_, static_cast<double>(held));
    for (double i = std::min(lines, static_cast<double>(core.l1.lines())); i >= 1.0; i -= 1.0)
      core.l1.access(core.reads.fresh(), false);
  }
}

std::vector<int> Cores::residents() const {
  std::vector<int> residents;
  for (const Core& core : cores_) residents.push_back(static_cast<int>(core.resident));
  return residents;
}

double Cores::shader_busy_ns() const {
  const double pipes = std::max({alu_busy_ns_, sfu_busy_ns_, memory_pipe_busy_ns_});
  return std::max(pipes / static_cast<double>(cores_.size()), atomic_busy_ns_);
}

}  // namespace hwsim
