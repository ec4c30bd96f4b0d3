#pragma once
// Every count of work, declared once: a line below gives the field, the CSV column, the JSON key, the
// catalog entry of `hwsim list counters` and the documentation. One count is what the text says it is.
// Counters are integers, so sums do not depend on the number of threads. Ratios are functions, never stored.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace hwsim {

/// Subgroup widths for which divergence is counted during emulation, so that one trace serves them all.
inline constexpr std::array<int, 4> kSubgroupWidths = {8, 16, 32, 64};

#define HWSIM_STATS_COUNTERS(X)                                                       \
  X(input_assembly_vertices, "indices (or vertices of unindexed draws) read")         \
  X(input_assembly_primitives, "primitives assembled")                                \
  X(vertex_shader_invocations, "vertices shaded: misses of the post-transform cache") \
  X(geometry_shader_invocations, "primitives that geometry shaders ran on")           \
  X(geometry_shader_primitives, "primitives that they emitted")                       \
  X(clipping_invocations, "primitives that reached the clipper")                      \
  X(clipping_primitives, "primitives that left the clipper")                          \
  X(fragment_shader_invocations, "fragment shader invocations, helpers included")     \
  X(compute_shader_invocations, "compute shader invocations")                         \
  X(samples_passed, "samples that passed every depth and stencil test")

#define HWSIM_VS_COUNTERS(X)                                                              \
  X(alu_lane_ops, "vertex shader arithmetic, per vertex")                                 \
  X(sfu_lane_ops, "vertex shader special functions (reciprocal, root, exp2, log2, sine)") \
  X(output_scalars, "32-bit values written by vertex shaders for later stages")

#define HWSIM_GS_COUNTERS(X)                                        \
  X(input_bytes, "vertices handed to geometry shaders, three each") \
  X(output_vertices, "vertices that geometry shaders emitted")      \
  X(output_bytes, "bytes of these: position and attributes")

#define HWSIM_SETUP_COUNTERS(X)                                                    \
  X(in_primitives, "triangles that reached culling and setup, after clipping")     \
  X(culled_frustum_primitives, "of these, outside the view volume")                \
  X(culled_backface_primitives, "of these, facing away")                           \
  X(culled_zero_area_primitives, "of these, without area after snapping")          \
  X(culled_sample_miss_primitives, "of these, whose bounding box holds no sample") \
  X(out_primitives, "of these, sent to the rasterizer")

#define HWSIM_RASTER_COUNTERS(X)                                                          \
  X(visited_tiles, "8x8 pixel tiles that a triangle's coarse raster reached")             \
  X(covered_samples, "samples inside a triangle, before depth and stencil")               \
  X(fragments, "pixels of a triangle with a sample left when they are shaded or written") \
  X(quads, "2x2 pixel groups formed from these fragments")                                \
  X(partial_quads, "of these, with fewer than four fragments")

#define HWSIM_HIZ_COUNTERS(X)                                           \
  X(tested_tiles, "8x8 tiles that reached the coarse depth test")       \
  X(killed_tiles, "of these, rejected whole, without reading a sample") \
  X(accepted_tiles, "of these, known to pass whole")                    \
  X(ambiguous_tiles, "of these, sent on to the fine test")

#define HWSIM_ZROP_COUNTERS(X)                                                                    \
  X(early_z_tested_samples, "samples tested against depth and stencil before shading")            \
  X(early_z_killed_samples, "of these, that failed")                                              \
  X(late_z_tested_samples, "samples tested against depth and stencil after shading")              \
  X(late_z_killed_samples, "of these, that failed")                                               \
  X(written_samples, "samples whose depth or stencil was written")                                \
  X(touched_tiles, "8x8 depth tiles used, once for each chunk of work that uses them")            \
  X(first_touched_tiles, "8x8 depth tiles used for the first time in the pass")                   \
  X(read_clear_tiles, "8x8 depth tiles that memory gave as fast-cleared")                         \
  X(read_one_plane_tiles, "8x8 depth tiles that memory gave as one plane")                        \
  X(read_two_plane_tiles, "8x8 depth tiles that memory gave as two planes")                       \
  X(read_four_plane_tiles, "8x8 depth tiles that memory gave as three or four planes")            \
  X(read_offset_6_tiles,                                                                          \
    "8x8 depth tiles that memory gave as 6-bit distances from the nearest or farthest value")     \
  X(read_offset_14_tiles, "8x8 depth tiles that memory gave as 14-bit distances")                 \
  X(read_raw_tiles, "8x8 depth tiles that memory gave as its samples")                            \
  X(write_clear_tiles, "8x8 depth tiles given back to memory as still clear")                     \
  X(write_one_plane_tiles, "8x8 depth tiles given back to memory as one plane")                   \
  X(write_two_plane_tiles, "8x8 depth tiles given back to memory as two planes")                  \
  X(write_four_plane_tiles, "8x8 depth tiles given back to memory as three or four planes")       \
  X(write_offset_6_tiles,                                                                         \
    "8x8 depth tiles given back to memory as 6-bit distances from the nearest or farthest value") \
  X(write_offset_14_tiles, "8x8 depth tiles given back to memory as 14-bit distances")            \
  X(write_raw_tiles, "8x8 depth tiles given back to memory as its samples")

#define HWSIM_PS_COUNTERS(X)                                                            \
  X(invocations, "fragment shader invocations for fragments")                           \
  X(helper_invocations, "further invocations that only fill up a quad")                 \
  X(sample_rate_invocations, "of the invocations, those that ran once for each sample") \
  X(discarded_invocations, "of the invocations, those that ended in a discard")

#define HWSIM_SHADER_COUNTERS(X)                                                                        \
  X(alu_lane_ops, "arithmetic of fragment and compute lanes that needed it")                            \
  X(alu_issued_lane_ops_w8, "the same with idle lanes, subgroups of 8")                                 \
  X(alu_issued_lane_ops_w16, "the same with idle lanes, subgroups of 16")                               \
  X(alu_issued_lane_ops_w32, "the same with idle lanes, subgroups of 32")                               \
  X(alu_issued_lane_ops_w64, "the same with idle lanes, subgroups of 64")                               \
  X(sfu_lane_ops, "special functions of lanes that needed them")                                        \
  X(sfu_issued_lane_ops_w8, "the same with idle lanes, subgroups of 8")                                 \
  X(sfu_issued_lane_ops_w16, "the same with idle lanes, subgroups of 16")                               \
  X(sfu_issued_lane_ops_w32, "the same with idle lanes, subgroups of 32")                               \
  X(sfu_issued_lane_ops_w64, "the same with idle lanes, subgroups of 64")                               \
  X(interp_lane_ops, "attribute scalars interpolated")                                                  \
  X(vliw5_issued_words_w64, "instruction words of five slots, with idle lanes, subgroups of 64")        \
  X(alu_chain_lane_ops, "operations of the longest chain that waits for each other, summed over lanes") \
  X(memory_chain_lane_ops, "memory requests of the longest chain, summed over lanes")                   \
  X(register_lanes, "32-bit registers of an invocation, summed over invocations")                       \
  X(load_lane_ops, "32-bit loads from buffers")                                                         \
  X(store_lane_ops, "stores to buffers and images, a word each")                                        \
  X(narrow_store_lane_ops, "of these, texels of fewer than 32 bits")                                    \
  X(atomic_lane_ops, "atomic operations")                                                               \
  X(same_address_atomic_lane_ops, "of these, on the pass's most frequent address")                      \
  X(group_memory_lane_ops, "32-bit accesses to group memory")

#define HWSIM_TEX_COUNTERS(X)                                                                       \
  X(requests, "texture requests for more than a texel, a lane each: filters, gathers, comparisons") \
  X(bilinear_probes, "bilinear probes: 1 for bilinear, 2 for trilinear, times the anisotropy")      \
  X(gathers, "of the requests, those for one channel of 2x2 texels")                                \
  X(comparisons, "of the requests, those for 2x2 texels compared with a depth and filtered")        \
  X(fetched_32bit_texels, "texels read unfiltered, up to 32 bit")                                   \
  X(fetched_64bit_texels, "texels read unfiltered, 64 bit")                                         \
  X(fetched_128bit_texels, "texels read unfiltered, 128 bit")                                       \
  X(texels, "texels read, filtered or not")

#define HWSIM_CROP_COUNTERS(X)                                                                    \
  X(exported_fragments, "fragments written to color targets, times the number of targets")        \
  X(written_samples, "color samples written, all targets")                                        \
  X(blended_samples, "of these, that read the target and blended")                                \
  X(single_color_fragments, "exported fragments that covered every sample of their pixel")        \
  X(touched_tiles, "8x8 color tiles used, all targets, once for each chunk of work")              \
  X(first_touched_tiles, "8x8 color tiles used for the first time in the pass, all targets")      \
  X(read_single_pixels,                                                                           \
    "pixels of multisampled tiles that memory gave to blending and resolves that held one color") \
  X(read_double_pixels, "that held two")                                                          \
  X(read_mixed_pixels, "that held more, or colors that are not tracked")                          \
  X(read_single_groups_8px, "4x2 pixel groups of them with one color in each pixel")              \
  X(read_single_groups_16px, "4x4 pixel groups of them with one color in each pixel")             \
  X(write_single_pixels, "pixels of multisampled tiles given back to memory that held one color") \
  X(write_double_pixels, "that held two")                                                         \
  X(write_mixed_pixels, "that held more, or colors that are not tracked")                         \
  X(write_single_groups_8px, "4x2 pixel groups of them with one color in each pixel")             \
  X(write_single_groups_16px, "4x4 pixel groups of them with one color in each pixel")

#define HWSIM_RESOLVE_COUNTERS(X)             \
  X(read_samples, "samples read by resolves") \
  X(written_pixels, "pixels written by resolves")

#define HWSIM_FRONT_END_COUNTERS(X)                      \
  X(draws, "draws and dispatches")                       \
  X(state_changes, "pipeline and resource binds")        \
  X(command_words, "32-bit words of the command stream") \
  X(cleared_tiles, "8x8 tiles cleared, all samples and targets")

/// Bytes that units asked for, by stream; what of it DRAM moves is the timing engines' business.
#define HWSIM_MEM_COUNTERS(X)                                             \
  X(depth_read_bytes, "depth and stencil read by tests")                  \
  X(depth_write_bytes, "depth and stencil written")                       \
  X(color_read_bytes, "color read by blending and resolves")              \
  X(color_write_bytes, "color written")                                   \
  X(texture_read_bytes, "texels read")                                    \
  X(storage_read_bytes, "storage buffers and images read by shaders")     \
  X(storage_write_bytes, "storage buffers and images written by shaders") \
  X(vertex_read_bytes, "vertex attributes fetched")                       \
  X(index_read_bytes, "indices fetched")                                  \
  X(constant_read_bytes, "constants bound")                               \
  X(shader_read_bytes, "shader code bound")                               \
  X(other_read_bytes, "coverage maps and other metadata read")            \
  X(other_write_bytes, "coverage maps, tile tables and other metadata written")

/// All units: X(struct prefix, id, list)
#define HWSIM_COUNTER_UNITS(U)                \
  U(Stats, stats, HWSIM_STATS_COUNTERS)       \
  U(FrontEnd, fe, HWSIM_FRONT_END_COUNTERS)   \
  U(Vs, vs, HWSIM_VS_COUNTERS)                \
  U(Gs, gs, HWSIM_GS_COUNTERS)                \
  U(Setup, setup, HWSIM_SETUP_COUNTERS)       \
  U(Raster, raster, HWSIM_RASTER_COUNTERS)    \
  U(Hiz, hiz, HWSIM_HIZ_COUNTERS)             \
  U(Zrop, zrop, HWSIM_ZROP_COUNTERS)          \
  U(Ps, ps, HWSIM_PS_COUNTERS)                \
  U(Shader, shader, HWSIM_SHADER_COUNTERS)    \
  U(Tex, tex, HWSIM_TEX_COUNTERS)             \
  U(Crop, crop, HWSIM_CROP_COUNTERS)          \
  U(Resolve, resolve, HWSIM_RESOLVE_COUNTERS) \
  U(Mem, mem, HWSIM_MEM_COUNTERS)

#define HWSIM_FIELD(name, text) std::uint64_t name = 0;
#define HWSIM_UNIT_STRUCT(Prefix, id, LIST) \
  struct Prefix##Counters {                 \
    LIST(HWSIM_FIELD)                       \
  };
HWSIM_COUNTER_UNITS(HWSIM_UNIT_STRUCT)
#undef HWSIM_UNIT_STRUCT
#undef HWSIM_FIELD

/// One of the counters that techniques declare (algos/base/counters.h): its place among those of all.
struct TechniqueCounter {
  std::size_t slot = 0;
};

/// What techniques did, beyond what the units saw. This library adds and keeps these counts; who counts what
/// in which slot, the rooms of techniques declare.
inline constexpr std::size_t kTechniqueCounterSlots = 40;
struct TechniqueCounters {
  std::array<std::uint64_t, kTechniqueCounterSlots> slots{};
  std::uint64_t& operator[](TechniqueCounter counter) { return slots[counter.slot]; }
  std::uint64_t operator[](TechniqueCounter counter) const { return slots[counter.slot]; }
};

/// The work of a chunk, a pass or a frame.
struct PassCounters {
#define HWSIM_UNIT_MEMBER(Prefix, id, LIST) Prefix##Counters id;
  HWSIM_COUNTER_UNITS(HWSIM_UNIT_MEMBER)
#undef HWSIM_UNIT_MEMBER
  TechniqueCounters technique;
};

inline constexpr std::size_t kCounterCount = sizeof(PassCounters) / sizeof(std::uint64_t);

/// The counters as a flat array, in the order of counter_catalog().
std::span<const std::uint64_t, kCounterCount> values(const PassCounters& counters);
std::span<std::uint64_t, kCounterCount> values(PassCounters& counters);

PassCounters& operator+=(PassCounters& sum, const PassCounters& part);

struct CounterInfo {
  std::string_view id;           ///< "raster.fragments"
  std::string_view unit;         ///< "raster"
  std::string_view name;         ///< "fragments"
  std::string_view description;  ///< what one count is
  std::string_view unit_kind;    ///< generic or bytes
};

/// One entry a counter, in the order of `values`. Those of techniques come last, as "technique.slot_7": their
/// names are declared elsewhere (algos::counters, algos/rooms.h).
std::span<const CounterInfo> counter_catalog();

/// A law that the counters of every pass obey: the left side equals the right one, or is at most as large.
struct CounterLaw {
  enum class Relation : std::uint8_t { equal, at_most };
  std::string_view text;  ///< with the ids: "crop.blended_samples <= crop.written_samples"
  Relation relation = Relation::equal;
  std::uint64_t (*left)(const PassCounters&) = nullptr;
  std::uint64_t (*right)(const PassCounters&) = nullptr;
};

#define HWSIM_LAW(text, relation, left_side, right_side)                           \
  ::hwsim::CounterLaw {                                                            \
    text, ::hwsim::CounterLaw::Relation::relation,                                 \
        [](const ::hwsim::PassCounters& c) -> std::uint64_t { return left_side; }, \
        [](const ::hwsim::PassCounters& c) -> std::uint64_t { return right_side; } \
  }
/// One law: its text and both sides, in which `c` is the pass's counters.
#define HWSIM_LAW_EQUAL(text, left, right) HWSIM_LAW(text, equal, left, right)
#define HWSIM_LAW_AT_MOST(text, left, right) HWSIM_LAW(text, at_most, left, right)

/// The laws of the units (killed <= tested, culled + out = in, ...).
std::span<const CounterLaw> unit_laws();

/// A law that does not hold, with the values of its sides.
struct CounterViolation {
  std::string_view law;
  std::uint64_t left = 0;
  std::uint64_t right = 0;
};
/// Those of the laws that the counters break, in order.
std::vector<CounterViolation> violations(const PassCounters& counters, std::span<const CounterLaw> laws);

}  // namespace hwsim
