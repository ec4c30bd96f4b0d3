#include "algos/filters/post_filters.h"

#include <array>

namespace hwsim::algos {
namespace {

// Steps of the searches: algos/filters/fxaa.cpp.
constexpr ParameterInfo kPreset{"preset",
                                2,
                                0,
                                16,
                                "steps of the search along edges",
                                "10|11|12|13|14|15|20|21|22|23|24|25|26|27|28|29|39"};
constexpr ParameterInfo kSubpix{"subpix", 0.75, 0, 1, "blur of details that are smaller than a pixel"};
constexpr ParameterInfo kEdgeThreshold{"edge_threshold", 0.166, 0.01, 1,
                                       "contrast of an edge, as a part of the highest luma"};
constexpr ParameterInfo kEdgeThresholdMin{"edge_threshold_min", 0.0833, 0, 1,
                                          "least contrast of an edge: darkness is not filtered"};
constexpr ParameterInfo kGreenAsLuma{
    "green_as_luma", 0, 0, 1, "no pass that writes luma: green stands for it", "off|on"};
constexpr ParameterInfo kDiscard{
    "discard", 0, 0, 1, "edges are drawn onto a copy of the image, other pixels discarded", "off|on"};

constexpr std::array<ParameterInfo, 6> kFxaa = {kPreset,           kSubpix,      kEdgeThreshold,
                                                kEdgeThresholdMin, kGreenAsLuma, kDiscard};
constexpr std::array<ParameterInfo, 13> kAxaa = {
    kPreset,
    kSubpix,
    kEdgeThreshold,
    kEdgeThresholdMin,
    kGreenAsLuma,
    kDiscard,
    ParameterInfo{"skip_filtered", 1, 0, 1, "rule 1: pixels with a value in the middle of the contrast stay",
                  "off|on"},
    ParameterInfo{"alpha", 0.1, 0, 0.5, "rule 1: how near to the middle"},
    ParameterInfo{"alpha_mode", 0, 0, 2, "rule 1: alpha is a part of the contrast, of the middle, or luma",
                  "range|mid|absolute"},
    ParameterInfo{"keep_thin_lines", 1, 0, 1, "rule 2: pixels that differ by 0.3 on both sides stay",
                  "off|on"},
    ParameterInfo{"same_sign", 0, 0, 1, "rule 2 only where both sides are darker, or both lighter", "off|on"},
    ParameterInfo{"adaptive_steps", 1, 0, 1, "rule 3: fewer steps at low contrast", "off|on"},
    ParameterInfo{"axaa_metric", 0, 0, 1,
                  "rule 3: contrast is the larger or the smaller of both (as printed)", "max|min"}};

constexpr std::array<ParameterInfo, 2> kSmaa = {
    ParameterInfo{"preset", 2, 0, 3, "threshold, search steps, diagonals and corners",
                  "low|medium|high|ultra"},
    ParameterInfo{"edges", 0, 0, 1, "contrast of luma, or the largest of the channels", "luma|color"}};

constexpr std::array<ParameterInfo, 2> kMlaa = {
    ParameterInfo{"threshold", 0.03125, 0.01, 0.5, "contrast of luma that makes an edge"},
    ParameterInfo{"count_bits", 0, 0, 1, "bits of a run's length with its stop bit: up to 7 pixels, or 127",
                  "4|8"}};

constexpr std::array<ParameterInfo, 2> kCmaa = {
    ParameterInfo{"threshold", 1.0 / 13.0, 0.04, 0.125,
                  "color difference that makes an edge, weighted by luma"},
    ParameterInfo{"cmaa_avg_quirk", 1, 0, 1,
                  "pruning takes the mean of four neighbors, as the public port does", "off|on"}};

constexpr TechniqueInfo kTechniques[] = {
    {.id = "fxaa",
     .description = "FXAA 3.11 Quality: blends along edges found by luma",
     .parameters = kFxaa,
     .filter = add_fxaa},
    {.id = "axaa",
     .description = "FXAA that leaves filtered pixels and thin lines, and searches less at low contrast",
     .parameters = kAxaa,
     .filter = add_axaa},
    {.id = "smaa",
     .description = "SMAA 1x: edges re-vectorized, diagonals and corners included",
     .parameters = kSmaa,
     .filter = add_smaa},
    {.id = "cmaa",
     .description = "CMAA: locally dominant edges, corners and long steps, in place",
     .parameters = kCmaa,
     .filter = add_cmaa},
    {.id = "mlaa",
     .description = "MLAA: runs of edges, re-vectorized by the colors at their ends",
     .parameters = kMlaa,
     .filter = add_mlaa},
};

}  // namespace

std::span<const TechniqueInfo> post_filters() { return kTechniques; }

}  // namespace hwsim::algos
