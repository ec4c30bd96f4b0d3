#pragma once
// What a G-buffer's layout has no room for, said by the names of the materials that it changes.
#include <string_view>
#include <vector>

#include "algos/base/technique.h"

namespace hwsim::algos {

inline constexpr MessageCode kEmissionIsGray = {
    "T103", "emission is shown in gray",
    "The G-buffer's layout holds one number of emission, its luminance: colored emission is gray, and what "
    "is "
    "brighter than 1 may be cut there. Forward techniques, SBAA and layout=gb_sbaa40 keep the color."};
inline constexpr MessageCode kUnlitIsEmission = {
    "T104", "unlit surfaces are shown in gray",
    "An aggregate mixes surfaces and has no mark for unlit ones: they are stored as emission, of which there "
    "is one number. Forward techniques, deferred layouts and SBAA show their color."};
inline constexpr MessageCode kEmissionIsLost = {
    "T106", "emission is not shown",
    "The record of a surface is too short for emission: surfaces that shine are lit as if they did not."};
inline constexpr MessageCode kOcclusionIsLost = {
    "T105", "occlusion textures are ignored",
    "The technique's record of a surface has no place for occlusion: ambient light reaches what the texture "
    "would keep dark. Forward techniques and selective supersampling keep it off."};

/// What the technique stores of a surface beyond its reflectance.
enum class StoredEmission { none, luminance, color };
struct SurfaceRecord {
  StoredEmission emission = StoredEmission::luminance;
  bool unlit_mark = false, occlusion = false;
  bool holds_blended = false;  ///< blended materials too; else they are drawn forward, and lose nothing
};

/// A note for each thing that some drawn material has and the record has not; `remedy` says how to keep it.
std::vector<Diagnostic> lost_light(const std::vector<pipeline::SpecialSurface>& surfaces,
                                   const SurfaceRecord& record, std::string_view remedy);

}  // namespace hwsim::algos
