#pragma once
// The aggregate G-buffer's render targets and their bytes (docs/techniques/agaa.md#memory).
#include <string>
#include <vector>

#include "algos/agaa/shaders/programs.h"

namespace hwsim::algos {

/// Where an aggregate's covered samples are kept: as a mask of its natural size, as a count in the byte of an
/// eight-sample mask, or as a mask in a 32-bit target of its own.
enum class MaskStore { natural, count, word };

struct LayoutChoice {
  Ndf ndf = Ndf::toksvig;
  MaskStore mask = MaskStore::natural;
  int samples = 8;         ///< that a record's mask names
  bool geometric = false;  ///< mean of unit normals and mean gloss
  bool moments = false;    ///< whether moments of view depth are stored
  bool floats = false;     ///< half floats in place of normalized integers
};

struct AggregateLayout {
  struct Target {
    std::string name;
    Format format;
  };
  std::vector<Target> targets;
  AggregateTargets index;
  int bytes() const;  ///< size of an aggregate
};

AggregateLayout make_layout(const LayoutChoice& choice);

}  // namespace hwsim::algos
