#pragma once
// All generators of scenes, and what each is given.
#include <map>
#include <span>
#include <string>

#include "pipeline/generate/blueprint.h"
#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/generator_info.h"

namespace hwsim::pipeline::generate {

/// Complete and inside their ranges: the registry's caller has checked them.
class Parameters {
 public:
  explicit Parameters(std::map<std::string, double> values) : values_(std::move(values)) {}
  double number(const char* name) const { return values_.at(name); }
  int count(const char* name) const { return static_cast<int>(values_.at(name)); }
  double fov_y_rad() const { return number("fov_deg") * kPi / 180.0; }
  std::uint64_t seed() const { return static_cast<std::uint64_t>(values_.at("seed")); }

 private:
  std::map<std::string, double> values_;
};

struct Generator {
  GeneratorInfo info;
  Blueprint (*make)(const Parameters&);
};

// One function a generator, each in the file of its name.
Generator sponza_hall();
Generator grass();
Generator powerplant();
Generator dragon();
Generator wires();
Generator text_page();
Generator old_city();
Generator foliage();
Generator car_body();
Generator fur_ball();
Generator bamboo();
Generator metal();
Generator grill();

std::span<const Generator> registry();

/// Every generator has it; whole, so that it survives the way through a double.
GeneratorParameter seed_parameter();

/// The vertical angle of the camera `suggested`.
GeneratorParameter fov_parameter(double default_deg);

}  // namespace hwsim::pipeline::generate
