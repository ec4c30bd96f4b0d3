#include "algos/agaa/options.h"

#include <array>

namespace hwsim::algos {
namespace {

void describe_surfaces(OptionList& list, AgaaOptions& o) {
  list.choice("c", o.aggregates, "1|2|3|4", std::array{1, 2, 3, 4},
              "aggregates a pixel; three take the memory of four where they are color samples");
  list.choice("msaa", o.samples, "4|8|16|32", std::array{4, 8, 16, 32}, "visibility samples a pixel");
  list.real("k", o.k_m, {0.001, 10}, "length at which positions weigh as much as normals, m");
  list.real("t", o.separation, {0, 1}, "distance that keeps aggregates apart");
}

void describe_lobes(OptionList& list, AgaaOptions& o) {
  list.choice("ndf", o.ndf, "toksvig|lean|sggx", "distribution of normals");
  list.choice("brdf", o.brdf, "blinn_phong|ggx", "specular reflection");
  list.choice(
      "diffuse_filter", o.diffuse, "auto|off|folded|geometric|samples",
      "diffuse light over the normals: none, by the vector that holds the gloss too, by a mean of unit "
      "normals beside it, or by the samples' normals of the first pass; auto: folded with toksvig, samples "
      "with others");
  list.choice("gloss", o.gloss, "folded|separate", "folded into the normals' lobe, or stored beside it");
}

void describe_definition(OptionList& list, AgaaOptions& o) {
  list.choice("k_mode", o.k_mode, "world|footprint", "k as given, or at least footprint_px pixels");
  list.real("footprint_px", o.footprint_px, {1, 64}, "with k_mode=footprint");
  list.choice("mean_normal", o.mean_normal, "unit|raw", "of the first seed's search");
  list.choice(
      "seeds", o.seeds, "farthest|sum|sum2",
      "further seeds: farthest from their nearest seed, or by sums of distances, or of their squares");
}

void describe_storage(OptionList& list, AgaaOptions& o) {
  list.choice("agg_bytes", o.mask, "natural|16|20",
              "mask: as many bytes as it needs, a sample count instead, or 32 bits of its own");
  list.choice("agg_float", o.half_floats, "off|on", "half floats in the aggregate G-buffer");
  list.choice("depth_moments", o.depth_moments, "off|on",
              "depth's moments stored, instead of read from the samples");
}

}  // namespace

void describe(OptionList& list, AgaaOptions& o) {
  describe_surfaces(list, o);
  describe_lobes(list, o);
  describe_definition(list, o);
  list.whole("shadow_taps", o.shadow_taps, {1, 8}, "along the main axis of an aggregate's samples");
  describe_storage(list, o);
  list.choice("light_variance", o.light_variance, "off|on", "directions to near lights widen the lobe");
  list.whole("visible_normals", o.visible_normals, {4, 32}, "of SGGX's diffuse light");
  list.real(
      "s_matte", o.matte_exponent, {0, 1000},
      "diffuse_filter=folded: added to the exponent that the vector holds, by the share of diffuse light");
  list.real("s_ref", o.gloss_reference, {0, 65535}, "Toksvig's reference exponent; 0: infinite");
  list.choice("emulate", o.emulate, kEmulateChoices,
              "layers of 8 samples, by viewport multicast, or native samples");
  list.choice("accumulate", o.accumulate, "auto|blend|atomics",
              "aggregates add up by blending into mixed samples, or by atomics");
  describe_centroid(list, o.centroid);
  list.choice(
      "plane_path", o.plane_path, "auto|on|off|given",
      "depth tiles that are compressed to few planes take those for aggregates: where the GPU lets shaders "
      "read them (on), or for nothing, as the paper measures layers (given); auto: given in layers, else on "
      "where the GPU can");
  list.choice("empty_exit", o.empty_exit, "off|on",
              "whether the definition leaves pixels of sky alone at once");
  list.choice("a2c_dither", o.alpha_dither, "off|on", "alpha to coverage rounds by 2x2 pixels");
  list.choice(
      "shadow_axis", o.shadow_axis, "depth|places|receiver",
      "along which shadows are filtered: the pixel's ray by the samples' depths, the main axis of their "
      "places, or where their places go with their depths, which stays on a plane");
}

}  // namespace hwsim::algos
