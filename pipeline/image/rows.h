#pragma once
// A loop over an image's rows.
#include <algorithm>
#include <cstddef>

#include "pipeline/base/parallel.h"

namespace hwsim::pipeline {

/// Runs body(y) for every row on `jobs` threads.
template <class Body>
void for_rows(int height, int jobs, const Body& body) {
  constexpr int kRowsAtOnce = 16;
  parallel_for(static_cast<std::size_t>((height + kRowsAtOnce - 1) / kRowsAtOnce), jobs,
               [&](std::size_t band, int) {
                 const int first = static_cast<int>(band) * kRowsAtOnce;
                 for (int y = first; y < std::min(height, first + kRowsAtOnce); ++y) body(y);
               });
}

}  // namespace hwsim::pipeline
