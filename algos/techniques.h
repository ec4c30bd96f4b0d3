#pragma once
// How a text names techniques and their options, and the frame graph of a combination.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algos/base/technique.h"
#include "algos/rooms.h"

namespace hwsim::algos {

struct TechniquePart {
  const TechniqueInfo* info = nullptr;
  Options options{NoOptions{}};
};

/// Modifiers, one base, then filters in the order in which they are applied.
struct TechniqueChoice {
  std::vector<TechniquePart> parts;
  const TechniquePart& base() const;
};

/// "agaa:c=2,msaa=8", "wire_aa+msaa4x+fxaa:preset=39"; without a base, `none` is it. Throws InputError (T0xx)
/// with all problems: unknown names (with the nearest), unknown keys, values out of range, combinations that
/// cannot be.
TechniqueChoice parse_technique(std::string_view text);

/// As parse_technique reads it: the options that differ from their defaults; with `complete`, all of them.
/// A base `none` with its defaults is left out beside other parts.
std::string technique_text(const TechniqueChoice& choice, bool complete = false);
std::string technique_text(const TechniquePart& part, bool complete = false);

/// Throws InputError T005 unless the choice filters and draws nothing: what an image can be given to.
void require_filters(const TechniqueChoice& choice);

/// The frame graph of the combination.
pipeline::FrameGraph build_frame(const TechniqueChoice& choice, const FrameRequest& request);

/// What its techniques say of a frame that was emulated: each message begins with the text of the choice.
std::vector<Diagnostic> frame_notes(const TechniqueChoice& choice, const DrawnFrame& frame);

}  // namespace hwsim::algos
