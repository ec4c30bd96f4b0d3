#pragma once
// A loop over threads: the only place where the pipeline starts any.
#include <cstddef>
#include <functional>

namespace hwsim::pipeline {

/// Runs body(index, worker) for index in [0, count) on `jobs` threads; worker is in [0, jobs). Which
/// worker takes an index is not defined, so results must not depend on it. Exceptions propagate. jobs <= 1:
/// in order, here.
void parallel_for(std::size_t count, int jobs,
                  const std::function<void(std::size_t index, int worker)>& body);

}  // namespace hwsim::pipeline
