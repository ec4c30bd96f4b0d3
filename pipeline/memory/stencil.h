#pragma once
// The stencil test and its operations on the samples of a tile.
#include <cstdint>

#include "pipeline/state/pipeline_state.h"

namespace hwsim::pipeline {

/// Whether a stored value passes, and what an operation makes of it.
bool stencil_passes(const StencilState& state, std::uint8_t stored);
std::uint8_t stencil_result(const StencilState& state, StencilOp op, std::uint8_t stored);

/// Keeps the samples in masks[s] (64 lanes each, as in `stencil`) that pass, and updates the stencil of those
/// that fail.
void test_stencil(const StencilState& state, int samples, std::uint8_t* stencil, std::uint64_t* masks);
/// Applies on_pass to `passed` and on_depth_fail to the rest of `tested`.
void update_stencil(const StencilState& state, int samples, std::uint8_t* stencil,
                    const std::uint64_t* tested, const std::uint64_t* passed);

}  // namespace hwsim::pipeline
