#include "algos/agaa/layout.h"

namespace hwsim::algos {

int AggregateLayout::bytes() const {
  int sum = 0;
  for (const Target& target : targets) sum += info(target.format).bytes;
  return sum;
}

AggregateLayout make_layout(const LayoutChoice& choice) {
  AggregateLayout layout;
  const auto add = [&](const char* name, Format format) {
    layout.targets.push_back({name, format});
    return static_cast<int>(layout.targets.size()) - 1;
  };
  const bool halves = choice.floats || choice.ndf == Ndf::lean;  // LEAN's moments go up to 17
  AggregateTargets& t = layout.index;
  t.shape = add("shape", halves ? Format::rgba16_float : Format::rgba16_snorm);
  t.albedo = add("albedo", choice.floats ? Format::rgba16_float : Format::rgb10a2_unorm);
  t.chroma = add("chroma", choice.floats ? Format::rgba16_float : Format::rgba8_unorm);
  if (choice.ndf != Ndf::toksvig)
    t.shape_rest = add("shape_rest", halves ? Format::rg16_float : Format::rg16_snorm);
  if (choice.ndf == Ndf::sggx) t.luma = add("luma", Format::r16_float);
  if (choice.geometric)
    t.geometric = add("geometric", choice.floats ? Format::rgba16_float : Format::rgba16_snorm);
  if (choice.moments) t.moments = add("moments", Format::rg32_float);
  t.counts_samples = choice.mask == MaskStore::count && choice.samples > 8;
  if (choice.mask == MaskStore::word || choice.floats) {  // masks add up in bytes alone
    t.counts_samples = false;
    t.mask_word = add("mask", Format::rgba8_unorm);
  } else if (!t.counts_samples) {
    if (choice.samples > 8) t.mask_1 = add("mask_1", Format::r8_unorm);
    if (choice.samples > 16) t.mask_2 = add("mask_2", Format::rg8_unorm);
  }
  return layout;
}

}  // namespace hwsim::algos
