#pragma once
// What a generator of scenes offers: its name and its parameters.
#include <string>
#include <vector>

namespace hwsim::pipeline {

struct GeneratorParameter {
  std::string name;
  double default_value = 0.0, min = 0.0, max = 0.0;
  std::string description;  ///< with the unit
};

struct GeneratorInfo {
  std::string name;
  std::string description;
  std::vector<GeneratorParameter> parameters;  ///< always holds "seed"
};

}  // namespace hwsim::pipeline
