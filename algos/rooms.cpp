#include "algos/rooms.h"

#include <algorithm>

namespace hwsim::algos {
namespace {

std::vector<DeclaredCounter> declared_counters() {
  std::vector<DeclaredCounter> all;
  for (const Room& room : rooms()) all.insert(all.end(), room.counters.begin(), room.counters.end());
  std::ranges::sort(all, {}, [](const DeclaredCounter& c) { return c.counter.slot; });
  return all;
}

std::vector<ListedCounter> list_counters() {
  std::vector<ListedCounter> units, own;
  const std::span<const CounterInfo> catalog = counter_catalog();
  const std::size_t first_slot = catalog.size() - kTechniqueCounterSlots;
  for (std::size_t i = 0; i < first_slot; ++i) units.push_back({catalog[i], i});
  for (const DeclaredCounter& c : declared_counters())
    own.push_back({{c.id, "technique", c.name, c.text, "generic"}, first_slot + c.counter.slot});
  const auto memory = std::ranges::find(units, "mem", [](const ListedCounter& c) { return c.info.unit; });
  units.insert(memory, own.begin(), own.end());
  return units;
}

}  // namespace

std::span<const TechniqueInfo> techniques() {
  static const std::vector<TechniqueInfo> all = [] {
    std::vector<TechniqueInfo> list;
    for (const Room& room : rooms()) list.insert(list.end(), room.techniques.begin(), room.techniques.end());
    return list;
  }();
  return all;
}

std::string_view kind_name(TechniqueKind kind) {
  constexpr std::array<std::string_view, 3> kNames = {"base", "modifier", "filter"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::span<const ListedCounter> counters() {
  static const std::vector<ListedCounter> all = list_counters();
  return all;
}

const std::vector<std::string>& technique_counter_ids() {
  static const std::vector<std::string> ids = [] {
    std::vector<std::string> list(kTechniqueCounterSlots);
    for (const DeclaredCounter& c : declared_counters()) list[c.counter.slot] = c.id;
    return list;
  }();
  return ids;
}

std::uint64_t shaded_samples(const WorkTrace& trace) {
  const TechniqueCounters sum = total(trace).technique;
  std::uint64_t shaded = 0;
  for (const Room& room : rooms())
    for (const TechniqueCounter counter : room.shaded) shaded += sum[counter];
  return shaded;
}

std::vector<CounterViolation> broken_laws(const PassCounters& counters) {
  std::vector<CounterViolation> broken = violations(counters, unit_laws());
  for (const Room& room : rooms())
    for (const CounterViolation& v : violations(counters, room.laws)) broken.push_back(v);
  return broken;
}

std::vector<MessageCode> message_codes() {
  std::vector<MessageCode> codes;
  for (const Room& room : rooms()) codes.insert(codes.end(), room.codes.begin(), room.codes.end());
  return codes;
}

}  // namespace hwsim::algos
