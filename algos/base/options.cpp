#include "algos/base/options.h"

#include <algorithm>

namespace hwsim::algos {

void OptionList::add(const OptionInfo& info, std::function<double()> get, std::function<void(double)> set) {
  options_.push_back({info, std::move(get), std::move(set)});
  OptionInfo& added = options_.back().info;
  if (!added.choices.empty()) added.max = static_cast<double>(std::ranges::count(added.choices, '|'));
}

void OptionList::real(std::string_view name, double& field, std::array<double, 2> range,
                      std::string_view description) {
  add(
      {name, description, 0.0, range[0], range[1]}, [&field] { return field; },
      [&field](double value) { field = value; });
}

void OptionList::whole(std::string_view name, int& field, std::array<int, 2> range,
                       std::string_view description) {
  add(
      {name, description, 0.0, static_cast<double>(range[0]), static_cast<double>(range[1]), "", true},
      [&field] { return static_cast<double>(field); },
      [&field](double value) { field = static_cast<int>(value); });
}

void OptionList::fixed(std::string_view name, int& field, std::string_view description) {
  whole(name, field, {field, field}, description);
}

std::vector<OptionInfo> Options::infos() const {
  Options copy = *this;
  std::vector<OptionInfo> infos;
  for (const BoundOption& option : copy.bound()) {
    infos.push_back(option.info);
    infos.back().default_value = option.get();
  }
  return infos;
}

}  // namespace hwsim::algos
