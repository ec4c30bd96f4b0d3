#pragma once
// The skeleton of a base technique, to copy: multisampling whose resolve is a shader, which leaves pixels of
// one color alone.
#include "algos/base/technique.h"

namespace hwsim::algos {

/// What algos/registry.cpp lists of this room, in one line.
Room skeleton_room();

}  // namespace hwsim::algos
