#include "lab/studies/prices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "hwsim/config/assign.h"
#include "hwsim/config/toml_file.h"
#include "hwsim/gpu/gpu_keys.h"
#include "lab/base/messages.h"
#include "lab/base/table.h"
#include "lab/base/text.h"

namespace hwsim::lab {
namespace {

constexpr std::string_view kHelp =
    "schema = 1, kind = \"prices\", base_area = 0, and for each key a table [KEY] with area, low, high, "
    "step, "
    "scales";

constexpr double kMostPrice = 1e12;  // also --area's; a sum of areas stays finite

/// The slots of a copy of a GPU's numbers.
const Key* real_key(const std::vector<Key>& keys, const std::string& name) {
  const Key* key = find_key(keys, name);
  return key && std::holds_alternative<double*>(key->slot) && (key->info.flags & kDirections) != 0 ? key
                                                                                                   : nullptr;
}

class PriceReader {
 public:
  PriceReader(const std::string& path, const GpuConfig& gpu) : values_(gpu), keys_(keys_of(values_)) {
    prices_.path = path;
    const TomlFile file = read_toml_file(path, problems_);
    for (const TomlEntry& entry : file.entries) take(entry);
    if (problems_.empty() && !(has_schema_ && has_kind_))
      complain("C019", "`schema = 1` or `kind = \"prices\"` is missing", {.file = path});
    for (const auto& [name, place] : places_) check(find(name), place);
    if (problems_.empty() && prices_.keys.empty())
      complain("C026", "no key of a GPU has a price", {.file = path});
    if (!problems_.empty()) throw InputError(problems_);
  }
  PriceList take() { return std::move(prices_); }

 private:
  void complain(std::string code, std::string message, const SourcePlace& place) {
    Diagnostic d = problem(std::move(code), std::move(message), "", std::string(kHelp));
    d.place = place;
    problems_.push_back(std::move(d));
  }

  void take(const TomlEntry& entry) {
    const std::string* text = entry.value ? std::get_if<std::string>(&*entry.value) : nullptr;
    if (entry.path == "schema") {
      has_schema_ = entry.value == TomlValue(std::int64_t{1});
      if (!has_schema_) complain("C019", "`schema` must be 1", entry.value_place);
    } else if (entry.path == "kind") {
      has_kind_ = text && *text == "prices";
      if (!has_kind_) complain("C019", "`kind` must be \"prices\" here", entry.value_place);
    } else if (entry.path == "about") {
      if (!text) complain("C013", "`about` must be a text", entry.value_place);
    } else if (entry.path == "base_area") {
      number(entry, prices_.base_area);
    } else {
      take_price(entry, text);
    }
  }

  void take_price(const TomlEntry& entry, const std::string* text) {
    const auto dot = entry.path.rfind('.');
    const std::string name = entry.path.substr(0, dot);
    const std::string field = dot == std::string::npos ? "" : entry.path.substr(dot + 1);
    if (field.empty()) return unknown(entry);
    PricedKey& key = find(name);
    places_.try_emplace(name, entry.key_place);
    const std::map<std::string, double*> numbers = {
        {"area", &key.area}, {"low", &key.low}, {"high", &key.high}, {"step", &key.step}};
    if (const auto found = numbers.find(field); found != numbers.end())
      number(entry, *found->second);
    else if (field == "scales" && text)
      key.scales = split(*text, ',');
    else
      unknown(entry);
  }

  void unknown(const TomlEntry& entry) {
    complain("C012", "unknown key `" + entry.path + "` in a list of prices", entry.key_place);
  }

  void number(const TomlEntry& entry, double& target) {
    const auto* real = entry.value ? std::get_if<double>(&*entry.value) : nullptr;
    const auto* whole = entry.value ? std::get_if<std::int64_t>(&*entry.value) : nullptr;
    if (!real && !whole) return complain("C013", "`" + entry.path + "` must be a number", entry.value_place);
    target = real ? *real : static_cast<double>(*whole);
    if (!(target >= 0.0 && target <= kMostPrice))
      complain(
          "C014",
          fmt::format("`{}` is {}, must be a number from 0 to {:g}", entry.path, exact(target), kMostPrice),
          entry.value_place);
  }

  PricedKey& find(const std::string& name) {
    const auto found = std::ranges::find(prices_.keys, name, &PricedKey::key);
    if (found != prices_.keys.end()) return *found;
    prices_.keys.push_back({.key = name});
    return prices_.keys.back();
  }

  void check(PricedKey& price, const SourcePlace& place) {
    for (const std::string& name : price.scales)
      if (!real_key(keys_, name))
        complain(
            "C026",
            "`" + name + "`, which scales with `" + price.key + "`, is no number of a GPU that enters a time",
            place);
    const Key* key = real_key(keys_, price.key);
    if (!key) {
      complain("C026", "`" + price.key + "` is no number of a GPU that enters a time", place);
      std::vector<std::string> names;
      for (const Key& known : keys_)
        if (real_key(keys_, std::string(known.info.name))) names.emplace_back(known.info.name);
      problems_.back().hint = did_you_mean(price.key, names);
      return;
    }
    if (price.step == 0.0 && key->info.has(kWhole)) price.step = 1.0;
    if (!(price.low < price.high) || price.low < key->info.low || price.high > key->info.high ||
        price.low <= 0.0)
      complain(
          "C026",
          fmt::format("`{}` may be chosen from {} to {}, must be a range above 0 within {} to {}", price.key,
                      exact(price.low), exact(price.high), exact(key->info.low), exact(key->info.high)),
          place);
    if (price.area <= 0.0)
      complain("C026", "`" + price.key + "` has no area, so that all of it would be taken", place);
    const auto whole = [](double value) { return value == std::floor(value); };
    if (key->info.has(kWhole) && !(whole(price.low) && whole(price.step)))
      complain("C026", "`" + price.key + "` counts units: `low` and `step` must be whole numbers", place);
  }

  PriceList prices_;
  GpuValues<double> values_;
  std::vector<Key> keys_;
  bool has_schema_ = false, has_kind_ = false;
  std::map<std::string, SourcePlace> places_;
  std::vector<Diagnostic> problems_;
};

double& slot_of(const std::vector<Key>& keys, const std::string& name) {
  return *std::get<double*>(find_key(keys, name)->slot);
}

}  // namespace

double PriceList::area_of(const std::vector<double>& values) const {
  double area = base_area;
  for (std::size_t i = 0; i < keys.size(); ++i) area += keys[i].area * values[i];
  return area;
}

PriceList read_prices(const std::string& path, const GpuConfig& gpu) { return PriceReader(path, gpu).take(); }

std::vector<double> values_in(const PriceList& prices, const GpuConfig& gpu) {
  GpuValues<double> copy = gpu;
  const std::vector<Key> keys = keys_of(copy);
  std::vector<double> values;
  for (const PricedKey& price : prices.keys) values.push_back(slot_of(keys, price.key));
  return values;
}

GpuConfig with_values(const GpuConfig& gpu, const PriceList& prices, const std::vector<double>& values) {
  GpuConfig changed = gpu;
  const std::vector<Key> keys = keys_of(static_cast<GpuValues<double>&>(changed));
  for (std::size_t i = 0; i < values.size(); ++i) {
    double& slot = slot_of(keys, prices.keys[i].key);
    const double factor = values[i] / slot;
    slot = values[i];
    for (const std::string& name : prices.keys[i].scales) slot_of(keys, name) *= factor;
  }
  return changed;
}

std::vector<Assignment> settings_for(const GpuConfig& gpu, const PriceList& prices,
                                     const std::vector<double>& values) {
  GpuConfig changed = with_values(gpu, prices, values);
  const std::vector<Key> keys = keys_of(static_cast<GpuValues<double>&>(changed));
  std::vector<Assignment> settings;
  const auto add = [&](const std::string& name) {
    const double value = slot_of(keys, name);
    const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
    settings.push_back({"gpu." + name, whole ? fmt::format("{:.0f}", value) : exact(value)});
  };
  for (const PricedKey& price : prices.keys) {
    add(price.key);
    for (const std::string& name : price.scales) add(name);
  }
  return settings;
}

}  // namespace hwsim::lab
