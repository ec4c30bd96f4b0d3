// What rooms declare: slots, ids, laws, codes and what counts as shaded.
#include "algos/rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "algos/agaa/shaders/counters.h"
#include "algos/sbaa/shaders/counters.h"
#include "algos/sss/shaders/counters.h"
#include "algos/techniques.h"

namespace hwsim::algos::test {
namespace {

TEST(Rooms, NoSlotIsTwoRooms) {
  std::set<std::size_t> slots;
  std::set<std::string_view> ids;
  for (const Room& room : rooms())
    for (const DeclaredCounter& c : room.counters) {
      EXPECT_TRUE(slots.insert(c.counter.slot).second) << c.id << ": slot " << c.counter.slot << " is taken";
      EXPECT_TRUE(ids.insert(c.id).second) << c.id;
      EXPECT_EQ(c.id, "technique." + std::string(c.name));
      EXPECT_FALSE(c.text.empty()) << c.id;
      EXPECT_EQ(technique_counter_ids().at(c.counter.slot), c.id);
    }
  EXPECT_GT(slots.size(), 20u);
}

// Columns of files and keys of results come in this order: techniques stand before memory.
TEST(Rooms, CountersAreListedOnceAndAtTheirPlaces) {
  std::set<std::size_t> places;
  bool memory = false;
  for (const auto& [info, place] : counters()) {
    EXPECT_TRUE(places.insert(place).second) << info.id;
    memory = memory || info.unit == "mem";
    EXPECT_FALSE(memory && info.unit == "technique") << info.id;
    if (info.unit != "technique") {
      EXPECT_EQ(counter_catalog()[place].id, info.id);
    }
  }
  PassCounters c;
  c.technique[SssCounters::sss_point_samples] = 7;
  const auto points =
      std::ranges::find(counters(), "technique.sss_point_samples", [](const auto& l) { return l.info.id; });
  ASSERT_NE(points, counters().end());
  EXPECT_EQ(values(c)[points->place], 7u);
}

TEST(Rooms, ShadedAreLitSamplesAndTheFurtherSamplesOfSelectiveSupersampling) {
  PassCounters c;
  for (const auto& [info, place] : counters()) values(c)[place] = 1000;
  c.technique[BaseCounters::lit_samples] = 5;
  c.technique[SssCounters::sss_shaded_samples] = 2;
  WorkTrace trace;
  trace.passes.resize(1);
  trace.passes[0].chunks = {c, c};
  EXPECT_EQ(shaded_samples(trace), 14u);
}

TEST(Rooms, EachBrokenLawIsFoundAlone) {
  const auto broken = [](TechniqueCounter counter, std::uint64_t value) {
    PassCounters c;
    c.technique[SssCounters::sss_tested_primitives] = 6;
    c.technique[SssCounters::sss_uncritical_primitives] = 1;
    c.technique[SssCounters::sss_early_exit_primitives] = 2;
    c.technique[SssCounters::sss_processed_primitives] = 3;
    c.technique[SbaaCounters::slots_emitted_surfaces] = 10;
    c.technique[SbaaCounters::slots_emitted_first_surfaces] = 4;
    c.technique[SbaaCounters::slots_emitted_second_surfaces] = 3;
    c.technique[SbaaCounters::slots_emitted_third_surfaces] = 2;
    c.technique[SbaaCounters::slots_emitted_further_surfaces] = 1;
    c.technique[SbaaCounters::merge_fallbacks_surfaces] = 10;
    c.technique[AgaaCounters::agaa_aggregates] = 5;
    c.technique[AgaaCounters::agaa_plane_split_pixels] = 5;
    EXPECT_TRUE(broken_laws(c).empty());
    c.technique[counter] = value;
    std::string laws;
    for (const CounterViolation& v : broken_laws(c)) laws += std::string(v.law) + "\n";
    return laws;
  };
  EXPECT_EQ(
      broken(SssCounters::sss_early_exit_primitives, 3),
      "technique.sss_uncritical_primitives + early_exit + processed = technique.sss_tested_primitives\n");
  EXPECT_EQ(
      broken(SbaaCounters::slots_emitted_further_surfaces, 0),
      "technique.slots_emitted_first + _second + _third + _further = technique.slots_emitted_surfaces\n");
  EXPECT_EQ(broken(SbaaCounters::merge_fallbacks_surfaces, 11),
            "technique.merge_fallbacks_surfaces <= technique.slots_emitted_surfaces\n");
  EXPECT_EQ(broken(AgaaCounters::agaa_plane_split_pixels, 6),
            "technique.agaa_plane_split_pixels <= technique.agaa_aggregates\n");
  EXPECT_EQ(broken(AgaaCounters::agaa_mixed_code_fragments, 1),
            "technique.agaa_mixed_code_fragments <= ps.invocations\n");
}

TEST(Rooms, CodesOfNotesAreExplainedOnce) {
  std::set<std::string_view> codes;
  for (const MessageCode& code : message_codes()) {
    EXPECT_TRUE(codes.insert(code.code).second) << code.code;
    EXPECT_FALSE(code.title.empty() || code.explanation.empty()) << code.code;
  }
  EXPECT_EQ(codes, (std::set<std::string_view>{"T101", "T102", "T103", "T104", "T105", "T106", "T107"}));
}

/// "severity code: message; help" of each note.
std::vector<std::string> told(const std::string& technique, const WorkTrace& trace,
                              const std::vector<pipeline::SpecialSurface>& surfaces = {}) {
  std::vector<std::string> texts;
  for (const Diagnostic& d : frame_notes(parse_technique(technique), {trace, surfaces}))
    texts.push_back((d.severity == Severity::warning ? "warning " : "note ") + d.code + ": " + d.message +
                    "; " + d.help);
  return texts;
}

TEST(Notes, ThreeAggregatesInFourColorSamplesAreTold) {
  WorkTrace trace;
  trace.passes.resize(2);
  trace.passes[1].name = "generate";
  EXPECT_TRUE(told("agaa:c=3", trace).empty()) << "a storage buffer has no gap";
  trace.passes[1].color_targets.resize(1);
  trace.passes[1].color_targets[0].samples = 4;
  EXPECT_EQ(told("agaa:c=3", trace),
            std::vector<std::string>{"note T102: agaa:c=3: color samples divide raster samples: 3 aggregates "
                                     "take the memory of 4; accumulate=atomics stores them without a gap"});
  EXPECT_TRUE(told("agaa:c=4", trace).empty());
  EXPECT_TRUE(told("none", trace).empty());
}

TEST(Notes, ListsThatLostFragmentsAreTold) {
  WorkTrace trace;
  trace.passes.resize(1);
  trace.passes[0].chunks.resize(2);
  EXPECT_TRUE(told("sss_ppll", trace).empty());
  trace.passes[0].chunks[0].technique[SssCounters::sss_stored_fragments] = 90;
  trace.passes[0].chunks[1].technique[SssCounters::sss_dropped_fragments] = 10;
  EXPECT_EQ(told("sss_ppll+fxaa", trace),
            std::vector<std::string>{"warning T101: sss_ppll+fxaa: 10 of 100 fragments found the lists full: "
                                     "the image lacks them; capacity_nodes=100 holds all"});
  trace.passes[0].chunks[1].technique[SssCounters::sss_dropped_fragments] = 0;
  trace.passes[0].chunks[1].technique[SssCounters::sss_truncated_pixels] = 3;
  EXPECT_EQ(told("sss_ppll:m=8", trace),
            std::vector<std::string>{"warning T101: sss_ppll:m=8: the lists of 3 pixels are longer than the "
                                     "resolve reads; list_cap reads up to 64"});
  EXPECT_TRUE(told("sss_cs", trace).empty());
}

TEST(Notes, WhatALayoutHasNoRoomForIsTold) {
  const std::vector<pipeline::SpecialSurface> surfaces = {
      {.material = "white lamp", .emissive = true},
      {.material = "sign", .emissive = true, .colored_emission = true},
      {.material = "glow", .blended = true, .emissive = true, .colored_emission = true},
      {.material = "sky", .unlit = true},
      {.material = "wall", .occluded = true}};
  const auto codes = [&](const std::string& technique) {
    std::string all;
    for (const Diagnostic& d : frame_notes(parse_technique(technique), {WorkTrace{}, surfaces}))
      all += (all.empty() ? "" : " ") + d.code;
    return all;
  };
  EXPECT_EQ(codes("none"), "");
  EXPECT_EQ(codes("msaa4x+fxaa"), "");
  EXPECT_EQ(codes("sss_cs"), "");
  EXPECT_EQ(codes("deferred"), "T103 T105");
  EXPECT_EQ(codes("deferred:layout=gb_sbaa40"), "T105");
  EXPECT_EQ(codes("deferred_simple_complex:layout=gb_agaa16"), "T103 T105");
  EXPECT_EQ(codes("sbaa_top"), "T105");
  EXPECT_EQ(codes("sbaa_merge:record_bytes=16"), "T105");
  EXPECT_EQ(codes("sbaa_merge:record_bytes=12"), "T106 T105");
  EXPECT_EQ(codes("agaa"), "T103 T104 T105");
  EXPECT_EQ(told("deferred:layout=gb_20", {}, surfaces)[0],
            "note T103: deferred:layout=gb_20: material `sign`: colored emission is shown in gray, for its "
            "luminance alone is stored; layout=gb_sbaa40 keeps the color of emission, forward techniques all "
            "of it")
      << "what is blended is drawn forward";
  EXPECT_EQ(
      told("agaa", {}, surfaces)[0],
      "note T103: agaa: material `sign` and 1 more: colored emission is shown in gray, for its luminance "
      "alone is stored; forward techniques, as msaa8x, show it; so does `sbaa_merge` but for occlusion");
}

}  // namespace
}  // namespace hwsim::algos::test
