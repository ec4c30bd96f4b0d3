#pragma once
// What a scene may be, said where something else was given for one.
#include <string>

#include "hwsim/base/diagnostics.h"

namespace hwsim::lab {

/// The same error; where `name` is an unknown scene, with what a scene is, and what `name` is instead.
InputError with_scene_kinds(const InputError& error, const std::string& name);

/// What `open` returns; its InputError comes out with_scene_kinds.
template <class Open>
auto opened_scene(const std::string& name, const Open& open) try {
  return open();
} catch (const InputError& error) {
  throw with_scene_kinds(error, name);
}

}  // namespace hwsim::lab
