#pragma once
// The fields of a work trace, by name: the one list that writing, reading and versioning share. A field that
// is added to a struct and not listed here does not compile.
#include <concepts>
#include <type_traits>

#include "hwsim/trace/work_trace.h"

namespace hwsim {

template <class Visitor, class Target>
requires std::same_as<std::remove_const_t<Target>, ColorTargetWork>
void describe_fields(Visitor& v, Target& target) {
  auto& [format, samples, blended, loaded, kept] = target;
  v.field("format", format);
  v.field("samples", samples);
  v.field("blended", blended);
  v.field("loaded", loaded);
  v.field("kept", kept);
}

template <class Visitor, class Target>
requires std::same_as<std::remove_const_t<Target>, ReadTargetWork>
void describe_fields(Visitor& v, Target& target) {
  auto& [format, samples, pixels] = target;
  v.field("format", format);
  v.field("samples", samples);
  v.field("pixels", pixels);
}

template <class Visitor, class Curve>
requires std::same_as<std::remove_const_t<Curve>, MissCurve>
void describe_fields(Visitor& v, Curve& curve) {
  auto& [requested_read_bytes, requested_write_bytes, read_bytes, first_read_bytes, write_bytes, read_stays,
         write_stays] = curve;
  v.field("requested_read_bytes", requested_read_bytes);
  v.field("requested_write_bytes", requested_write_bytes);
  v.field("read_bytes", read_bytes);
  v.field("first_read_bytes", first_read_bytes);
  v.field("write_bytes", write_bytes);
  v.field("read_stays", read_stays);
  v.field("write_stays", write_stays);
}

template <class Visitor, class Profile>
requires std::same_as<std::remove_const_t<Profile>, ReuseProfile>
void describe_fields(Visitor& v, Profile& profile) {
  auto& [shared, apart, texture_l1] = profile;
  v.field("shared", shared);
  v.field("apart", apart);
  v.field("texture_l1", texture_l1);
}

template <class Visitor, class Pass>
requires std::same_as<std::remove_const_t<Pass>, PassWork>
void describe_fields(Visitor& v, Pass& pass) {
  auto& [name, kind, width_px, height_px, raster_samples, sample_rate, barrier_before, depth_format,
         depth_samples, depth_cleared_before, depth_loaded, depth_kept, color_cleared_before, source_in_tile,
         color_targets, read_targets, group_memory_lane_bytes, attribute_scalars, reuse, chunks] = pass;
  v.field("name", name);
  v.field("kind", kind);
  v.field("width_px", width_px);
  v.field("height_px", height_px);
  v.field("raster_samples", raster_samples);
  v.field("sample_rate", sample_rate);
  v.field("barrier_before", barrier_before);
  v.field("depth_format", depth_format);
  v.field("depth_samples", depth_samples);
  v.field("depth_cleared_before", depth_cleared_before);
  v.field("depth_loaded", depth_loaded);
  v.field("depth_kept", depth_kept);
  v.field("color_cleared_before", color_cleared_before);
  v.field("source_in_tile", source_in_tile);
  v.field("color_targets", color_targets);
  v.field("read_targets", read_targets);
  v.field("group_memory_lane_bytes", group_memory_lane_bytes);
  v.field("attribute_scalars", attribute_scalars);
  v.field("reuse", reuse);
  v.field("chunks", chunks);
}

template <class Visitor, class Trace>
requires std::same_as<std::remove_const_t<Trace>, WorkTrace>
void describe_fields(Visitor& v, Trace& trace) {
  auto& [scene, technique, technique_counters, width_px, height_px, peak_memory_bytes, allocated_memory_bytes,
         passes] = trace;
  v.field("scene", scene);
  v.field("technique", technique);
  v.field("technique_counters", technique_counters);
  v.field("width_px", width_px);
  v.field("height_px", height_px);
  v.field("peak_memory_bytes", peak_memory_bytes);
  v.field("allocated_memory_bytes", allocated_memory_bytes);
  v.field("passes", passes);
}

}  // namespace hwsim
