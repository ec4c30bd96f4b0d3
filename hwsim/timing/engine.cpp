#include "hwsim/timing/engine.h"

namespace hwsim {

std::string_view engine_name(Engine engine) {
  switch (engine) {
    case Engine::roofline:
      return "roofline";
    case Engine::queue:
      return "queue";
    case Engine::detailed:
      return "detailed";
  }
  return "queue";
}

std::optional<Engine> engine_from_name(std::string_view name) {
  for (const Engine engine : {Engine::roofline, Engine::queue, Engine::detailed})
    if (engine_name(engine) == name) return engine;
  return std::nullopt;
}

}  // namespace hwsim
