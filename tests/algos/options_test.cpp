// Options: each name sets its own field, and nothing else.
#include "algos/base/options.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "algos/agaa/options.h"
#include "algos/deferred/options.h"
#include "algos/filters/fxaa.h"
#include "algos/forward/options.h"
#include "algos/sbaa/options.h"
#include "algos/sss/options.h"
#include "algos/techniques.h"
#include "algos/wire/options.h"

namespace hwsim::algos::test {
namespace {

/// The part of the choice that `text` names first.
TechniquePart part_of(const std::string& text) {
  const TechniqueChoice choice = parse_technique(text);
  for (const TechniquePart& part : choice.parts)
    if (text.starts_with(part.info->id)) return part;
  return {};
}

/// Another value of the option than its default, as users write it.
std::string other_value(const OptionInfo& option) {
  if (option.choices.empty()) {
    const double value = option.default_value == option.min ? option.max : option.min;
    return std::to_string(value);
  }
  const std::size_t bar = option.choices.find('|');
  return std::string(option.default_value == 0.0
                         ? option.choices.substr(bar + 1, option.choices.find('|', bar + 1) - bar - 1)
                         : option.choices.substr(0, bar));
}

TEST(Options, EachNameSetsOneValueAndLeavesTheOthers) {
  for (const TechniqueInfo& t : techniques())
    for (std::size_t i = 0; i < t.options.size(); ++i) {
      const OptionInfo& option = t.options[i];
      if (option.choices.empty() && option.min == option.max) continue;  // the name says it
      const TechniquePart part =
          part_of(std::string(t.id) + ":" + std::string(option.name) + "=" + other_value(option));
      const std::vector<OptionInfo> values = part.options.infos();
      ASSERT_EQ(values.size(), t.options.size());
      for (std::size_t k = 0; k < values.size(); ++k)
        EXPECT_EQ(values[k].default_value != t.options[k].default_value, k == i)
            << t.id << ":" << option.name << " and " << values[k].name;
    }
}

/// Fields of a struct by the names of their options: a field that another name sets is found.
template <class Struct>
using Fields = std::map<std::string, double (*)(const Struct&)>;

template <class Struct>
void check_fields(const std::string& technique, const Fields<Struct>& fields) {
  const TechniqueInfo& info = *part_of(technique).info;
  const Struct defaults = info.defaults.as<Struct>();
  std::set<std::string> names;
  for (const OptionInfo& option : info.options) {
    names.emplace(option.name);
    if (option.choices.empty() && option.min == option.max) continue;
    const std::string text = technique + ":" + std::string(option.name) + "=" + other_value(option);
    const TechniquePart part = part_of(text);
    const Struct& set = part.options.as<Struct>();
    for (const auto& [name, field] : fields)
      EXPECT_EQ(field(set) != field(defaults), name == option.name) << text << " and the field of " << name;
  }
  for (const std::string& name : names) EXPECT_TRUE(fields.contains(name)) << technique << ":" << name;
}

#define FIELD(name, expression)                                           \
  {                                                                       \
    name, [](const Struct& o) { return static_cast<double>(expression); } \
  }

TEST(Options, NamesOfAgaaMeanTheirFields) {
  using Struct = AgaaOptions;
  check_fields<Struct>("agaa", {FIELD("c", o.aggregates),
                                FIELD("msaa", o.samples),
                                FIELD("k", o.k_m),
                                FIELD("t", o.separation),
                                FIELD("ndf", o.ndf),
                                FIELD("brdf", o.brdf),
                                FIELD("diffuse_filter", o.diffuse),
                                FIELD("gloss", o.gloss),
                                FIELD("s_matte", o.matte_exponent),
                                FIELD("k_mode", o.k_mode),
                                FIELD("footprint_px", o.footprint_px),
                                FIELD("mean_normal", o.mean_normal),
                                FIELD("seeds", o.seeds),
                                FIELD("shadow_taps", o.shadow_taps),
                                FIELD("agg_bytes", o.mask),
                                FIELD("agg_float", o.half_floats),
                                FIELD("depth_moments", o.depth_moments),
                                FIELD("light_variance", o.light_variance),
                                FIELD("visible_normals", o.visible_normals),
                                FIELD("s_ref", o.gloss_reference),
                                FIELD("emulate", o.emulate),
                                FIELD("accumulate", o.accumulate),
                                FIELD("centroid", o.centroid),
                                FIELD("plane_path", o.plane_path),
                                FIELD("empty_exit", o.empty_exit),
                                FIELD("a2c_dither", o.alpha_dither),
                                FIELD("shadow_axis", o.shadow_axis)});
  EXPECT_EQ(part_of("agaa:c=3").options.as<Struct>().aggregates, 3);
  EXPECT_EQ(part_of("agaa:msaa=32").options.as<Struct>().samples, 32);
  EXPECT_EQ(part_of("agaa:ndf=lean").options.as<Struct>().ndf, Ndf::lean);
}

TEST(Options, NamesOfSbaaMeanTheirFields) {
  using Struct = SbaaMergeOptions;
  check_fields<Struct>(
      "sbaa_merge",
      {FIELD("n", o.sbaa.surfaces), FIELD("msaa", o.sbaa.samples), FIELD("id_bits", o.sbaa.id_bits),
       FIELD("record_bytes", o.sbaa.record_bytes), FIELD("background", o.sbaa.background),
       FIELD("centroid", o.sbaa.centroid), FIELD("empty_exit", o.sbaa.empty_exit),
       FIELD("alpha", o.alpha_rad), FIELD("end_region", o.end_region), FIELD("merge_depth", o.merge_depth),
       FIELD("pack_id_normal", o.pack_id_normal)});
}

template <class Struct>
Fields<Struct> shared_sss() {
  return {FIELD("theta_c", o.sss.theta_c_deg),
          FIELD("tri_px", o.sss.triangle_px),
          FIELD("hl_px", o.sss.highlight_px),
          FIELD("mode", o.sss.mode),
          FIELD("early_exit", o.sss.early_exit),
          FIELD("tau", o.sss.threshold),
          FIELD("rho", o.sss.samples_per_px),
          FIELD("k_min", o.sss.samples_min),
          FIELD("k_max", o.sss.samples_max),
          FIELD("rho_min", o.sss.sparsest_per_px),
          FIELD("border_frac", o.sss.border_share),
          FIELD("pt_bias_units", o.sss.depth_bias_steps),
          FIELD("pt_bias_slope", o.sss.depth_slope),
          FIELD("shading", o.sss.shading),
          FIELD("base", o.sss.base),
          FIELD("rest", o.sss.rest)};
}

TEST(Options, NamesOfSelectiveSupersamplingMeanTheirFields) {
  {
    using Struct = SssPointOptions;
    Fields<Struct> fields = shared_sss<Struct>();
    fields.insert({FIELD("points", o.points), FIELD("depth", o.depth)});
    check_fields<Struct>("sss_gs", fields);
  }
  {
    using Struct = SssComputeOptions;
    Fields<Struct> fields = shared_sss<Struct>();
    fields.insert({FIELD("atomics", o.atomics), FIELD("fixed_bits", o.fixed_bits),
                   FIELD("radiance_max", o.radiance_max)});
    check_fields<Struct>("sss_cs", fields);
  }
  {
    using Struct = SssListOptions;
    Fields<Struct> fields = shared_sss<Struct>();
    fields.insert({FIELD("m", o.grid), FIELD("node_bytes", o.node_bytes),
                   FIELD("capacity_nodes", o.capacity_nodes), FIELD("budget_mib", o.budget_mib),
                   FIELD("list_cap", o.list_cap), FIELD("conservative", o.conservative)});
    check_fields<Struct>("sss_ppll", fields);
  }
}

TEST(Options, NamesOfOtherTechniquesMeanTheirFields) {
  {
    using Struct = SimpleComplexOptions;
    check_fields<Struct>("deferred_simple_complex",
                         {FIELD("samples", o.gbuffer.samples), FIELD("layout", o.gbuffer.layout),
                          FIELD("centroid", o.gbuffer.centroid), FIELD("emulate", o.gbuffer.emulate),
                          FIELD("prepass", o.gbuffer.prepass), FIELD("lighting", o.lighting),
                          FIELD("normal_dot_min", o.normal_dot_min), FIELD("z_scale", o.z_scale),
                          FIELD("compare_all", o.compare_all),
                          FIELD("alpha_to_coverage", o.alpha_to_coverage), FIELD("resolve", o.resolve)});
  }
  {
    using Struct = WireOptions;
    check_fields<Struct>("wire_aa", {FIELD("width_px", o.width_px), FIELD("w_hi", o.full_light_px),
                                     FIELD("lighting", o.lighting), FIELD("hl_pow", o.half_lambert_power),
                                     FIELD("fade", o.fade), FIELD("z_write", o.depth)});
  }
  {
    using Struct = AxaaOptions;
    check_fields<Struct>(
        "axaa",
        {FIELD("preset", o.fxaa.preset), FIELD("subpix", o.fxaa.subpix),
         FIELD("edge_threshold", o.fxaa.edge_threshold),
         FIELD("edge_threshold_min", o.fxaa.edge_threshold_min), FIELD("green_as_luma", o.fxaa.green_as_luma),
         FIELD("gather", o.fxaa.path.gather), FIELD("discard", o.fxaa.path.discard),
         FIELD("skip_filtered", o.skip_filtered), FIELD("alpha", o.alpha), FIELD("alpha_mode", o.alpha_mode),
         FIELD("keep_thin_lines", o.keep_thin_lines), FIELD("same_sign", o.same_sign),
         FIELD("adaptive_steps", o.adaptive_steps), FIELD("axaa_metric", o.metric)});
  }
  {
    using Struct = CsaaOptions;
    check_fields<Struct>("csaa", {FIELD("mode", o.mode), FIELD("centroid", o.coverage.centroid),
                                  FIELD("orphans", o.coverage.orphans)});
  }
}
#undef FIELD

TEST(Options, NumbersOfThingsHaveNoFraction) {
  try {
    parse_technique("agaa:shadow_taps=2.5");
    FAIL() << "half a tap was taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().front().code, "T003");
    EXPECT_EQ(error.diagnostics().front().message,
              "technique `agaa`: shadow_taps = 2.5, must be a whole number");
  }
  EXPECT_EQ(technique_text(parse_technique("agaa:k=0.25")), "agaa:k=0.25");
}

}  // namespace
}  // namespace hwsim::algos::test
